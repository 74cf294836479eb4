#include "tests/source_tree.hpp"

namespace aeroloom {

std::filesystem::path source_tree() {
  return AEROLOOM_SOURCE_DIR;
}

}  // namespace aeroloom
