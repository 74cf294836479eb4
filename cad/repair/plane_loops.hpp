/// Closed loops of edges in a plane, planar faces between them, and caps over planar openings. Internal to
/// cad/.
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
  double area = 0;            ///< enclosed area, inner loops included
  double deviation = 0;       ///< largest distance of the edges from the plane
  int depth = 0;              ///< number of loops of the same plane that enclose it
  std::vector<int> children;  ///< loops directly inside it
};

/// Chains edges that share vertices to loops, and nests loops of one plane. Without a given plane one is
/// fitted to each loop. Empty if the edges do not form simple closed loops, or leave their plane by more than
/// `tolerance`.
std::optional<std::vector<PlaneLoop>> find_plane_loops(const std::vector<TopoDS_Edge>& edges,
                                                       double tolerance,
                                                       const std::optional<gp_Pln>& plane = std::nullopt);

/// The face inside the first wire and outside the others, whatever their orientation. Its normal is that of
/// the plane.
TopoDS_Face make_plane_face(const gp_Pln& plane, const TopoDS_Wire& outer,
                            const std::vector<TopoDS_Wire>& holes);

/// The face of a loop, with its children as holes.
TopoDS_Face make_plane_face(const std::vector<PlaneLoop>& loops, std::size_t index);

struct Cap {
  TopoDS_Face face;
  geometry::Vec3 center;
  double area = 0;
  double deviation = 0;    ///< largest distance of the opening's edges from the plane, or the surface
  bool is_filled = false;  ///< it is no plane (filled_loops.hpp)
};

/// Edges that share vertices as simple closed loops, in order and oriented along them. Empty if they form
/// none.
std::optional<std::vector<std::vector<TopoDS_Edge>>> find_loops(const std::vector<TopoDS_Edge>& edges);

/// Planar faces that close the openings bounded by `open` edges, one per opening. Openings inside others of
/// the same plane become holes. Empty if an opening is no simple closed loop or leaves its plane by more than
/// `tolerance`.
std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance);

}  // namespace aeroloom::cad
