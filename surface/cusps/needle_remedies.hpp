/// Changes after which needles that the CAD does not force do not come about again.
#pragma once

#include "surface/cusps/needles.hpp"

#include <vector>

namespace aeroloom::surface {

struct NeedleRemedies {
  std::vector<sizing::SizeSource> sizes;  ///< where sizes have to fall
  std::vector<cad::VertexId>
      short_legs;  ///< sharp corners whose legs are too long for the faces around; ascending

  bool empty() const { return sizes.empty() && short_legs.empty(); }
};

/// Most needles stand on a short segment of a curve amid large elements: twice its length lets elements grow
/// from it. Others stand along the leg of a sharp corner of a neighbouring face. Collective, the same on
/// every rank.
NeedleRemedies find_needle_remedies(const mesh::DistributedMesh& surface, const std::vector<Needle>& needles,
                                    const sizing::SizeField& field);

}  // namespace aeroloom::surface
