/// What a level of sizes was based on: the lifting bodies of a model, as `check` tells of them.
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
  std::string faces;  ///< the strip of a blunt one, the faces that meet in a sharp one
  bool is_blunt = false;
  double length = 0;
  double width = 0;  ///< of the strip where it is widest; 0: sharp
  double shortest_chord = 0, longest_chord = 0;
  double smallest_size = 0;  ///< asked for along it
};

struct LevelFindings {
  double reference_chord = 0, semispan = 0;
  double wall_size = 0;  ///< at most, on walls
  double far_field = 0;  ///< how far it is from the middle, in semispans
  std::vector<FoundTrailingEdge> edges;
};

LevelFindings describe_level(const cad::Model& model, const sizing::LiftingBodies& bodies,
                             const sizing::LevelSizes& sizes);

}  // namespace aeroloom::domain
