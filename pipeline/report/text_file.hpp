/// Reads and writes whole text files.
#pragma once

#include <string>

namespace aeroloom::report {

/// Throws std::ios_base::failure with the name of the file.
std::string read_text(const std::string& file);
/// Creates missing folders. Replaces an old file only once the new text is written completely. Throws as
/// read_text().
void write_text(const std::string& file, const std::string& text);
/// As write_text(), for files of an output folder: a link there is replaced, not followed, as the files of
/// meshes do.
void replace_text(const std::string& file, const std::string& text);
/// Prints to standard output. Throws std::ios_base::failure.
void print_text(const std::string& text);

}  // namespace aeroloom::report
