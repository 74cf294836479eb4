/// What vertices lie on.
#pragma once

#include <cstdint>

namespace aeroloom::mesh {

/// The dimension of the CAD entity that a vertex is classified on; they compare by it.
enum class CadDimension : std::int8_t { vertex = 0, edge = 1, face = 2, region = 3 };

}  // namespace aeroloom::mesh
