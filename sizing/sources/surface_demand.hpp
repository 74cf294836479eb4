/// Triangles that ask for sizes around them: walls, wakes, and CAD edges as triangles without area.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/box_tree.hpp"
#include "sizing/features/triangle_tree.hpp"
#include "sizing/sources/cells_where.hpp"
#include "sizing/sources/size_demands.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::sizing {

struct SizedTriangle {
  Triangle corners;
  std::array<double, 3> sizes;  ///< at its corners
};

/// Where a triangle comes nearest to a point.
struct NearestOfTriangle {
  double away;
  std::array<double, 3> weights;  ///< of its corners
};
NearestOfTriangle nearest_of(const Triangle& t, geometry::Vec3 p);

/// Asks for the sizes of triangles on them and up to a distance.
class SurfaceDemand {
public:
  /// `key`: what of the case asks for it, in messages.
  SurfaceDemand(std::string key, std::vector<SizedTriangle> triangles, double reach);

  const std::string& key() const { return _key; }
  bool empty() const { return _triangles.empty(); }
  /// With all sizes so many times as large.
  CubeDemand ask(geometry::Vec3 middle, double half_edge, double coarser) const;

  /// How many cells ask, about.
  double cells(const RootCube& root, double coarser) const;

private:
  std::string _key;
  std::vector<SizedTriangle> _triangles;  // in the order of the tree
  double _reach;
  double _smallest = no_size;
  double _slope = 0;  // of sizes on a triangle, at most
  geometry::BoxTree _tree;
};

/// Whether each face, or its patch, is like one of the patterns.
std::vector<bool> faces_like(const cad::Model& model, const std::vector<std::string>& patterns);

/// Throws std::invalid_argument where no face and no patch is like a pattern. `key`: of the case.
void require_like(const cad::Model& model, const std::string& key, const std::vector<std::string>& patterns);

/// Parts of the edges where the body ends in the given direction, of these faces: convex, of a body that lies
/// ahead of them, swept by 60 degrees at most. Both borders of a blunt trailing edge, whether its strip is
/// among the faces or the faces beside it are.
std::vector<std::array<geometry::Vec3, 2>> trailing_segments(const cad::Model& model,
                                                             const std::vector<bool>& faces,
                                                             geometry::Vec3 direction);

/// A sheet behind such segments.
std::vector<SizedTriangle> wake_sheet(const std::vector<std::array<geometry::Vec3, 2>>& segments,
                                      const WakeSize& wake);

/// The edges that a demand selects, as far as they lie in its box.
std::vector<SizedTriangle> edges_asked_for(const cad::Model& model, const EdgeSize& asked);

}  // namespace aeroloom::sizing
