/// Dictionaries, and fields with conditions by type of patch: all that a solver needs besides the mesh.
///
/// They make `potentialFoam`, then `simpleFoam` with the k-omega SST model, run as they stand: air at 50 m/s,
/// first-order convection of turbulence and limited gradients, made to start from nothing on tetrahedra
/// rather than to be exact.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

struct FoamSetting {
  std::filesystem::path path;  ///< below the case
  std::string text;
};

/// All but decomposeParDict, and what foam_fields are made with.
std::vector<FoamSetting> foam_dictionaries();
/// The numbers of the fields. `is_external`: there is a far field, and what flows starts as it does there;
/// else at rest.
FoamSetting foam_conditions(bool is_external);

struct FoamField {
  std::string name;
  std::string text;  ///< as it stands in 0.orig, beside the conditions
  std::string link;  ///< as it stands in the time folder 0: that it is the one in 0.orig
};
/// `up`: from a time folder to the case, "../" or "../../".
std::vector<FoamField> foam_fields(std::string_view up);

/// A dictionary decomposeParDict for as many parts.
std::string foam_decomposition(std::int64_t parts);

}  // namespace aeroloom::io
