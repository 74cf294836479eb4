/// Planar faces over planar openings. Seen by this folder only.
#pragma once

#include "cad/repair/change.hpp"

#include <vector>

#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace aeroloom::cad {

struct Cap {
  TopoDS_Face face;
  Vec3 center;
  double area = 0;
  double deviation = 0;  ///< largest distance of the opening's edges from the plane
};

/// Faces that close the openings bounded by `open` edges: one per opening, with holes where one opening's
/// edges run inside another's in the same plane. Nothing where an opening is no simple closed loop or leaves
/// its plane by more than `tolerance`.
std::vector<Cap> cap_openings(const std::vector<TopoDS_Edge>& open, double tolerance);

}  // namespace aeroloom::cad
