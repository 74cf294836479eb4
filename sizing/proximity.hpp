/// Distances to opposite walls: how thin a body or a gap is.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/triangle_tree.hpp"

#include <span>
#include <vector>

namespace aeroloom::sizing {

/// A point of a face with the distance to the wall opposite to it, on either side.
struct Gap {
  geometry::Vec3 point;
  double width;
};

/// The facets of all faces as walls; `faces` tells each triangle's face.
struct Walls {
  TriangleTree tree;
  std::vector<geometry::Vec3> normals;  ///< unit; zero where a triangle has none
  std::vector<cad::FaceId> faces;

  Walls(const std::vector<Triangle>& triangles_of_walls, std::vector<cad::FaceId> faces_of_walls);
};

/// Gaps seen from one face, given by its facets: rays along its facets' normals, to both sides, to the
/// nearest wall that faces back. Facets are bisected until their edges are no longer than four times the gap
/// or `finest`. Gaps wider than `widest` are left out, and so are wedges, where the opposite wall meets the
/// face in an edge nearer than eight times the gap: sizes would fall to nothing there. A function of the
/// model and the arguments alone.
std::vector<Gap> find_gaps(const cad::Model& model, const cad::Facets& facets, const Walls& walls,
                           double widest, double finest, double layers);

}  // namespace aeroloom::sizing
