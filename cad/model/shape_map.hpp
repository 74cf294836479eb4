/// Maps of the faces, edges or other sub-shapes of a shape. Internal to cad/.
#pragma once

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>

namespace aeroloom::cad {

/// All sub-shapes of one kind, each once, numbered from 1 in the order of TopExp.
inline TopTools_IndexedMapOfShape map_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map;
}

/// False for edges inside a face and faces inside a solid.
inline bool bounds_material(const TopoDS_Shape& part) {
  return part.Orientation() == TopAbs_FORWARD || part.Orientation() == TopAbs_REVERSED;
}

}  // namespace aeroloom::cad
