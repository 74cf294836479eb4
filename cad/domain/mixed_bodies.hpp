/// Bodies of the CAD library and bodies of triangles in one fluid. Seen by this folder only.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/domain/far_field.hpp"
#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/model_data.hpp"

#include <optional>
#include <vector>

namespace aeroloom::cad {

/// The fluid around them: the CAD library's faces, with the far field, and those of triangles.
struct MixedFluid {
  NamedShape shape;
  std::optional<FacetedGeometry> walls;  ///< none where all triangles lie inside bodies
  std::vector<FaceTag> wall_tags;
  double walled_volume = 0;  ///< of the bodies of triangles
};

/// The parts of `options`, and triangles of the file where it has no CAD, beside `bodies`, which are
/// disjoint. Bodies that overlap triangles, and those of refused unions, become triangles and are united with
/// them (unite_components.hpp); what lies inside others is left out. All that is listed. Throws CadError
/// naming the bodies where a union fails, or where bodies come so near that triangles cannot tell whether
/// they touch.
MixedFluid surround_mixed(NamedShape bodies, const std::vector<RefusedUnion>& refused,
                          const DomainOptions& options, Volumes& volumes, Changes& changes);

/// Throws CadError where the model's volume is not that of the shape less that of the walls.
void require_mixed_volume(const Model& model, const MixedFluid& fluid, Volumes& volumes);

}  // namespace aeroloom::cad
