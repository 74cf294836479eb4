/// Parameter curves (curves in the parameters of a face) for edges that replace other edges. Internal to
/// cad/repair/.
#pragma once

#include "cad/repair/sampled_edge.hpp"

#include <Geom2d_Curve.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// An interval of an edge.
struct EdgeInterval {
  TopoDS_Edge edge;
  double first = 0, last = 1;  ///< ascending parameters
};

/// The parameter curve of `edge` on a face that `other` bounds; the two edges run side by side. `image` is
/// the parameter curve of `other`. Each point of `edge` gets the parameters of the nearest point of `other`.
/// `against` is true if the edges run in opposite directions.
Handle(Geom2d_Curve) image_beside(const EdgeInterval& edge, const EdgeInterval& other,
                                  const Handle(Geom2d_Curve) & image, bool against, double tolerance);

/// Gives the edge a parameter curve on a face, for its forward or reversed coedge. If the face has the edge
/// already, the edge becomes a seam.
void add_image(const TopoDS_Edge& edge, const Handle(Geom2d_Curve) & image, const TopoDS_Face& face,
               bool forward, double tolerance);

}  // namespace aeroloom::cad
