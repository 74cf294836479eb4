/// Reads and writes whole small files of a study.
#pragma once

#include <filesystem>
#include <string>

namespace aeroloom::study {

/// Both functions throw std::runtime_error with the name of the file and the reason.
std::string read_file(const std::filesystem::path& file);
/// Creates missing folders. Replaces an old file only once the new text is written completely.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace aeroloom::study
