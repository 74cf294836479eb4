/// The dictionaries and fields that a solver needs besides the mesh, with conditions by type of patch.
///
/// With them `potentialFoam` runs, then `simpleFoam` with the k-omega SST model: air at 50 m/s. First-order
/// convection and limited gradients make the start on tetrahedra robust rather than accurate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

struct FoamSetting {
  std::filesystem::path path;  ///< relative to the case
  std::string text;
};

/// All dictionaries but decomposeParDict.
std::vector<FoamSetting> foam_dictionaries();
/// The values that the fields use. `is_external`: with a far field, the flow starts with its state; otherwise
/// at rest.
FoamSetting foam_conditions(bool is_external);

struct FoamField {
  std::string name;
  std::string text;  ///< the content in 0.orig, with the conditions
  std::string link;  ///< the content in the time folder 0: it includes the file in 0.orig
};
/// `up`: the path from a time folder to the case, "../" or "../../".
std::vector<FoamField> foam_fields(std::string_view up);

/// A decomposeParDict for `parts` parts.
std::string foam_decomposition(std::int64_t parts);

}  // namespace aeroloom::io
