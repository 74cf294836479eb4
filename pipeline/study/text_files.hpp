/// Reads and writes whole small files of a study.
#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace aeroloom::study {

/// All functions throw std::runtime_error with the name of the file and the reason.
std::string read_file(const std::filesystem::path& file);
/// An object; throws also for a file that is cut or is no JSON, with the place.
nlohmann::ordered_json read_json(const std::filesystem::path& file);
/// Throws that `file` is not `what`: what an exception of JSON says, in plain words.
[[noreturn]] void refuse_json(const std::filesystem::path& file, const std::string& what,
                              const std::exception& error);
/// Creates missing folders. Replaces an old file only once the new text is written completely.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace aeroloom::study
