/// Converts points and vectors from and to OpenCASCADE.
#pragma once

#include "geometry/vec.hpp"

#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

namespace aeroloom::cad {

inline geometry::Vec3 to_vec(const gp_XYZ& p) {
  return {p.X(), p.Y(), p.Z()};
}
inline geometry::Vec3 to_vec(const gp_Pnt& p) {
  return to_vec(p.XYZ());
}
inline geometry::Vec3 to_vec(const gp_Vec& p) {
  return to_vec(p.XYZ());
}
inline gp_Pnt to_gp(geometry::Vec3 p) {
  return {p.x, p.y, p.z};
}

}  // namespace aeroloom::cad
