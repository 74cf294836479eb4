/// Text files, read and written whole.
#pragma once

#include <string>

namespace aeroloom::report {

/// Throws std::ios_base::failure, naming the file.
std::string read_text(const std::string& file);
/// Makes the folders above the file where they are not there; what was there before goes only when all of the
/// new text is written. Throws as read_text.
void write_text(const std::string& file, const std::string& text);
/// To standard output. Throws std::ios_base::failure.
void print_text(const std::string& text);

}  // namespace aeroloom::report
