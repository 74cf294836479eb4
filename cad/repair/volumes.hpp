/// Volumes of solids. Each face is integrated once. Internal to cad/.
#pragma once

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::cad {

/// Volumes by the divergence theorem. The integral over each face is kept, since the same faces come back in
/// shells, solids and unions.
class Volumes {
public:
  /// Volume inside closed shells; negative if they are oriented inward. Each face is accurate to four digits
  /// or more (face_integrals.hpp).
  double of(const TopoDS_Shape& shape);

private:
  gp_Pnt _reference;  // near the shapes, to avoid cancellation
  NCollection_DataMap<TopoDS_Shape, double, TopTools_ShapeMapHasher> _fluxes;  // of faces oriented forward
};

}  // namespace aeroloom::cad
