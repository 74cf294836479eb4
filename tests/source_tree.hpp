/// Where the sources are: tests read pages, data and real geometry there.
#pragma once

#include <filesystem>

namespace aeroloom {

/// Root of the source tree. In one place, so that the objects of tests do not depend on it.
std::filesystem::path source_tree();

}  // namespace aeroloom
