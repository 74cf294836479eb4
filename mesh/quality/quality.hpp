/// Shape measures of triangles and tetrahedra, and their distribution over a mesh.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::mesh {

/// Smallest and largest dihedral angle of a tetrahedron, degrees. Flat and inverted ones give 0 and 180.
struct DihedralRange {
  double smallest = 0, largest = 180;
};
DihedralRange dihedral_range(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c, geometry::Vec3 d);
/// 12 (3V)^(2/3) / sum of squared edges: 1 regular, 0 flat, negative inverted (Liu and Joe, BIT 34, 1994,
/// doi:10.1007/BF01955874).
double mean_ratio(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c, geometry::Vec3 d);
/// 3 inradius / circumradius of a tetrahedron: 1 regular, 0 flat, negative inverted.
double radius_ratio(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c, geometry::Vec3 d);
/// 4 sqrt(3) area / sum of squared edges of a triangle: 1 equilateral, 0 flat.
double triangle_mean_ratio(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c);
/// Smallest angle of a triangle, degrees.
double smallest_angle(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c);
/// Largest angle of a triangle, degrees.
double largest_angle(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c);

/// A histogram over [low, high) with equal bins; what falls outside counts in the first or last bin. Bins are
/// two degrees or a fiftieth of a ratio wide.
struct Histogram {
  double low = 0, high = 1;
  std::vector<std::int64_t> counts;
};

/// A cell worth looking at.
struct WorstCell {
  double value = 0;
  GlobalIndex cell = 0;
  geometry::Vec3 center;
};

/// Distribution of one measure over all cells; all zero where there is no cell.
struct Distribution {
  double minimum = 0, maximum = 0, mean = 0;
  /// The values that 0.1 %, 1 % and 5 % of the cells do not exceed, rounded down to a hundredth of a degree
  /// (ratios: to a ten-thousandth), but never below the minimum.
  double percentile_01 = 0, percentile_1 = 0, percentile_5 = 0;
  Histogram histogram;
};

struct QualitySummary {
  Distribution min_dihedral;  ///< degrees (triangles: smallest angle)
  Distribution max_dihedral;  ///< degrees (triangles: largest angle)
  Distribution mean_ratio;
  Distribution radius_ratio;     ///< tetrahedra only
  std::vector<WorstCell> worst;  ///< the ten of smallest min_dihedral, worst first, ties by global number
};

/// Cells of this rank with an angle outside limits.
struct CellsOutside {
  DihedralRange limits;                        ///< degrees, asked for
  std::vector<std::vector<LocalIndex>> cells;  ///< per local piece, ascending; filled in
};

/// Cells of boundary layers are left out. `outside`, if any, is filled in on the way. Collective; the same on
/// every rank and for any number of ranks (sums are taken in piece order).
QualitySummary summarise_quality(const NumberedMesh& mesh, CellsOutside* outside = nullptr);

}  // namespace aeroloom::mesh
