/// CAD bodies and bodies of triangles in one fluid. Internal to cad/.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/domain/far_field.hpp"
#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/model_data.hpp"

#include <optional>
#include <vector>

namespace aeroloom::cad {

/// The boundary of the fluid: CAD faces, the far field among them, and walls of triangles.
struct MixedFluid {
  NamedShape shape;
  std::optional<FacetedGeometry> walls;  ///< absent if all triangles lie inside CAD bodies
  std::vector<FaceTag> wall_tags;
  double walled_volume = 0;  ///< volume of the bodies of triangles
};

/// Places bodies of triangles beside the CAD `bodies`, which must be disjoint. They come from the parts in
/// `options`, and from the file if it holds no CAD. CAD bodies that overlap triangles and bodies of refused
/// unions are triangulated. They are united with the triangles (unite_components.hpp). Bodies inside others
/// are left out. All changes are listed.
/// Throws CadError that names the bodies if a union fails, or if bodies are so close that triangles cannot
/// decide whether they touch.
MixedFluid surround_mixed(NamedShape bodies, const std::vector<RefusedUnion>& refused,
                          const DomainOptions& options, Volumes& volumes, Changes& changes);

/// Throws CadError if the volume of the model is not that of the shape less that of the walls.
void require_mixed_volume(const Model& model, const MixedFluid& fluid, Volumes& volumes);

}  // namespace aeroloom::cad
