/// The folders of a case, and the dictionaries that a solver must find there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aeroloom::io {

struct FoamCase {
  std::filesystem::path folder;
  std::int32_t parts = 1;

  /// The parent of polyMesh.
  std::filesystem::path constant(std::int32_t part) const;
  std::filesystem::path mesh(std::int32_t part) const { return constant(part) / "polyMesh"; }
  std::filesystem::path unfinished(std::int32_t part) const { return constant(part) / "polyMesh.unfinished"; }
};

/// Removes the meshes of earlier runs. Throws filesystem_error where a processor folder beyond the parts
/// holds anything else. By one rank.
void clear_case(const FoamCase& foam_case);

/// Writes dictionaries under system/ where they are missing. A decomposeParDict of another number of parts is
/// written anew if it is as it was written here, otherwise a warning says so. By one rank.
void write_dictionaries(const FoamCase& foam_case);

/// Names as OpenFOAM's words, distinct.
std::vector<std::string> foam_words(const std::vector<std::string>& names);

}  // namespace aeroloom::io
