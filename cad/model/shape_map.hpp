/// The faces, edges or other parts of a shape. Seen by cad/ only.
#pragma once

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>

namespace aeroloom::cad {

/// All parts of one kind, numbered from 1 in the order of TopExp. Each part is there once, however often the
/// shape uses it.
inline TopTools_IndexedMapOfShape map_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map;
}

/// False for edges and faces that lie inside a face or a solid.
inline bool bounds_material(const TopoDS_Shape& part) {
  return part.Orientation() == TopAbs_FORWARD || part.Orientation() == TopAbs_REVERSED;
}

}  // namespace aeroloom::cad
