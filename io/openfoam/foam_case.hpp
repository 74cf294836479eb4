/// The folders of a case, and the dictionaries that a solver must find there.
#pragma once

#include "mesh/data/patch.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aeroloom::io {

struct FoamCase {
  std::filesystem::path folder;
  std::int32_t parts = 1;

  /// The case itself where there is one part.
  std::filesystem::path root(std::int32_t part) const;
  /// The parent of polyMesh.
  std::filesystem::path constant(std::int32_t part) const { return root(part) / "constant"; }
  std::filesystem::path mesh(std::int32_t part) const { return constant(part) / "polyMesh"; }
  std::filesystem::path unfinished(std::int32_t part) const { return constant(part) / "polyMesh.unfinished"; }
};

/// Makes the folder, and removes what a killed run left unfinished. Throws filesystem_error where a processor
/// folder beyond the parts holds more than an earlier mesh and what write_fields left. By one rank.
void prepare_case(const FoamCase& foam_case);
/// Removes the meshes of earlier runs, and what write_fields left that nobody changed. By one rank.
void retire_meshes(const FoamCase& foam_case);

/// Writes the settings of foam_settings.hpp where they are missing: dictionaries under system/ and constant/,
/// fields in 0.orig/. A decomposeParDict of another number of parts is written anew if it is as it was
/// written here, otherwise a warning says so. By one rank. False: there are fields of an undivided case that
/// no part is to be given others beside.
bool write_settings(const FoamCase& foam_case, bool is_external);
/// Refers the time folder 0 of a part to the fields in 0.orig/, where it has none of its own.
void write_fields(const FoamCase& foam_case, std::int32_t part);

/// Patches by id: their names, and the groups that they are in, by which fields name them; empty where a
/// patch has the name of its type and is the only one of it. No other patch has the name of a type.
struct FoamPatches {
  std::vector<std::string> names, groups;
};
FoamPatches foam_patches(const std::vector<mesh::Patch>& patches);

/// Names as OpenFOAM's words, distinct.
std::vector<std::string> foam_words(const std::vector<std::string>& names);

}  // namespace aeroloom::io
