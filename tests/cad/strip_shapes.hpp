/// Solids with a narrow strip on their side, for tests of narrow faces.
#pragma once

#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include <BRepAlgoAPI_Splitter.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>

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
  constexpr double middle = 1.1;
  const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 1);
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(circle, 0, std::numbers::pi).Edge(),
                               BRepBuilderAPI_MakeEdge(gp_Pnt(-1, 0, 0), gp_Pnt(1, 0, 0)).Edge());
  const TopoDS_Face bottom = BRepBuilderAPI_MakeFace(wire.Wire()).Face();
  TopTools_ListOfShape coin, cut;
  coin.Append(BRepPrimAPI_MakePrism(bottom, gp_Vec(0, 0, height)).Shape());
  const gp_Pnt beyond(2 * std::cos(middle), 2 * std::sin(middle), height);
  cut.Append(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, height), beyond).Edge());
  cut.Append(BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, height), gp_Pnt(0, -1, height)).Edge());
  BRepAlgoAPI_Splitter splitter;
  splitter.SetArguments(coin);
  splitter.SetTools(cut);
  splitter.Build();
  return prepare_fluid(splitter.Shape()).model;
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
