/// Small files of a study, read and written whole.
#pragma once

#include <filesystem>
#include <string>

namespace aeroloom::study {

/// Reading and writing throw std::runtime_error that names the file and why.
std::string read_file(const std::filesystem::path& file);
/// Makes the folders above; what was there goes only when all of the new text is written.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace aeroloom::study
