/// Messages to the user. Rank 0 speaks for facts all ranks share; any rank may warn of its own. Facts go to
/// standard output, warnings and errors to standard error.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <string>
#include <string_view>

namespace aeroloom::parallel {

/// How much rank 0 prints besides warnings and errors, which are always printed.
enum class LogLevel { quiet, normal, verbose };

/// Call once after start; before that, or where a host program never does, facts are not printed, and
/// warnings and errors go to standard error of every rank.
void configure_log(const Communicator& communicator, LogLevel level);
/// The text with control characters written out (\x1b), all but newlines and tabs: names in files may hold
/// what a terminal obeys.
std::string printable(std::string_view text);
/// Printed by rank 0 only.
void log_info(const std::string& message);
void log_verbose(const std::string& message);
/// Printed by the calling rank, with its number when there are several; a warning is also kept
/// (warnings.hpp).
void log_warning(const std::string& message);
void log_error(const std::string& message);

}  // namespace aeroloom::parallel
