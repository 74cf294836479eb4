/// The plane of symmetry of half models. Seen by this folder only.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <optional>

#include <TopoDS_Face.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {

/// A plane normal to a coordinate axis, and the side of it that the fluid is on.
struct SymmetryPlane {
  int axis = 1;
  double position = 0;
  bool positive = true;  ///< the fluid has larger coordinates than the plane
  double tolerance = 0;  ///< what is nearer to the plane than this is on it
  std::string reason;    ///< how it was found

  gp_Pln plane() const;  ///< its normal points out of the fluid
  /// Whether a face lies on the plane.
  bool holds(const TopoDS_Face& face) const;
};

/// "plane of symmetry y = 0: ...", with how it was found.
std::string describe(const SymmetryPlane& symmetry);

/// The plane that the options ask for, if any. Throws CadError where none can be found, or the body does not
/// reach it.
std::optional<SymmetryPlane> find_symmetry(const FarFieldOptions& options, const TopoDS_Shape& bodies);

/// The bodies' part on the plane's side; cut there, volumes checked, where they cross it. Labels follow.
NamedShape cut_at_symmetry(NamedShape bodies, const SymmetryPlane& symmetry, Volumes& volumes,
                           Changes& changes);

}  // namespace aeroloom::cad
