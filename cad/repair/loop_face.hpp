/// Faces of a surface and a loop of edges that lie on it. Internal to cad/.
#pragma once

#include <vector>

#include <Geom_Surface.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>

namespace aeroloom::cad {

/// The part of a surface within a wire. Its edges need parameter curves besides.
TopoDS_Face face_within(const opencascade::handle<Geom_Surface>& surface, const TopoDS_Wire& wire);

/// About the area that a loop encloses in the parameters of a face, for its sign: positive where the loop
/// runs counter-clockwise. 0 where an edge has no parameter curve there.
double area_in_parameters(const std::vector<TopoDS_Edge>& loop, const TopoDS_Face& face);

}  // namespace aeroloom::cad
