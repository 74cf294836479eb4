/// Messages about command lines that cannot be parsed.
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace aeroloom::pipeline {

/// Describes the mistake, the command or option that was probably meant, and where to read more.
std::string explain_usage_error(const CLI::App& program, const CLI::ParseError& error);

}  // namespace aeroloom::pipeline
