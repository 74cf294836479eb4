/// Sizes that a user asks for at places and on patches, beside what the model asks for by itself.
#pragma once

#include "aeroloom/geometry/vec.hpp"
#include "aeroloom/sizing/size_field.hpp"
#include "aeroloom/sizing/sources.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// A part of space in which elements are at most so large. Lengths in the model's unit.
struct SizeRegion {
  enum class Shape : std::uint8_t {
    box,      ///< `start` and `end` are opposite corners
    sphere,   ///< around `start`; with radius 0 a point
    cylinder  ///< with plane ends at `start` and `end`; with other radii a cone, with radii 0 a line
  };
  std::string name;
  Shape shape = Shape::sphere;
  geometry::Vec3 start, end;
  double start_radius = 0, end_radius = 0;
  double size = 0;

  /// How far a point is from the region; 0 inside.
  double distance_to(geometry::Vec3 p) const;
  /// The box around it.
  geometry::Box box() const;
};

/// Elements on the faces of a patch are at most so large.
struct PatchSize {
  std::string patch;
  double size = 0;
};

/// A line through its points, on which elements are at most so large: linear in between.
struct SizeLine {
  std::vector<geometry::Vec3> points;
  std::vector<double> sizes;
};

struct SizeDemands {
  std::vector<SizeRegion> regions;
  std::vector<PatchSize> patches;
  std::vector<SizeLine> lines;
};

/// Sources along a line with all its sizes `coarser` times as large: no two of them farther apart than half
/// of the size there; in a cell of the octree of about their size the smallest alone.
std::vector<SizeSource> sources_along(const RootCube& root, const SizeLine& line, double coarser);
/// How many there would be, at most.
double points_along(const SizeLine& line, double coarser);

/// The largest size that its patch allows on each face; 0 where nothing is asked for.
std::vector<double> sizes_on_faces(const cad::Model& model, const SizeDemands& demands);

/// Cells of the octree that hold a region, each at most as large as `size`; about, and rather too many.
double cells_in(const RootCube& root, const SizeRegion& region, double size);

/// One rank's part of sources that ask for `size` wherever the region is in the root cube; outside of the
/// region by half a diagonal of a cell at most. Those of all ranks together do not depend on how many there
/// are.
std::vector<SizeSource> sources_in(const RootCube& root, const SizeRegion& region, double size, int rank,
                                   int ranks);

}  // namespace aeroloom::sizing
