#include "mesh/quality/mixed_quality.hpp"

#include "mesh/exchange/delivery.hpp"
#include "mesh/quality/distribution.hpp"
#include "mesh/quality/neighbour_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <utility>

namespace aeroloom::mesh {

namespace {

using geometry::Vec3;

constexpr std::size_t kept_per_measure = 10;

constexpr Scale growth_scale{0, 8, 1000, 100, true};
/// By Measure.
constexpr std::array<Scale, measure_count> measure_scales = {angle_scale,
                                                             angle_scale,
                                                             ratio_scale,
                                                             ratio_scale,
                                                             Scale{-1, 1, 10000, 200, false},
                                                             growth_scale,
                                                             growth_scale,
                                                             Scale{-40, 40, 200, 100, true}};

using SumsOfShapes = std::array<std::array<double, measure_count>, cell_shape_count>;

/// An amount that a piece contributes to region or patch `id`.
struct AmountOfPiece {
  PieceId piece;
  std::int32_t id;
  double amount;
};

/// What one rank knows of its pieces.
class LocalQuality {
public:
  std::array<std::array<Accumulator, measure_count>, cell_shape_count> of;
  std::vector<SumsOfShapes> sums;  ///< per piece
  std::array<std::vector<WorstCellOfShape>, measure_count> worst;
  std::vector<AmountOfPiece> region_volumes, patch_areas;
  PlaceSearch places;

  /// `p`: of the piece among those of this rank.
  void add_piece(const Piece& piece, GlobalIndex first_cell, const NeighbourVolumes& neighbours,
                 std::size_t p) {
    const std::vector<double>&volumes = neighbours.volumes[p], &ratios = neighbours.ratios[p];
    SumsOfShapes sum{};
    std::array<Vec3, most_corners> points;
    for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) {
      const CellOfPiece cell = cell_of(piece, c);
      const int count = points_of(piece, cell, points.data());
      CellValues values = measure_cell(cell.shape, points.data());
      values[static_cast<std::size_t>(Measure::volume_ratio)] = ratios[static_cast<std::size_t>(c)];
      Vec3 center;
      for (int k = 0; k < count; ++k) center += points[static_cast<std::size_t>(k)];
      add_cell(cell.shape, values, {0, first_cell + c, cell.shape, center / count},
               sum[static_cast<std::size_t>(cell.shape)]);
      const double shape_value = cell.shape == CellShape::tetrahedron
                                     ? corner_shape(cell.shape, points.data())
                                     : values[static_cast<std::size_t>(Measure::scaled_jacobian)];
      places.add({cell.shape, first_cell + c, center / count, !piece.layers.empty(),
                  values[static_cast<std::size_t>(Measure::smallest_dihedral)], shape_value,
                  neighbours.jumps[p][static_cast<std::size_t>(c)]});
    }
    sums.push_back(sum);
    add_volumes(piece, volumes);
    add_areas(piece);
  }

private:
  void add_cell(CellShape shape, const CellValues& values, WorstCellOfShape candidate,
                std::array<double, measure_count>& sum) {
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (!has_measure(shape, all_measures[m])) continue;
      if (all_measures[m] == Measure::volume_ratio && values[m] == 0) continue;
      Accumulator& measure = of[static_cast<std::size_t>(shape)][m];
      if (measure.bins.empty()) measure.bins.assign(measure_scales[m].bins(), 0);
      measure.add(values[m], measure_scales[m]);
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
    if (kept.size() == kept_per_measure && !worse(candidate, kept.back())) return;
    kept.insert(std::upper_bound(kept.begin(), kept.end(), candidate, worse), candidate);
    if (kept.size() > kept_per_measure) kept.pop_back();
  }

  void add_volumes(const Piece& piece, const std::vector<double>& volumes) {
    std::size_t first = 0;
    for (const CellShape shape : cell_shapes) {
      for_each_region_run(piece, shape, [&](RegionId region, LocalIndex begin, LocalIndex end) {
        double volume = 0;
        for (LocalIndex i = begin; i < end; ++i) volume += volumes[first + static_cast<std::size_t>(i)];
        region_volumes.push_back({piece.id, region, volume});
      });
      first += connectivity_of(piece, shape).size() / static_cast<std::size_t>(corners_of(shape));
    }
  }

  void add_areas(const Piece& piece) {
    std::map<std::int32_t, double> areas;
    std::array<Vec3, 4> points;
    for (const FaceShape shape : face_shapes) {
      areas.clear();
      const std::span<const LocalIndex> corners = connectivity_of(piece, shape);
      const auto n = static_cast<std::size_t>(corners_of(shape));
      for (std::size_t f = 0; f < corners.size() / n; ++f) {
        for (std::size_t k = 0; k < n; ++k) points[k] = piece.point(corners[n * f + k]);
        areas[patches_of(piece, shape)[f]] += face_area(shape, points.data());
      }
      for (const auto& [patch, area] : areas) patch_areas.push_back({piece.id, patch, area});
    }
  }

public:
  static bool is_worse(Measure measure, const WorstCellOfShape& a, const WorstCellOfShape& b) {
    const double sign = larger_is_worse(measure) ? -1 : 1;
    return std::make_tuple(sign * a.value, a.cell) < std::make_tuple(sign * b.value, b.cell);
  }
};

/// The shares of all ranks, summed in the order of pieces. Collective.
std::vector<double> add_amounts(const parallel::Communicator& communicator,
                                const std::vector<AmountOfPiece>& mine, std::size_t count) {
  std::vector<AmountOfPiece> all = communicator.all_gather_items(std::span<const AmountOfPiece>(mine));
  std::stable_sort(all.begin(), all.end(),
                   [](const AmountOfPiece& a, const AmountOfPiece& b) { return a.piece < b.piece; });
  std::vector<double> sums(count, 0.0);
  for (const AmountOfPiece& share : all) sums.at(static_cast<std::size_t>(share.id)) += share.amount;
  return sums;
}

/// Collective.
MeasureDistribution measure_distribution(const parallel::Communicator& communicator, Accumulator& local,
                                         const Scale& scale, double sum) {
  const BinnedValues values(communicator, local, scale);
  MeasureDistribution result;
  result.histogram = {scale.low, scale.high, scale.logarithmic, values.histogram()};
  result.cells = values.count();
  if (result.cells == 0) return result;
  result.minimum = values.minimum(), result.maximum = values.maximum();
  result.mean = std::clamp(sum / static_cast<double>(result.cells), result.minimum, result.maximum);
  for (std::size_t i = 0; i < percentiles_per_mille.size(); ++i)
    result.percentiles[i] =
        std::clamp(values.percentile(percentiles_per_mille[i]), result.minimum, result.maximum);
  return result;
}

/// Collective.
std::vector<WorstCellOfShape> worst_of_all(const parallel::Communicator& communicator, Measure measure,
                                           const std::vector<WorstCellOfShape>& mine) {
  auto all = communicator.all_gather_items(std::span<const WorstCellOfShape>(mine));
  std::sort(all.begin(), all.end(), [measure](const WorstCellOfShape& a, const WorstCellOfShape& b) {
    return LocalQuality::is_worse(measure, a, b);
  });
  if (all.size() > kept_per_measure) all.resize(kept_per_measure);
  return all;
}

/// Whether the mesh seems to have layers and no piece knows them, as in files. Collective.
bool layers_are_unknown(const NumberedMesh& mesh, const MeshCounts& counts, const MixedQuality& quality) {
  constexpr double flat_deg = 1;  // of a twentieth of the tetrahedra; chosen, not measured
  constexpr std::size_t twentieth = 2;
  static_assert(percentiles_per_mille[twentieth] == 50);
  const bool known = std::any_of(mesh.pieces.begin(), mesh.pieces.end(),
                                 [](const Piece& piece) { return !piece.layers.empty(); });
  if (mesh.communicator.maximum(std::int64_t{known}) > 0) return false;
  const MeasureDistribution& angles =
      quality.distribution(CellShape::tetrahedron, Measure::smallest_dihedral);
  return counts.has_other_shapes() || (angles.cells > 0 && angles.percentiles[twentieth] < flat_deg);
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

MixedQuality measure_quality(const NumberedMesh& mesh, const FaceLinks& links) {
  const parallel::Communicator& communicator = mesh.communicator;
  LocalQuality local;
  {
    const NeighbourVolumes neighbours = compare_volumes(mesh, links);
    for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
      local.add_piece(mesh.pieces[i], mesh.numbering.first_cell[i], neighbours, i);
  }
  SumsOfShapes sums{};
  for (const SumsOfShapes& piece : gather_by_piece(mesh, local.sums)) {
    for (std::size_t s = 0; s < cell_shape_count; ++s) {
      for (std::size_t m = 0; m < measure_count; ++m) sums[s][m] += piece[s][m];
    }
  }
  const MeshCounts counts = count_mesh(mesh);
  MixedQuality result;
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    if (counts.of(cell_shapes[s]) == 0) continue;
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (has_measure(cell_shapes[s], all_measures[m]))
        result.of[s][m] = measure_distribution(communicator, local.of[s][m], measure_scales[m], sums[s][m]);
    }
  }
  for (std::size_t m = 0; m < measure_count; ++m)
    result.worst[m] = worst_of_all(communicator, all_measures[m], local.worst[m]);
  result.places = local.places.find(communicator, layers_are_unknown(mesh, counts, result));
  result.region_volumes =
      add_amounts(communicator, local.region_volumes, static_cast<std::size_t>(mesh.region_count()));
  result.patch_areas = add_amounts(communicator, local.patch_areas, mesh.patches.size());
  for (const double volume : result.region_volumes) result.volume += volume;
  result.defects = links.defects;
  return result;
}

}  // namespace aeroloom::mesh
