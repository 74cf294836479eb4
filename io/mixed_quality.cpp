#include "io/mixed_quality.hpp"

#include "io/neighbour_volumes.hpp"
#include "mesh/bin_sums.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::io {

namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;

constexpr std::size_t worst_kept = 10;

/// The range of a measure (or of its logarithm), its fine bins per unit, and how many of those make a bin of
/// the published histogram.
struct Scale {
  double low, high;
  int bins_per_unit, merged;
  bool logarithmic;

  std::size_t bins() const { return static_cast<std::size_t>((high - low) * bins_per_unit); }
  double lower_end(std::size_t bin) const {
    const double at = low + static_cast<double>(bin) / bins_per_unit;
    return logarithmic ? std::pow(10.0, at) : at;
  }
};
constexpr Scale angle_scale{0, 180, 100, 200, false};
constexpr Scale ratio_scale{0, 1, 10000, 200, false};
constexpr Scale growth_scale{0, 8, 1000, 100, true};
constexpr std::array<Scale, measure_count> scales = {angle_scale,
                                                     angle_scale,
                                                     ratio_scale,
                                                     ratio_scale,
                                                     Scale{-1, 1, 10000, 200, false},
                                                     growth_scale,
                                                     growth_scale,
                                                     Scale{-40, 40, 200, 100, true}};

/// One measure over the cells seen so far.
class Accumulator {
public:
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> bins;

  void add(double value, const Scale& scale) {
    if (bins.empty()) bins.assign(scale.bins(), 0);
    minimum = std::min(minimum, value);
    maximum = std::max(maximum, value);
    const double on_scale = scale.logarithmic ? (value > 0 ? std::log10(value) : scale.low) : value;
    const double bin = (on_scale - scale.low) * scale.bins_per_unit;
    ++bins[static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(bins.size() - 1)))];
  }
};

struct PartSums {
  std::int32_t part = 0;
  std::array<std::array<double, measure_count>, cell_shape_count> of{};

  static constexpr auto fields() { return std::tuple(&PartSums::part, &PartSums::of); }
};

/// An amount that a part contributes to region or patch `id`.
struct AmountOfPart {
  std::int32_t part, id;
  double amount;

  static constexpr auto fields() {
    return std::tuple(&AmountOfPart::part, &AmountOfPart::id, &AmountOfPart::amount);
  }
};

/// What one rank knows of its parts.
class LocalQuality {
public:
  std::array<std::array<Accumulator, measure_count>, cell_shape_count> of;
  std::vector<PartSums> sums;
  std::array<std::vector<WorstCellOfShape>, measure_count> worst;
  std::vector<AmountOfPart> region_volumes, patch_areas;

  void add_part(const FilePart& part, const std::vector<double>& volumes, const std::vector<double>& ratios) {
    PartSums sum{part.id};
    const GlobalIndex first = part.cells[0].before + part.cells[1].before + part.cells[2].before;
    std::array<Vec3, 6> corners;
    for (LocalIndex c = 0; c < part.cell_count(); ++c) {
      const CellOfPart cell = cell_of(part, c);
      const int count = corners_of_cell(part, cell, corners.data());
      CellValues values = measure_cell(cell.shape, corners.data());
      values[static_cast<std::size_t>(Measure::volume_ratio)] = ratios[static_cast<std::size_t>(c)];
      Vec3 center;
      for (int k = 0; k < count; ++k) center += corners[static_cast<std::size_t>(k)];
      add_cell(cell.shape, values, {0, first + c, cell.shape, center / count},
               sum.of[static_cast<std::size_t>(cell.shape)]);
    }
    sums.push_back(sum);
    add_volumes(part, volumes);
    add_areas(part);
  }

private:
  void add_cell(CellShape shape, const CellValues& values, WorstCellOfShape candidate,
                std::array<double, measure_count>& sum) {
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (!has_measure(shape, all_measures[m])) continue;
      if (all_measures[m] == Measure::volume_ratio && values[m] == 0) continue;
      of[static_cast<std::size_t>(shape)][m].add(values[m], scales[m]);
      sum[m] += values[m];
      candidate.value = values[m];
      keep(m, candidate);
    }
  }

  void keep(std::size_t m, const WorstCellOfShape& candidate) {
    std::vector<WorstCellOfShape>& kept = worst[m];
    const auto worse = [m](const WorstCellOfShape& a, const WorstCellOfShape& b) {
      return is_worse(all_measures[m], a, b);
    };
    if (kept.size() == worst_kept && !worse(candidate, kept.back())) return;
    kept.insert(std::upper_bound(kept.begin(), kept.end(), candidate, worse), candidate);
    if (kept.size() > worst_kept) kept.pop_back();
  }

  void add_volumes(const FilePart& part, const std::vector<double>& volumes) {
    std::size_t first = 0;
    for (const Block& block : part.cells) {
      for (const Run& run : block.runs) {
        double volume = 0;
        for (LocalIndex i = run.begin; i < run.end; ++i)
          volume += volumes[first + static_cast<std::size_t>(i)];
        region_volumes.push_back({part.id, run.id, volume});
      }
      first += static_cast<std::size_t>(block.count());
    }
  }

  void add_areas(const FilePart& part) {
    std::array<Vec3, 4> corners;
    for (const FaceShape shape : face_shapes) {
      const Block& block = part.faces[static_cast<std::size_t>(shape)];
      for (const Run& run : block.runs) {
        double area = 0;
        for (LocalIndex i = run.begin; i < run.end; ++i) {
          for (std::size_t k = 0; k < static_cast<std::size_t>(block.corners); ++k)
            corners[k] = part.point(block.item(i)[k]);
          area += face_area(shape, corners.data());
        }
        patch_areas.push_back({part.id, run.id, area});
      }
    }
  }

public:
  static bool is_worse(Measure measure, const WorstCellOfShape& a, const WorstCellOfShape& b) {
    const double sign = larger_is_worse(measure) ? -1 : 1;
    return std::make_tuple(sign * a.value, a.cell) < std::make_tuple(sign * b.value, b.cell);
  }
};

/// The rows of all ranks in the order of parts. Collective.
template <class Row>
std::vector<Row> by_part(const parallel::Communicator& communicator, const std::vector<Row>& mine) {
  std::vector<Row> all = communicator.all_gather_items(std::span<const Row>(mine));
  std::stable_sort(all.begin(), all.end(), [](const Row& a, const Row& b) { return a.part < b.part; });
  return all;
}

/// Collective.
std::vector<double> add_shares(const parallel::Communicator& communicator,
                               const std::vector<AmountOfPart>& mine, std::size_t count) {
  std::vector<double> sums(count, 0.0);
  for (const AmountOfPart& share : by_part(communicator, mine))
    sums.at(static_cast<std::size_t>(share.id)) += share.amount;
  return sums;
}

double percentile(const std::vector<std::int64_t>& bins, const Scale& scale, GlobalIndex cells,
                  int per_mille) {
  const GlobalIndex wanted =
      std::max<GlobalIndex>(1, cells / 1000 * per_mille + (cells % 1000 * per_mille + 999) / 1000);
  GlobalIndex seen = 0;
  std::size_t bin = 0;
  while (bin < bins.size() && (seen += bins[bin]) < wanted) ++bin;
  return scale.lower_end(bin);
}

/// Collective.
MeasureDistribution distribution_of(const parallel::Communicator& communicator, Accumulator& local,
                                    const Scale& scale, double sum) {
  if (local.bins.empty()) local.bins.assign(scale.bins(), 0);
  const std::vector<std::int64_t> bins = mesh::sum_bins(communicator, local.bins);
  std::vector<std::int64_t>().swap(local.bins);
  MeasureDistribution result;
  result.histogram = {scale.low, scale.high, scale.logarithmic, {}};
  const auto merged = static_cast<std::size_t>(scale.merged);
  result.histogram.counts.assign(bins.size() / merged, 0);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    result.histogram.counts[b / merged] += bins[b];
    result.cells += bins[b];
  }
  const double minimum = communicator.minimum(local.minimum), maximum = communicator.maximum(local.maximum);
  if (result.cells == 0) return result;
  result.minimum = minimum, result.maximum = maximum;
  result.mean = std::clamp(sum / static_cast<double>(result.cells), minimum, maximum);
  for (std::size_t i = 0; i < percentiles_per_mille.size(); ++i) {
    result.percentiles[i] =
        std::clamp(percentile(bins, scale, result.cells, percentiles_per_mille[i]), minimum, maximum);
  }
  return result;
}

/// Collective.
std::vector<WorstCellOfShape> worst_of_all(const parallel::Communicator& communicator, Measure measure,
                                           const std::vector<WorstCellOfShape>& mine) {
  auto all = communicator.all_gather_items(std::span<const WorstCellOfShape>(mine));
  std::sort(all.begin(), all.end(), [measure](const WorstCellOfShape& a, const WorstCellOfShape& b) {
    return LocalQuality::is_worse(measure, a, b);
  });
  if (all.size() > worst_kept) all.resize(worst_kept);
  return all;
}

}  // namespace

double MeasureHistogram::edge(std::size_t bin) const {
  const double at = low + (high - low) * static_cast<double>(bin) / static_cast<double>(counts.size());
  return logarithmic ? std::pow(10.0, at) : at;
}

double MixedQuality::worst_of(Measure measure, double otherwise) const {
  const std::vector<WorstCellOfShape>& cells = worst[static_cast<std::size_t>(measure)];
  return cells.empty() ? otherwise : cells.front().value;
}

MixedQuality measure_quality(const parallel::Communicator& communicator, const FileMesh& mesh,
                             const FaceLinks& links) {
  LocalQuality local;
  {
    const NeighbourVolumes neighbours = compare_volumes(communicator, mesh, links);
    for (std::size_t i = 0; i < mesh.parts.size(); ++i)
      local.add_part(mesh.parts[i], neighbours.volumes[i], neighbours.ratios[i]);
  }
  std::array<std::array<double, measure_count>, cell_shape_count> sums{};
  for (const PartSums& part : by_part(communicator, local.sums)) {
    for (std::size_t s = 0; s < cell_shape_count; ++s) {
      for (std::size_t m = 0; m < measure_count; ++m) sums[s][m] += part.of[s][m];
    }
  }
  MixedQuality result;
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    if (mesh.cell_count(shape) == 0) continue;
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (has_measure(shape, all_measures[m]))
        result.of[s][m] = distribution_of(communicator, local.of[s][m], scales[m], sums[s][m]);
    }
  }
  for (std::size_t m = 0; m < measure_count; ++m)
    result.worst[m] = worst_of_all(communicator, all_measures[m], local.worst[m]);
  result.region_volumes = add_shares(communicator, local.region_volumes, mesh.regions.size());
  result.patch_areas = add_shares(communicator, local.patch_areas, mesh.patches.size());
  for (const double volume : result.region_volumes) result.volume += volume;
  result.defects = links.defects;
  return result;
}

}  // namespace aeroloom::io
