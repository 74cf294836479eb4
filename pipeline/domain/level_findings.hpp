/// The lifting bodies from which a level took its sizes, for `aeroloom check`.
#pragma once

#include "cad/model/model.hpp"
#include "sizing/choice/levels.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {
struct LiftingBodies;
}

namespace aeroloom::domain {

/// A trailing edge. Lengths are in the model's unit.
struct FoundTrailingEdge {
  std::string faces;  ///< the narrow face of a blunt edge; the two faces of a sharp edge
  bool is_blunt = false;
  double length = 0;
  double width = 0;  ///< largest width of the narrow face; 0: sharp
  double shortest_chord = 0, longest_chord = 0;
  double smallest_size = 0;  ///< wanted along the edge
};

struct LevelFindings {
  double reference_chord = 0, semispan = 0;
  double wall_size = 0;  ///< largest size on walls
  double far_field = 0;  ///< distance from the centre, in semispans
  std::vector<FoundTrailingEdge> edges;
};

LevelFindings describe_level(const cad::Model& model, const sizing::LiftingBodies& bodies,
                             const sizing::LevelSizes& sizes);

}  // namespace aeroloom::domain
