/// Parametrises faceted faces by flat sheets that do not overlap in the parameter plane. Internal to
/// cad/faceted/.
///
/// A sheet is a disk of triangles of one face, projected along their mean normal. The sheets of a face lie
/// side by side along u. The projection is one-to-one, which is checked: every triangle keeps its orientation
/// (exactly), and the border of the disk does not meet itself.
#pragma once

#include "cad/faceted/facet_links.hpp"

#include <vector>

namespace aeroloom::cad {

/// The map of a sheet: u along e1, beginning at `shift`; v along e2. A sheet of one triangle is rotated into
/// the plane instead.
struct FlatSheet {
  Vec3 origin, e1, e2;
  double shift = 0;
  double low = 0, high = 0;  ///< range of u
};

struct FacetSheets {
  std::vector<FlatSheet> sheets;  ///< sorted by face
  std::vector<std::int32_t> of;   ///< per triangle
};

using CornerUv = std::array<Vec2, 3>;

/// Triangles must be sorted by face.
FacetSheets cut_into_sheets(const FacetComplex& complex, const FacetLinks& links);

/// Parameters at the corners of each triangle, for given sheets. The same on every machine.
std::vector<CornerUv> flatten(const FacetComplex& complex, const FacetSheets& sheets);

/// Divides faces that have both sides of a curve, so that no face does. Each triangle goes to the side that
/// is nearer along the face. New faces keep name and regions. The triangles are then sorted by face. Throws
/// CadError if a face cannot be divided.
void divide_at_sharp_seams(FacetComplex& complex);

}  // namespace aeroloom::cad
