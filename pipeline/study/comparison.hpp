/// Compares two studies.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// Reads the scaling.json of a study for a comparison. Throws std::runtime_error with the name of the file
/// and what it lacks.
nlohmann::ordered_json read_study(const std::filesystem::path& file);
/// Compares two studies row by row (equal series and ranks), as text.
std::string compare_text(const nlohmann::ordered_json& before, const nlohmann::ordered_json& after);

}  // namespace aeroloom::study
