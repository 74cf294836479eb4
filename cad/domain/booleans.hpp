/// Boolean operations that throw when they fail and keep the names of faces. Internal to cad/.
#pragma once

#include "cad/model/model.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <optional>
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

/// Runs an operation whose arguments are set. `doing` names the operation in messages. Throws CadError when
/// the CAD library reports failure.
void perform(BRepAlgoAPI_BuilderAlgo& operation, const char* doing);

/// Copies the labels of the arguments' faces to the faces that the operation made from them.
void follow_labels(BRepBuilderAPI_MakeShape& operation, const std::vector<TopoDS_Solid>& arguments,
                   FaceLabels& labels);

/// The sum of the volumes.
double volume_of(const std::vector<TopoDS_Solid>& solids, Volumes& volumes);

/// The middle of the intersection of two boxes.
Vec3 meeting_place(const Box& a, const Box& b);

/// The volume of the intersection of two shapes. `tolerance` is that of the boolean operation; 0 takes the
/// default of the CAD library.
double common_volume(const TopoDS_Shape& first, const TopoDS_Shape& second, double tolerance,
                     Volumes& volumes);

/// Unites a solid with others that may touch or overlap it. Labels follow.
/// A union is valid if its volume is the sum of all volumes less that of the intersection. Several ways are
/// tried until one gives a valid union: the bodies as they are; in the other order; one by one; with a larger
/// tolerance; as shapes that share whole faces. From the second way on, the result must also pass the checks
/// of the CAD library, and it is listed as a change. Throws CadError that names both bodies and a place.
std::vector<TopoDS_Solid> unite_with(const std::vector<TopoDS_Solid>& united, const TopoDS_Solid& solid,
                                     Volumes& volumes, FaceLabels& labels, Changes& changes);

/// Unites solids at once, which takes far less time than one after the other. Nothing where the CAD library
/// fails, or where the volume is not the sum of theirs, as where some overlap; labels stay as they are then.
std::optional<std::vector<TopoDS_Solid>> unite_at_once(const std::vector<TopoDS_Solid>& solids,
                                                       Volumes& volumes, FaceLabels& labels);

}  // namespace aeroloom::cad
