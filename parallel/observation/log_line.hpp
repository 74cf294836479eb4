/// The line of progress among what the log prints. Internal to parallel/.
#pragma once

#include <string>

namespace aeroloom::parallel::log_line {

/// Whether progress is printed: on rank 0, and not at LogLevel::quiet.
bool is_wanted();
/// Whether the line is rewritten in place, as on a terminal.
bool is_rewritten();
/// Prints the line, or writes it over the last one.
void show(const std::string& line);
/// Takes a line that is rewritten away. The log does before it prints.
void erase();

}  // namespace aeroloom::parallel::log_line
