/// Changes of sizes and corners that avoid needles which the CAD does not force.
#pragma once

#include "surface/cusps/needles.hpp"

#include <vector>

namespace aeroloom::surface {

struct NeedleRemedies {
  std::vector<sizing::SizeSource> sizes;  ///< where sizes have to fall
  std::vector<cad::VertexId> short_legs;  ///< sharp corners whose legs must become shorter; ascending

  bool empty() const { return sizes.empty() && short_legs.empty(); }
};

/// Most needles stand on a short segment of a curve among large elements. There the size falls to twice the
/// length of the segment. Others stand on the long first segment of a sharp corner of a neighbouring face,
/// which then becomes shorter. Collective, the same on every rank.
NeedleRemedies find_needle_remedies(const mesh::DistributedMesh& surface, const std::vector<Needle>& needles,
                                    const sizing::SizeField& field);

}  // namespace aeroloom::surface
