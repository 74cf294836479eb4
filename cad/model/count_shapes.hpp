/// How many parts of a kind a shape has. Seen by this folder only.
#pragma once

#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>

namespace aeroloom::cad {

/// Each part counts once, however often it is used.
inline int count(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map.Extent();
}

}  // namespace aeroloom::cad
