/// What stays open when faces are sewn, and the message about it. Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>
#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Shell.hxx>

namespace aeroloom::cad {

/// Faces after one attempt to sew them.
struct Sewn {
  std::vector<TopoDS_Shell> closed;
  TopoDS_Shape shape;
  FaceLabels labels;
  double tolerance = 0, fraction = 0;
  bool complete = false;  ///< no face outside closed shells
};

/// What is known beside the faces that stay open.
struct OpenReasons {
  bool beside_bodies = false;
  std::string half = {};  ///< why the plane of symmetry does not close them
};

/// Edges of one face only, without seams and poles, in order.
std::vector<TopoDS_Edge> open_edges(const TopoDS_Shape& shape);

/// Throws CadError that lists the open edges after the last attempt, with a remedy. Faces beside closed
/// bodies are likely to be strays, which may be left out. An opening in one coordinate plane is likely to be
/// a plane of symmetry.
[[noreturn]] void refuse_open(const TopTools_IndexedMapOfShape& faces, const Sewn& last,
                              const FaceLabels& labels, const OpenReasons& reasons);

}  // namespace aeroloom::cad
