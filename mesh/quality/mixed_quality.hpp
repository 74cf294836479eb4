/// How good the cells of a mesh of several shapes are.
#pragma once

#include "mesh/quality/cell_measures.hpp"
#include "mesh/quality/face_links.hpp"
#include "mesh/quality/worst_places.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// The parts of the cells, per mille, that percentiles are given for.
inline constexpr std::array<int, 7> percentiles_per_mille = {1, 10, 50, 500, 950, 990, 999};

/// Equal bins from `low` to `high`, of decimal logarithms where `logarithmic`; what lies outside counts in
/// the first or last.
struct MeasureHistogram {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<std::int64_t> counts;
  /// The lower end of a bin; of `counts.size()` the upper end of the last.
  double edge(std::size_t bin) const;
};

/// Distribution of one measure over cells; all zero where none has it.
struct MeasureDistribution {
  GlobalIndex cells = 0;  ///< that have it; cells without a neighbour have no ratio of volumes
  double minimum = 0, maximum = 0, mean = 0;
  /// The values that these parts of the cells do not exceed, rounded down: angles to 0.01 degrees, other
  /// linear measures to 0.0001, ratios by 0.25 %, volumes by 1.2 % at most; never outside of the range.
  std::array<double, percentiles_per_mille.size()> percentiles{};
  MeasureHistogram histogram;
};

struct MixedQuality {
  std::array<std::array<MeasureDistribution, measure_count>, cell_shape_count> of;  ///< by shape and Measure
  /// The ten worst of all shapes by Measure, worst first, ties by number.
  std::array<std::vector<WorstCellOfShape>, measure_count> worst;
  /// Ten each, and ten of all. Cells of layers are those of pieces that know their layers. Where none does
  /// but the mesh has prisms, pyramids, or many flat tetrahedra, any tetrahedron may be of a layer.
  WorstPlaces places;
  double volume = 0;                   ///< of the mesh
  std::vector<double> region_volumes;  ///< by region
  std::vector<double> patch_areas;     ///< by patch
  LinkDefects defects;

  const MeasureDistribution& distribution(CellShape shape, Measure measure) const {
    return of[static_cast<std::size_t>(shape)][static_cast<std::size_t>(measure)];
  }
  /// The smallest or largest value of all shapes, whichever is worse; `otherwise` where no cell has it.
  double worst_of(Measure measure, double otherwise) const;
};

/// `links` are those of the mesh. Collective; the same on every rank and for any number of ranks (sums are
/// taken in the order of pieces).
MixedQuality measure_quality(const NumberedMesh& mesh, const FaceLinks& links);

}  // namespace aeroloom::mesh
