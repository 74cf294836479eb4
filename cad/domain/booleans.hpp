/// Boolean operations that fail loudly and keep names; unions by whichever way of the CAD library gives a
/// sound one. Seen by this folder only.
#pragma once

#include "cad/model/model.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

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

/// The sum of their volumes.
double volume_of(const std::vector<TopoDS_Solid>& solids, Volumes& volumes);

/// The middle of what two boxes share.
Vec3 meeting_place(const Box& a, const Box& b);

/// The volume that two shapes have in common, as the CAD library finds it with this tolerance (0: its own).
double common_volume(const TopoDS_Shape& first, const TopoDS_Shape& second, double tolerance,
                     Volumes& volumes);

/// Unites a solid with others that may touch or overlap it; labels follow. A union is sound when its volume
/// is that of the parts, less what they share. Tried in turn until one is: as they are, the other way round,
/// one by one, with points up to some tolerances taken as one, and as shapes that share whole faces. What
/// comes of other ways than the first has to be valid to the CAD library too, and is listed as a change.
/// Throws CadError naming both bodies and a place.
std::vector<TopoDS_Solid> unite_with(const std::vector<TopoDS_Solid>& united, const TopoDS_Solid& solid,
                                     Volumes& volumes, FaceLabels& labels, Changes& changes);

}  // namespace aeroloom::cad
