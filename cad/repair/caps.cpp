#include "cad/repair/caps.hpp"

#include "cad/repair/plane_loops.hpp"

#include <cmath>
#include <cstddef>

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>

namespace aeroloom::cad {

std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance) {
  const auto loops = find_plane_loops(open, tolerance);
  if (!loops) return {};
  std::vector<Cap> caps;
  for (std::size_t i = 0; i < loops->size(); ++i) {
    if ((*loops)[i].depth % 2 != 0) continue;
    Cap& cap = caps.emplace_back();
    cap.face = make_plane_face(*loops, i);
    cap.deviation = (*loops)[i].deviation;
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(cap.face, properties);
    const gp_Pnt center = properties.CentreOfMass();
    cap.center = {center.X(), center.Y(), center.Z()};
    cap.area = std::abs(properties.Mass());
  }
  return caps;
}

}  // namespace aeroloom::cad
