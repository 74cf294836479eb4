/// Triangles that ask for sizes around them: walls, wakes, and CAD edges as triangles without area.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/box_tree.hpp"
#include "sizing/features/triangle_tree.hpp"
#include "sizing/sources/cells_where.hpp"
#include "sizing/sources/size_requests.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::sizing {

struct SizedTriangle {
  Triangle corners;
  std::array<double, 3> sizes;  ///< at its corners
};

/// The point of a triangle that is nearest to some point.
struct NearestOfTriangle {
  double away;
  std::array<double, 3> weights;  ///< of its corners
};
NearestOfTriangle nearest_of(const Triangle& t, geometry::Vec3 p);

/// Triangles with sizes at their corners. They ask for these on themselves and up to a distance.
class SurfaceRequest {
public:
  /// `key`: the key of the case, for messages.
  SurfaceRequest(std::string key, std::vector<SizedTriangle> triangles, double reach);

  const std::string& key() const { return _key; }
  bool empty() const { return _triangles.empty(); }
  /// The size asked for in a cube, with all sizes `coarsening` times as large.
  CubeRequest request_in(geometry::Vec3 middle, double half_edge, double coarsening) const;

  /// About the number of cells in which a size is asked for.
  double cells(const RootCube& root, double coarsening) const;

private:
  std::string _key;
  std::vector<SizedTriangle> _triangles;  // in the order of the tree
  double _reach;
  double _smallest = no_size;
  double _slope = 0;  // of sizes on a triangle, at most
  geometry::BoxTree _tree;
};

/// Whether the name of each face, or of its patch, matches one of the patterns.
std::vector<bool> faces_like(const cad::Model& model, const std::vector<std::string>& patterns);

/// Throws std::invalid_argument if no face and no patch matches a pattern. `key`: of the case.
void require_like(const cad::Model& model, const std::string& key, const std::vector<std::string>& patterns);

/// The edges of these faces in which the body ends in the given direction. There the body is convex and lies
/// ahead of the edge, which is swept by at most 60 degrees. A blunt trailing edge gives both sides of its
/// narrow face, if that face or the faces beside it are among `faces`.
std::vector<std::array<geometry::Vec3, 2>> trailing_segments(const cad::Model& model,
                                                             const std::vector<bool>& faces,
                                                             geometry::Vec3 direction);

/// The sheet of a wake behind such segments.
std::vector<SizedTriangle> wake_sheet(const std::vector<std::array<geometry::Vec3, 2>>& segments,
                                      const WakeSize& wake);

/// The edges that a request selects, whole ones, whatever its box.
std::vector<cad::EdgeId> edges_like(const cad::Model& model, const EdgeSize& asked);
/// Those as far as they lie in its box, and their ends.
std::vector<SizedTriangle> edges_asked_for(const cad::Model& model, const EdgeSize& asked);

}  // namespace aeroloom::sizing
