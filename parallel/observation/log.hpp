/// Messages to the user. Rank 0 prints information; any rank prints warnings and errors. Information goes to
/// standard output, warnings and errors go to standard error.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <string>
#include <string_view>

namespace aeroloom::parallel {

/// How much information rank 0 prints. Warnings and errors are always printed.
enum class LogLevel { quiet, normal, verbose };

/// Call it once after the start. Before that, or if a host program never calls it, no information is printed;
/// warnings and errors go to standard error of every rank.
void configure_log(const Communicator& communicator, LogLevel level);
/// The text with control characters written out (\x1b), except newlines and tabs. Names in files may contain
/// commands to the terminal.
std::string printable(std::string_view text);
/// Printed by rank 0 only.
void log_info(const std::string& message);
void log_verbose(const std::string& message);
/// Printed by the calling rank, with its number if there are several ranks. Warnings are also kept for the
/// report (warnings.hpp).
void log_warning(const std::string& message);
void log_error(const std::string& message);

}  // namespace aeroloom::parallel
