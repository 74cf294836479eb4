#include "mesh/exchange/delivery.hpp"
#include "mesh/quality/distribution.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/tet_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::mesh {

using geometry::Vec3;

namespace {

constexpr std::size_t worst_kept = 10;

enum SummaryMeasure { min_angle, max_angle, shape, radii, measures };
constexpr Scale scales[measures] = {angle_scale, angle_scale, ratio_scale, ratio_scale};

struct Values {
  double of[measures];

  static constexpr auto fields() { return std::tuple(&Values::of); }
};

Values measure_triangle(const Piece& piece, LocalIndex c) {
  const LocalIndex* v = piece.cell(c);
  const Vec3 p[3] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
  return {{smallest_angle(p[0], p[1], p[2]), largest_angle(p[0], p[1], p[2]),
           triangle_mean_ratio(p[0], p[1], p[2]), 0}};
}

/// Calls visit(cell, values) for the cells of a piece, ascending. A cell with a coordinate that is no number
/// counts as flat; those of boundary layers are flat on purpose and left out.
template <class Visit>
void for_each_cell(const Piece& piece, const Visit& visit) {
  if (!piece.layers.empty()) return;
  const auto visit_finite = [&](LocalIndex c, Values values) {
    for (double& value : values.of) {
      if (!std::isfinite(value)) value = 0;
    }
    visit(c, values);
  };
  if (piece.kind == CellKind::triangle) {
    for (LocalIndex c = 0; c < piece.cell_count(); ++c) visit_finite(c, measure_triangle(piece, c));
    return;
  }
  TetMeasures of;
  for (LocalIndex first = 0; first < piece.cell_count(); first += TetMeasures::most) {
    const int count = std::min(TetMeasures::most, piece.cell_count() - first);
    of.measure(piece, first, count);
    for (int i = 0; i < count; ++i) {
      visit_finite(first + i,
                   {{of.smallest_dihedral[i], of.largest_dihedral[i], of.mean_ratio[i], of.radius_ratio[i]}});
    }
  }
}

Vec3 center_of(const Piece& piece, LocalIndex c) {
  Vec3 sum;
  for (int k = 0; k < piece.vertices_per_cell(); ++k) sum += piece.point(piece.cell(c)[k]);
  return sum / piece.vertices_per_cell();
}

bool worse(const WorstCell& a, const WorstCell& b) {
  return std::tie(a.value, a.cell) < std::tie(b.value, b.cell);
}

void keep_worst(std::vector<WorstCell>& worst) {
  std::sort(worst.begin(), worst.end(), worse);
  if (worst.size() > worst_kept) worst.resize(worst_kept);
}

/// What one rank knows of its pieces.
struct LocalSummary {
  std::vector<Accumulator> measure;
  std::vector<Values> sums;  ///< per piece
  std::vector<WorstCell> worst;
};

LocalSummary summarise_local(const NumberedMesh& mesh, CellsOutside& outside) {
  LocalSummary local;
  for (const Scale& scale : scales) local.measure.emplace_back(scale);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    Values sum{};
    std::vector<LocalIndex>& cells_outside = outside.cells.emplace_back();
    for_each_cell(piece, [&](LocalIndex c, const Values& values) {
      if (values.of[min_angle] < outside.limits.smallest || values.of[max_angle] > outside.limits.largest)
        cells_outside.push_back(c);
      for (int m = 0; m < measures; ++m) {
        local.measure[m].add(values.of[m], scales[m]);
        sum.of[m] += values.of[m];
      }
      const WorstCell candidate{values.of[min_angle], mesh.numbering.first_cell[i] + c, {}};
      if (local.worst.size() < worst_kept || worse(candidate, local.worst.back())) {
        local.worst.push_back({candidate.value, candidate.cell, center_of(piece, c)});
        keep_worst(local.worst);
      }
    });
    local.sums.push_back(sum);
  }
  return local;
}

Distribution distribution_of(const parallel::Communicator& communicator, Accumulator& local,
                             const Scale& scale, double sum) {
  const BinnedValues values(communicator, local, scale);
  Distribution result;
  result.minimum = values.minimum();
  result.maximum = values.maximum();
  result.histogram.high = scale.high;
  result.histogram.counts = values.histogram();
  if (values.count() == 0) return result;
  result.mean = sum / static_cast<double>(values.count());
  const auto at = [&](int per_mille) { return std::max(result.minimum, values.percentile(per_mille)); };
  result.percentile_01 = at(1);
  result.percentile_1 = at(10);
  result.percentile_5 = at(50);
  return result;
}

}  // namespace

QualitySummary summarise_quality(const NumberedMesh& mesh, CellsOutside* outside) {
  const parallel::Communicator& communicator = mesh.communicator;
  CellsOutside nobody_asks;
  LocalSummary local = summarise_local(mesh, outside != nullptr ? *outside : nobody_asks);
  Values sums{};
  for (const Values& piece : gather_by_piece(mesh, local.sums)) {
    for (int m = 0; m < measures; ++m) sums.of[m] += piece.of[m];
  }
  const auto distribution = [&](SummaryMeasure m) {
    return distribution_of(communicator, local.measure[m], scales[m], sums.of[m]);
  };
  QualitySummary summary;
  summary.min_dihedral = distribution(min_angle);
  summary.max_dihedral = distribution(max_angle);
  summary.mean_ratio = distribution(shape);
  if (mesh.kind == CellKind::tetrahedron) summary.radius_ratio = distribution(radii);
  summary.worst = communicator.all_gather_items(std::span<const WorstCell>(local.worst));
  keep_worst(summary.worst);
  return summary;
}

}  // namespace aeroloom::mesh
