/// Volumes of solids, each face integrated once. Seen by this folder only.
#pragma once

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::cad {

/// Volumes by the divergence theorem. Integrals over spline faces are what reading costs most, and the same
/// faces come back in shells, solids and unions: they are kept.
class Volumes {
public:
  /// Of a shape bounded by closed shells; negative when they are turned inside out. Each
  /// face counts to four digits or more (face_integrals.hpp).
  double of(const TopoDS_Shape& shape);

private:
  gp_Pnt _reference;  // near the shapes: far from them large numbers would cancel
  NCollection_DataMap<TopoDS_Shape, double, TopTools_ShapeMapHasher> _fluxes;  // of faces oriented forward
};

}  // namespace aeroloom::cad
