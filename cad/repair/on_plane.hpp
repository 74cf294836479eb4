/// Puts edges near a plane on it. Internal to cad/.
#pragma once

#include "geometry/vec.hpp"

#include <vector>

#include <Geom_Curve.hxx>
#include <Standard_Handle.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::cad {

using geometry::Vec3;

/// A plane normal to a coordinate axis.
struct AxisPlane {
  int axis = 1;
  double position = 0;

  double height(const gp_Pnt& point) const { return point.Coord(axis + 1) - position; }
  gp_Pnt foot(gp_Pnt point) const {
    point.SetCoord(axis + 1, position);
    return point;
  }
};

/// The largest distance of an edge from the plane, by samples.
double distance_from(const AxisPlane& plane, const TopoDS_Edge& edge);

/// How far edges were moved.
struct PutOnPlane {
  int edges = 0;
  double most = 0;  ///< largest distance moved
  Vec3 where;       ///< of that distance
};

/// A curve of the edge in the plane below it, at the same parameters. Null if the edge has no curve.
opencascade::handle<Geom_Curve> curve_on_plane(const TopoDS_Edge& edge, const AxisPlane& plane, double& first,
                                               double& last);

/// Moves edges and their vertices to the plane, along its normal. They change in place, so faces keep them
/// and their labels; surfaces and parameter curves stay.
PutOnPlane put_on_plane(const std::vector<TopoDS_Edge>& edges, const AxisPlane& plane);

}  // namespace aeroloom::cad
