/// Maps of the faces, edges or other sub-shapes of a shape. Internal to cad/.
#pragma once

#include <vector>

#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// All sub-shapes of one kind, each once, numbered from 1 in the order of TopExp.
inline TopTools_IndexedMapOfShape map_of(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, kind, map);
  return map;
}

/// What a map holds, in its order.
inline std::vector<TopoDS_Shape> shapes_in(const TopTools_IndexedMapOfShape& map) {
  return {map.cbegin(), map.cend()};
}

/// False for edges inside a face and faces inside a solid.
inline bool bounds_material(const TopoDS_Shape& part) {
  return part.Orientation() == TopAbs_FORWARD || part.Orientation() == TopAbs_REVERSED;
}

/// The faces inside of solids, which bound none.
inline TopTools_IndexedMapOfShape faces_inside_solids(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape inside;
  for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) {
    for (TopExp_Explorer faces(solids.Current(), TopAbs_FACE); faces.More(); faces.Next()) {
      if (!bounds_material(faces.Current())) inside.Add(faces.Current().Oriented(TopAbs_FORWARD));
    }
  }
  return inside;
}

}  // namespace aeroloom::cad
