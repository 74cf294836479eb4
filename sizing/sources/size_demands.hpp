/// Sizes that a user asks for at places and on patches, beside what the model asks for by itself.
#pragma once

#include "geometry/vec.hpp"
#include "sizing/field/size_field.hpp"
#include "sizing/field/sources.hpp"
#include "sizing/sources/patch_size.hpp"
#include "sizing/sources/size_expression.hpp"
#include "sizing/sources/size_shapes.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// A part of space in which elements are at most so large. Lengths in the model's unit.
struct SizeRegion {
  std::string name;
  SolidShape shape;
  double size = 0;
};

/// Elements are at most as large as a formula of the place has them.
struct FormulaSize {
  SizeExpression expression;
  double minimum = 0;  ///< but need not be smaller than this
  double unit = 1;     ///< of the formula's places and sizes
};

/// Elements at walls and up to a distance off them are at most so large.
struct WallSize {
  std::string name;
  std::vector<std::string> faces;  ///< patterns of faces' or patches' names; none: all but the far field
  double size = 0;
  double distance = 0;
};

/// Elements are at most so large on a wake.
struct WakeSize {
  std::string name;
  WakeShape shape;
  double size = 0;  ///< where it begins

  double end_size() const { return shape.end_size.value_or(size); }
};

/// Elements along CAD edges are at most so large.
struct EdgeSize {
  std::string name;
  std::vector<std::string>
      between;  ///< patterns: one, of a face at the edge, or two, of faces that meet there
  std::optional<geometry::Box> within;  ///< only parts of edges in it
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
  std::optional<FormulaSize> formula = {};
  std::vector<WallSize> walls = {};
  std::vector<WakeSize> wakes = {};
  std::vector<EdgeSize> edges = {};
  std::vector<SizeLine> lines = {};
};

/// Throws std::invalid_argument, with the key, where a pattern matches no face of the model.
void require_faces(const cad::Model& model, const SizeDemands& demands);

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

/// What a formula is asked in.
struct FormulaSpace {
  geometry::Box domain;  ///< nowhere else
  geometry::Box body;    ///< here more closely
  double coarser = 1;    ///< sizes are so many times as large as the formula has them
  double limit = 0;      ///< only sizes below this count
  double slope = 0;      ///< of the field that is to follow the formula, at most
};

/// As sources_in(), of a formula: in cells that are no larger than its value in their middle and in the
/// middles of their eighths, and a 32nd of the domain and, around the body, of the body at most. The field
/// that they make agrees with a linear formula at corners of cells. Ends early with one more than `most`
/// sources. Throws std::runtime_error where the formula has no size.
std::vector<SizeSource> sources_of_formula(const RootCube& root, const FormulaSize& formula,
                                           const FormulaSpace& space, int rank, int ranks,
                                           std::int64_t most = std::numeric_limits<std::int64_t>::max());

}  // namespace aeroloom::sizing
