/// Bodies with blunt trailing edges, for tests that close them.
#pragma once

#include "tests/cad/cad_shapes.hpp"

#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>

namespace aeroloom::cad::shapes {

inline TopoDS_Face polygon(const std::vector<Vec3>& corners) {
  BRepBuilderAPI_MakePolygon loop;
  for (const Vec3 p : corners) loop.Add(gp_Pnt(p.x, p.y, p.z));
  loop.Close();
  return BRepBuilderAPI_MakeFace(loop.Wire(), true).Face();
}

/// A section of a wing along y: a triangle with its blunt end behind.
struct WingSection {
  double y, nose, thickness;  ///< thickness of the end, a unit behind the nose; 0: sharp
};

/// A wing with planar faces between sections, four corners each: upper, lower and strip are one face
/// between two sections of the same thickness, else triangles.
inline TopoDS_Shape blunt_wing(const std::vector<WingSection>& sections) {
  const auto corner = [](const WingSection& s, double z) { return Vec3{s.nose + 1, s.y, z * s.thickness}; };
  const auto nose = [](const WingSection& s) { return Vec3{s.nose, s.y, 0}; };
  // Noses lie lower than the ends' middle by nothing: give the body height with a keel and a ridge.
  const auto mid = [](const WingSection& s, double z) { return Vec3{s.nose + 0.4, s.y, 0.15 * z}; };
  std::vector<TopoDS_Face> faces;
  const auto cap = [&](const WingSection& s) {
    std::vector<Vec3> loop{nose(s), mid(s, -1), corner(s, -0.5)};
    if (s.thickness > 0) loop.push_back(corner(s, 0.5));
    loop.push_back(mid(s, 1));
    faces.push_back(polygon(loop));
  };
  cap(sections.front());
  for (std::size_t i = 1; i < sections.size(); ++i) {
    const WingSection &a = sections[i - 1], &b = sections[i];
    for (const double side : {-1.0, 1.0}) {
      faces.push_back(polygon({nose(a), nose(b), mid(b, side), mid(a, side)}));
      if (a.thickness == b.thickness) {
        faces.push_back(polygon({mid(a, side), mid(b, side), corner(b, 0.5 * side), corner(a, 0.5 * side)}));
      } else {
        faces.push_back(polygon({mid(a, side), mid(b, side), corner(b, 0.5 * side)}));
        faces.push_back(polygon({mid(a, side), corner(b, 0.5 * side), corner(a, 0.5 * side)}));
      }
    }
    std::vector<Vec3> strip{corner(a, -0.5), corner(b, -0.5)};
    if (b.thickness > 0) strip.push_back(corner(b, 0.5));
    strip.push_back(corner(a, 0.5));
    faces.push_back(polygon(strip));
  }
  cap(sections.back());
  return compound_of(faces);
}

inline DomainOptions sharpened(std::vector<std::string> faces = {}, double width = 0) {
  DomainOptions options;
  options.kind = DomainKind::body;
  options.trailing_edges = {TrailingEdges::sharpen, std::move(faces), width};
  return options;
}

}  // namespace aeroloom::cad::shapes
