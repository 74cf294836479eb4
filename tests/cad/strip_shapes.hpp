/// Solids with a narrow strip on their side, for tests of narrow faces.
#pragma once

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax2.hxx>
#include <gp_Ax3.hxx>
#include <gp_Circ.hxx>
#include <gp_Cylinder.hxx>

namespace aeroloom::cad::shapes {

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

/// A cylinder of radius 1 about z, its side in three faces: one of them `degrees` wide, between the others.
/// Each is a spline that ends where its face does.
inline Model spline_cylinder(double degrees, double height) {
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  const double cut = degrees * std::numbers::pi / 180;
  BRepBuilderAPI_MakeWire wire(
      BRepBuilderAPI_MakeEdge(circle, 0, cut).Edge(),
      BRepBuilderAPI_MakeEdge(circle, cut, std::numbers::pi).Edge(),
      BRepBuilderAPI_MakeEdge(circle, std::numbers::pi, 2 * std::numbers::pi).Edge());
  BRepPrimAPI_MakePrism prism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, height));
  return prepare_fluid(BRepBuilderAPI_NurbsConvert(prism.Shape()).Shape()).model;
}

/// Half a disc of radius 1 and that height, its round side between one arc below and two above.
inline Model half_coin(double height) {
  const auto circle = [](double z) { return gp_Circ(gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), 1); };
  const auto edge = [](const gp_Pnt& a, const gp_Pnt& b) { return BRepBuilderAPI_MakeEdge(a, b).Edge(); };
  constexpr double half = std::numbers::pi, middle = 1.1;
  const gp_Pnt low_a(1, 0, 0), low_b(-1, 0, 0), high_a(1, 0, height), high_b(-1, 0, height);
  const TopoDS_Edge below = BRepBuilderAPI_MakeEdge(circle(0), 0, half).Edge();
  const TopoDS_Edge above[2] = {BRepBuilderAPI_MakeEdge(circle(height), 0, middle).Edge(),
                                BRepBuilderAPI_MakeEdge(circle(height), middle, half).Edge()};
  BRepBuilderAPI_MakeWire side(below, edge(low_b, high_b));
  side.Add(above[1]);
  side.Add(above[0]);
  side.Add(edge(high_a, low_a));
  BRepBuilderAPI_MakeWire top(above[0], above[1]);
  top.Add(edge(high_b, high_a));
  const BRepBuilderAPI_MakeWire bottom(below, edge(low_b, low_a));
  BRepBuilderAPI_MakePolygon back(low_a, low_b, high_b, high_a, Standard_True);
  const gp_Cylinder cylinder(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  return prepare_fluid(
             compound_of<TopoDS_Face>({BRepBuilderAPI_MakeFace(cylinder, side.Wire()).Face(),
                                       BRepBuilderAPI_MakeFace(top.Wire()).Face(),
                                       BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(bottom).Wire()).Face(),
                                       BRepBuilderAPI_MakeFace(back.Wire()).Face()}))
      .model;
}

/// A wedge along y whose thin end, at x = 1, is cut off: a blunt trailing edge of that height.
inline Model blunt_wedge(double thickness) {
  return prepare_fluid(prism({{0, -0.2}, {1, -0.5 * thickness}, {1, 0.5 * thickness}, {0, 0.2}}, 1)).model;
}

/// A wedge along y of unit length whose blunt end, at x = 1, is as thick at y = 0 and y = 1 as these say.
inline Model tapered_wedge(double root, double tip) {
  BRepOffsetAPI_ThruSections loft(Standard_True, Standard_True);
  for (const auto& [y, thickness] : {std::pair(0.0, root), std::pair(1.0, tip)}) {
    BRepBuilderAPI_MakePolygon section;
    section.Add(gp_Pnt(0, y, -0.2));
    section.Add(gp_Pnt(1, y, -0.5 * thickness));
    section.Add(gp_Pnt(1, y, 0.5 * thickness));
    section.Add(gp_Pnt(0, y, 0.2));
    section.Close();
    loft.AddWire(section.Wire());
  }
  return prepare_fluid(loft.Shape()).model;
}

/// A prism along y with a side that bends by so many degrees before its end: what is behind the bend is a
/// strip 0.05 wide. No other edge of it is smooth.
inline Model creased_prism(double degrees) {
  const double slope = std::atan(0.3) + degrees * std::numbers::pi / 180, width = 0.05;
  return prepare_fluid(
             prism({{0, 0}, {1, 0.3}, {1 + width * std::cos(slope), 0.3 + width * std::sin(slope)}, {0.1, 2}},
                   1))
      .model;
}

}  // namespace aeroloom::cad::shapes
