/// Prisms over polygons, as shapes of the CAD library.
#pragma once

#include <utility>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

namespace aeroloom::cad::shapes {

/// A profile in the plane y = 0, given by x and z, drawn out along y.
inline TopoDS_Shape prism(const std::vector<std::pair<double, double>>& profile, double length) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, z] : profile) polygon.Add(gp_Pnt(x, 0, z));
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, length, 0)).Shape();
}

}  // namespace aeroloom::cad::shapes
