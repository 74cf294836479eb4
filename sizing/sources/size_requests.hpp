/// Sizes that a user requests at places and on patches. The model asks for other sizes by itself.
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

/// A region in which elements are at most so large. Lengths are in the unit of the model.
struct SizeRegion {
  std::string name;
  SolidShape shape;
  double size = 0;
};

/// A largest element size as a formula of the place.
struct FormulaSize {
  SizeExpression expression;
  double minimum = 0;  ///< smaller values of the formula count as this
  double unit = 1;     ///< length unit of the formula, in that of the model
};

/// A largest element size at walls and up to a distance from them.
struct WallSize {
  std::string name;
  std::vector<std::string> faces;  ///< patterns of faces' or patches' names; none: all but the far field
  double size = 0;
  double distance = 0;
};

/// A largest element size on a wake.
struct WakeSize {
  std::string name;
  WakeShape shape;
  double size = 0;  ///< where it begins

  double end_size() const { return shape.end_size.value_or(size); }
};

/// A largest element size along CAD edges.
struct EdgeSize {
  std::string name;
  std::vector<std::string>
      between;  ///< patterns: one, of a face at the edge, or two, of faces that meet there
  std::optional<geometry::Box> within;  ///< only parts of edges in it
  double size = 0;
  double size_at_ends = 0;  ///< of each CAD edge, where rows along it end; 0: as along it
};

/// A line through points, with a largest element size at each. It is linear in between.
struct SizeLine {
  std::vector<geometry::Vec3> points;
  std::vector<double> sizes;
};

struct SizeRequests {
  std::vector<SizeRegion> regions;
  std::vector<PatchSize> patches;
  std::optional<FormulaSize> formula = {};
  std::vector<WallSize> walls = {};
  std::vector<WakeSize> wakes = {};
  std::vector<EdgeSize> edges = {};
  std::vector<SizeLine> lines = {};
  std::vector<SizeSource> places = {};  ///< points with sizes; each rank has all
};

/// Throws std::invalid_argument, with the key, where a pattern matches no face of the model.
void require_faces(const cad::Model& model, const SizeRequests& requests);

/// Sources along a line, with all its sizes `coarsening` times as large. Two of them are at most half a size
/// apart. Of several in one octree cell of about their size the smallest is kept.
std::vector<SizeSource> sources_along(const RootCube& root, const SizeLine& line, double coarsening);
/// The most sources that sources_along() would make.
double points_along(const SizeLine& line, double coarsening);

/// The largest size that its patch allows on each face; 0 if there is no such size.
std::vector<double> sizes_on_faces(const cad::Model& model, const SizeRequests& requests);

/// The number of octree cells that fill a region, each at most as large as `size`. It is rather too large.
double cells_in(const RootCube& root, const SizeRegion& region, double size);

/// The sources of one rank for `size` in all of a region inside the root cube. They lie outside of the region
/// by at most half the diagonal of a cell. The sources of all ranks together do not depend on the number of
/// ranks.
std::vector<SizeSource> sources_in(const RootCube& root, const SizeRegion& region, double size, int rank,
                                   int ranks);

/// Where and how a formula is evaluated.
struct FormulaSpace {
  geometry::Box domain;   ///< the formula is evaluated only here
  geometry::Box body;     ///< more closely here
  double coarsening = 1;  ///< factor on the sizes of the formula
  double limit = 0;       ///< only sizes below this count
  double slope = 0;       ///< the largest slope of the field that follows the formula
};

/// About the number of cells that sources_of_formula() finds, from 32 places along each side of the domain.
/// Too few if the formula has narrow dents. Throws std::runtime_error where it has no size.
double cells_of_formula(const FormulaSize& formula, const FormulaSpace& space);

/// As sources_in(), for a formula. Cells are no larger than its value in their middle and in the middles of
/// their eighths. They are at most a 32nd of the domain and, around the body, of the body. At corners of
/// cells, the field equals a linear formula. Ends early with one more than `most` sources. Throws
/// std::runtime_error where the formula has no size.
std::vector<SizeSource> sources_of_formula(const RootCube& root, const FormulaSize& formula,
                                           const FormulaSpace& space, int rank, int ranks,
                                           std::int64_t most = std::numeric_limits<std::int64_t>::max());

}  // namespace aeroloom::sizing
