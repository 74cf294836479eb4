/// The dictionaries and fields that a solver needs besides the mesh, with conditions by type of patch.
///
/// With them `simpleFoam` runs with the k-omega SST model from the uniform free stream: first-order
/// convection for a hundred iterations, second from then on, by SIMPLEC (Van Doormaal and Raithby, Numerical
/// Heat Transfer 7, 1984).
#pragma once

#include "io/file_mesh.hpp"

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

/// All dictionaries but decomposeParDict. `has_fans`: several columns of layers stand on a wall's vertices.
/// The value at such a corner is then a mean over the wall on both sides, and that above it of one side; and
/// the cells of a sector are much narrower than those beside. So in the cells of constant/sharpEdges
/// gradients at second order come from cells, not from corners, and the convection of U stays of first order.
std::vector<FoamSetting> foam_dictionaries(bool has_fans);
/// The values that the fields use. The viscosity follows from the Reynolds number; without one it is that of
/// air in the unit of the mesh. `is_external`: with a far field, the flow starts with its state; otherwise at
/// rest.
FoamSetting foam_conditions(const FlowReference& flow, bool is_external);

/// A script that runs the case.
FoamSetting foam_script(std::int64_t parts);

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
