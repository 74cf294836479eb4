#include "mesh/quality/distribution.hpp"

#include "mesh/quality/bin_sums.hpp"

#include <numeric>

namespace aeroloom::mesh {

BinnedValues::BinnedValues(const parallel::Communicator& communicator, Accumulator& mine, const Scale& scale)
    : _scale(scale) {
  if (mine.bins.empty()) mine.bins.assign(scale.bins(), 0);
  _bins = sum_bins(communicator, mine.bins);
  std::vector<std::int64_t>().swap(mine.bins);
  _count = std::accumulate(_bins.begin(), _bins.end(), std::int64_t{0});
  const double minimum = communicator.minimum(mine.minimum), maximum = communicator.maximum(mine.maximum);
  if (_count > 0) _minimum = minimum, _maximum = maximum;
}

double BinnedValues::percentile(int per_mille) const {
  const std::int64_t wanted =
      std::max<std::int64_t>(1, _count / 1000 * per_mille + (_count % 1000 * per_mille + 999) / 1000);
  std::int64_t seen = 0;
  std::size_t bin = 0;
  while (bin < _bins.size() && (seen += _bins[bin]) < wanted) ++bin;
  return _scale.lower_end(bin);
}

std::vector<std::int64_t> BinnedValues::histogram() const {
  const auto merged = static_cast<std::size_t>(_scale.merged);
  std::vector<std::int64_t> counts(_bins.size() / merged, 0);
  for (std::size_t b = 0; b < _bins.size(); ++b) counts[b / merged] += _bins[b];
  return counts;
}

}  // namespace aeroloom::mesh
