/// The folders of an OpenFOAM case, and the dictionaries that a solver needs there.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/data/patch.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aeroloom::io {

struct FoamCase {
  std::filesystem::path folder;
  std::int32_t parts = 1;

  /// The folder of a part: processorN, or the case itself where there is one part.
  std::filesystem::path root(std::int32_t part) const;
  /// The parent of polyMesh.
  std::filesystem::path constant(std::int32_t part) const { return root(part) / "constant"; }
  std::filesystem::path mesh(std::int32_t part) const { return constant(part) / "polyMesh"; }
  std::filesystem::path unfinished(std::int32_t part) const { return constant(part) / "polyMesh.unfinished"; }
  /// A field that is 0 in the cells at sharp edges of layers, of a mesh that has such cells.
  std::filesystem::path sharp_edges(std::int32_t part) const { return constant(part) / sharp_edges_name; }
  static constexpr const char* sharp_edges_name = "sharpEdges";
};

/// Makes the folder, and removes unfinished files of an earlier run. Throws filesystem_error where a surplus
/// processor folder holds results. One rank calls it.
void prepare_case(const FoamCase& foam_case);
/// Removes the dictionaries of a mesh with fans where this one has none, or the other way round, where all
/// are as they were written; otherwise a warning follows where they do not fit. One rank calls it.
void remove_unfit_dictionaries(const FoamCase& foam_case, bool has_fans);
/// Whether settings there refer to sharp_edges().
bool asks_for_sharp_edges(const FoamCase& foam_case);
/// Removes meshes of earlier runs, and unchanged files of write_fields(). One rank calls it.
void retire_meshes(const FoamCase& foam_case);

/// What settings depend on.
struct FoamFlow {
  FlowReference reference;
  bool is_external = false;  ///< there is a far field
  bool has_fans = false;     ///< as foam_dictionaries() has it
};

/// Writes the missing settings of foam_settings.hpp: dictionaries in system/ and constant/, fields in
/// 0.orig/, and the script run.sh. A decomposeParDict or script for another number of parts is replaced where
/// it is unchanged; otherwise a warning follows. Returns false where the case has fields in 0/ that are not
/// decomposed: the parts then get no fields. One rank calls it.
bool write_settings(const FoamCase& foam_case, const FoamFlow& flow);
/// Makes the missing fields in the time folder 0 of a part, each of which includes the one in 0.orig/.
void write_fields(const FoamCase& foam_case, std::int32_t part);

/// By patch: its name, and the group of its type, by which fields find it. The group is empty where the patch
/// is the only one of its type and has the name of the type. No other patch has the name of a type.
struct FoamPatches {
  std::vector<std::string> names, groups;
};
FoamPatches foam_patches(const std::vector<mesh::Patch>& patches);

/// The names as words of OpenFOAM, all different.
std::vector<std::string> foam_words(const std::vector<std::string>& names);

}  // namespace aeroloom::io
