/// Boolean operations that fail loudly and keep names. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"

#include <vector>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Solid.hxx>

namespace aeroloom::cad {

template <class Shape>
TopTools_ListOfShape list_of(const std::vector<Shape>& shapes) {
  TopTools_ListOfShape list;
  for (const Shape& shape : shapes) list.Append(shape);
  return list;
}

/// Builds an operation whose arguments are set. Throws CadError when the CAD library reports failure; `doing`
/// says what was tried.
void perform(BRepAlgoAPI_BuilderAlgo& operation, const char* doing);

/// Gives faces that an operation made of the arguments' faces the labels of those.
void follow_labels(BRepBuilderAPI_MakeShape& operation, const std::vector<TopoDS_Solid>& arguments,
                   FaceLabels& labels);

}  // namespace aeroloom::cad
