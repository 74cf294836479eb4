/// Faces of facets cut into sheets that lie in the parameter plane without overlap. Seen by this folder only.
///
/// A sheet is a disk of triangles of one face that is projected along its mean normal; those of a face lie
/// side by side along u. That the projection is injective is checked, not assumed: every triangle is turned
/// the right way (exactly), and the border of the disk does not meet itself, so that every point of the plane
/// is covered once at most.
#pragma once

#include "cad/faceted/facet_links.hpp"

#include <vector>

namespace aeroloom::cad {

/// The map of a sheet: u along e1, from `shift` on, v along e2. A sheet of one triangle is laid flat instead.
struct FlatSheet {
  Vec3 origin, e1, e2;
  double shift = 0;
  double low = 0, high = 0;  ///< of u
};

struct FacetSheets {
  std::vector<FlatSheet> sheets;  ///< by face
  std::vector<std::int32_t> of;   ///< per triangle
};

using CornerUv = std::array<Vec2, 3>;

/// Triangles must be sorted by face.
FacetSheets cut_into_sheets(const FacetComplex& complex, const FacetLinks& links);

/// Parameters at the corners of each triangle, for sheets made before: the same on every machine.
std::vector<CornerUv> flatten(const FacetComplex& complex, const FacetSheets& sheets);

/// Divides faces so that none has both sides of a curve: each triangle joins the side that is nearer over the
/// face, so that the division goes on from where a curve ends inside. The parts keep names and regions.
/// Triangles come out sorted by face. Throws CadError where that does not separate them.
void divide_at_sharp_seams(FacetComplex& complex);

}  // namespace aeroloom::cad
