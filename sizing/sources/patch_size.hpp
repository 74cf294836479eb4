/// The size that is asked for on a patch.
#pragma once

#include <string>

namespace aeroloom::sizing {

/// Elements on the faces of a patch are at most so large.
struct PatchSize {
  std::string patch;
  double size = 0;
};

}  // namespace aeroloom::sizing
