/// Printing of the progress line between log messages. Internal to parallel/.
#pragma once

#include <string>

namespace aeroloom::parallel::log_line {

/// Whether progress is printed: on rank 0, unless at LogLevel::quiet.
bool is_wanted();
/// Whether the line is rewritten in place, as on a terminal.
bool is_rewritten();
/// Prints the line, over the last one if it is rewritten.
void show(const std::string& line);
/// Erases a rewritten line. The log calls it before each message.
void erase();

}  // namespace aeroloom::parallel::log_line
