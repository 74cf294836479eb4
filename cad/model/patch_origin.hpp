/// Where names of patches come from. Internal to cad/.
#pragma once

#include <cstdint>

namespace aeroloom::cad {

enum class PatchOrigin : std::uint8_t {
  program,  ///< far field and plane of symmetry
  file,     ///< names of faces and solids, layers, colours
  unnamed,  ///< made for faces of the file that have none of these
  part      ///< a part of the case
};

}  // namespace aeroloom::cad
