/// How values are distributed over the cells of a mesh: counted in fine bins, from which percentiles and
/// histograms come. What both summaries of quality rest on. Internal to mesh/.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace aeroloom::mesh {

/// The range of a measure (or of its decimal logarithm), its fine bins per unit, and how many of those make a
/// bin of the published histogram.
struct Scale {
  double low = 0, high = 1;
  int bins_per_unit = 1, merged = 1;
  bool logarithmic = false;

  std::size_t bins() const { return static_cast<std::size_t>((high - low) * bins_per_unit); }
  double lower_end(std::size_t bin) const {
    const double at = low + static_cast<double>(bin) / bins_per_unit;
    return logarithmic ? std::pow(10.0, at) : at;
  }
};
inline constexpr Scale angle_scale{0, 180, 100, 200};
inline constexpr Scale ratio_scale{0, 1, 10000, 200};

/// One measure over the cells seen so far. What lies outside of the scale counts in its first or last bin.
struct Accumulator {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> bins;

  Accumulator() = default;
  explicit Accumulator(const Scale& scale) : bins(scale.bins(), 0) {}

  void add(double value, const Scale& scale) {
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
    const double on_scale = scale.logarithmic ? (value > 0 ? std::log10(value) : scale.low) : value;
    const double bin = (on_scale - scale.low) * scale.bins_per_unit;
    ++bins[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins.size() - 1)))];
  }
};

/// One measure over the cells of all ranks.
class BinnedValues {
public:
  /// Empties the bins of `mine`. Collective.
  BinnedValues(const parallel::Communicator& communicator, Accumulator& mine, const Scale& scale);

  std::int64_t count() const { return _count; }
  double minimum() const { return _minimum; }  ///< 0 where there are none, as the maximum
  double maximum() const { return _maximum; }
  /// The lower end of the bin in which the value at this fraction of all, counted from below, lies.
  double percentile(int per_mille) const;
  std::vector<std::int64_t> histogram() const;

private:
  Scale _scale;
  std::vector<std::int64_t> _bins;
  std::int64_t _count = 0;
  double _minimum = 0, _maximum = 0;
};

}  // namespace aeroloom::mesh
