/// Bodies whose walls are close to each other.
#pragma once

#include "cad/domain/domain.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepTools.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <unistd.h>

namespace aeroloom::shapes {

/// A shape as the fluid, or as a body in a far field.
inline cad::Model domain_of(const TopoDS_Shape& shape, cad::DomainKind kind = cad::DomainKind::fluid) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("aeroloom_shape_" + std::to_string(::getpid()) + ".brep"))
          .string();
  BRepTools::Write(shape, file.c_str());
  cad::DomainOptions options;
  options.file = file;
  options.kind = kind;
  cad::Model model = cad::prepare_domain(options).model;
  std::filesystem::remove(file);
  return model;
}

/// A profile pulled up by one, as the fluid or a body.
inline cad::Model prism(const std::vector<std::pair<double, double>>& profile,
                        cad::DomainKind kind = cad::DomainKind::fluid) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, y] : profile) polygon.Add(gp_Pnt(x, y, 0));
  polygon.Close();
  return domain_of(BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()), gp_Vec(0, 0, 1)).Shape(),
                   kind);
}

/// A block, 4 long, with a cut from one end that is so wide there and closes in an edge.
inline cad::Model cracked_block(double apart) {
  return prism({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {4, 1 + apart}, {4, 2}, {0, 2}});
}

/// One with a cut of the same width all along.
inline cad::Model slotted_block(double apart) {
  return prism({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 1 + apart}, {4, 1 + apart}, {4, 2}, {0, 2}});
}

}  // namespace aeroloom::shapes
