/// The symmetry plane of half models. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/volumes.hpp"

#include <optional>

#include <TopoDS_Face.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {

/// A plane normal to a coordinate axis, and the side on which the fluid lies.
struct SymmetryPlane {
  int axis = 1;
  double position = 0;
  bool positive = true;  ///< the fluid has larger coordinates than the plane
  double tolerance = 0;  ///< points nearer than this lie on the plane
  double reach = 0;      ///< flat sides nearer than this are put on the plane
  std::string reason;    ///< how the plane was found

  gp_Pln plane() const;  ///< its normal points out of the fluid
  /// Whether a face lies on the plane.
  bool holds(const TopoDS_Face& face) const;
};

/// "plane of symmetry y = 0: ...", followed by the reason.
std::string describe(const SymmetryPlane& symmetry);

/// The plane that the options ask for, if any. Throws CadError if no plane can be found or the body does not
/// reach it.
std::optional<SymmetryPlane> find_symmetry(const FarFieldOptions& options, const NamedShape& bodies);

/// The bodies on the plane's side. Bodies that cross the plane are cut, and volumes are checked. Those whose
/// flat side is nearer than the plane's reach stay as they are. Labels follow. Throws CadError for flat sides
/// that miss the plane by more.
NamedShape cut_at_symmetry(NamedShape bodies, const SymmetryPlane& symmetry, Volumes& volumes,
                           Changes& changes);

}  // namespace aeroloom::cad
