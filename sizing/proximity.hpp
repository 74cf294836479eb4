/// Distances to opposite walls: how thin a body or a gap is.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/triangle_tree.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// Rays on a facet that is bisected down to an edge, times the square of that edge, over its area.
inline constexpr double rays_per_area = 24;

/// A point of a face with the distance to the wall opposite to it.
struct Gap {
  geometry::Vec3 point;
  double width;
};

/// What rays from one face have met.
struct Gaps {
  std::vector<Gap> seen;  ///< on either side of the face, the narrower one
  /// On a side that is meshed, and where the walls do not run together towards a common edge: elements as
  /// small as the gap resolve it. A wedge looks the same to elements of any size. Gaps that may well be due
  /// to the facets, which are less than twice their distance from the surface apart, are left out.
  std::vector<Gap> open;
  /// A part of a facet that is longer than rays should be apart in the open gap there.
  struct Part {
    Triangle triangle;
    double gap, deviation;  ///< of the facet
  };
  std::vector<Part> narrow;
};

/// The distance of each facet's middle from the face's surface: nothing of a plane, at most a quarter of its
/// longest edge.
std::vector<double> facet_deviations(const cad::Model& model, cad::FaceId face, const cad::Facets& facets);

/// A facet as a wall.
struct Wall {
  cad::FaceId face;
  Triangle corners;
  double deviation;  ///< its distance from the surface

  static constexpr auto fields() { return std::tuple(&Wall::face, &Wall::corners, &Wall::deviation); }
};

/// The facets of all faces.
struct Walls {
  TriangleTree tree;
  std::vector<geometry::Vec3> normals;  ///< unit; zero where a triangle has none
  std::vector<Wall> facets;

  explicit Walls(std::vector<Wall> walls);
};

/// Gaps seen from one face, given by its facets: rays along its facets' normals, to both sides, to the
/// nearest wall that faces back. Facets are bisected until their edges are no longer than four times the gap
/// or `finest`. Gaps wider than `widest` are left out, and so are wedges, where the opposite wall meets the
/// face in an edge nearer than eight times the gap: sizes would fall to nothing there. A function of the
/// model and the arguments alone.
Gaps find_gaps(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, const Walls& walls,
               double widest, double finest, double layers);

/// About as many rays as it takes to look at the narrow parts of a face as closely as its open gaps are
/// narrow.
std::int64_t count_rays(const Gaps& gaps, double layers);

/// Does so, with rays `apart` times as far from each other, and moves on from there: adds to the open gaps.
/// A function of the model and the arguments alone.
void look_closer(const cad::Model& model, cad::FaceId face, const cad::Facets& facets, const Walls& walls,
                 double widest, double layers, double apart, Gaps& gaps);

}  // namespace aeroloom::sizing
