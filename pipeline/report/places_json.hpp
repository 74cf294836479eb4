/// The worst places of a mesh, for all that reports on them.
#pragma once

#include "mesh/quality/flaws.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::report {

/// The ten worst places, worst first: of all cells where they were measured, which they are wherever there
/// are layers; else the tetrahedra of smallest angle, and the worst faces where these were measured.
std::vector<mesh::FlawedCell> worst_places(const VolumeFigures& figures);
/// The worst place of each flaw that was looked for, in the order of flaws.
std::vector<mesh::FlawedCell> worst_flaws(const VolumeFigures& figures);

/// "a neighbour 90 times as large (cell 12 of the prisms, at (1, 2, 3))".
std::string text_of_place(const mesh::FlawedCell& place);
/// "an angle of 0.5 degrees", "a shape of 0.01", "a neighbour 90 times as large", "a face with a skewness of
/// 5".
std::string text_of_flaw(const mesh::FlawedCell& place);

nlohmann::ordered_json to_json(const std::vector<mesh::FlawedCell>& places);
nlohmann::ordered_json to_json(const std::vector<mesh::WorstCellOfShape>& worst);
/// A line for each.
std::string list_of_worst(const std::vector<mesh::WorstCellOfShape>& worst);

}  // namespace aeroloom::report
