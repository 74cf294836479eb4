/// Command lines that cannot be read.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace aeroloom::pipeline {

/// The mistake in the line that `program` has tried to read, the command or option that was probably
/// meant, and where to read on.
std::string explain_usage_error(const CLI::App& program, const CLI::ParseError& error);

}  // namespace aeroloom::pipeline
