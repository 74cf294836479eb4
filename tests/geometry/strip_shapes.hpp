/// Solids with a narrow strip on their side, for tests of narrow faces.
#pragma once

#include "tests/geometry/cad_shapes.hpp"

#include <cmath>
#include <numbers>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>

namespace aeroloom::geometry::shapes {

/// A cylinder of radius 1 about z, its side in two faces: one of them `degrees` wide.
inline Model split_cylinder(double degrees, double height) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  const double cut = degrees * std::numbers::pi / 180;
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle, 0, cut).Edge(),
                               BRepBuilderAPI_MakeEdge(circle, cut, 2 * std::numbers::pi).Edge());
  return prepare_fluid(
             BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, height)).Shape())
      .model;
}

/// A wedge along y whose thin end, at x = 1, is cut off: a blunt trailing edge of that height.
inline Model blunt_wedge(double thickness) {
  BRepBuilderAPI_MakePolygon polygon;
  polygon.Add(gp_Pnt(0, 0, -0.2));
  polygon.Add(gp_Pnt(1, 0, -0.5 * thickness));
  polygon.Add(gp_Pnt(1, 0, 0.5 * thickness));
  polygon.Add(gp_Pnt(0, 0, 0.2));
  polygon.Close();
  return prepare_fluid(
             BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0, 1, 0)).Shape())
      .model;
}

}  // namespace aeroloom::geometry::shapes
