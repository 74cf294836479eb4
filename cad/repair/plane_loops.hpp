/// Closed loops of edges in planes, and planar faces between them. Seen by this folder only.
#pragma once

#include "geometry/vec.hpp"

#include <optional>
#include <vector>

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {

/// A simple closed loop of edges near a plane.
struct PlaneLoop {
  TopoDS_Wire wire;
  gp_Pln plane;
  double area = 0;            ///< enclosed, without regard to loops inside
  double deviation = 0;       ///< largest distance of the edges from the plane
  int depth = 0;              ///< how many loops of the same plane enclose it
  std::vector<int> children;  ///< the loops directly inside it
};

/// Chains edges that share vertices to loops, and nests those of one plane. The plane is fitted to each loop
/// unless one is given. Nothing where edges do not form simple closed loops, or leave their plane by more
/// than `tolerance`.
std::optional<std::vector<PlaneLoop>> find_plane_loops(const std::vector<TopoDS_Edge>& edges,
                                                       double tolerance,
                                                       const std::optional<gp_Pln>& plane = std::nullopt);

/// The face on the inner side of the first wire and outside the others, whatever the wires' orientation. It
/// looks along the plane's normal.
TopoDS_Face make_plane_face(const gp_Pln& plane, const TopoDS_Wire& outer,
                            const std::vector<TopoDS_Wire>& holes);

/// The face of a loop with its children as holes.
TopoDS_Face make_plane_face(const std::vector<PlaneLoop>& loops, std::size_t index);

struct Cap {
  TopoDS_Face face;
  geometry::Vec3 center;
  double area = 0;
  double deviation = 0;  ///< largest distance of the opening's edges from the plane
};

/// Faces that close the openings bounded by `open` edges: one per opening, with holes where one opening's
/// edges run inside another's in the same plane. Nothing where an opening is no simple closed loop or leaves
/// its plane by more than `tolerance`.
std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance);

}  // namespace aeroloom::cad
