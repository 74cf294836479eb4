/// Parameter curves for edges that take the place of others. Seen by this folder only.
#pragma once

#include "cad/repair/sampled_edge.hpp"

#include <Geom2d_Curve.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

/// A stretch of an edge.
struct EdgeInterval {
  TopoDS_Edge edge;
  double first = 0, last = 1;  ///< ascending
};

/// The image of `edge`, in its parameter, on a face that `other` bounds, which runs beside it: where the
/// nearest places of the other are. `image` is the other's, in its parameter. `against`: the other runs
/// against it.
Handle(Geom2d_Curve) image_beside(const EdgeInterval& edge, const EdgeInterval& other,
                                  const Handle(Geom2d_Curve) & image, bool against, double tolerance);

/// Gives the edge an image on a face, for its coedge forward or reversed; where the face sees it already it
/// becomes a seam.
void add_image(const TopoDS_Edge& edge, const Handle(Geom2d_Curve) & image, const TopoDS_Face& face,
               bool forward, double tolerance);

}  // namespace aeroloom::cad
