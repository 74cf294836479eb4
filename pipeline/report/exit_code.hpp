/// Exit codes of the program.
#pragma once

#include "pipeline/case/option_keys.hpp"

#include <stdexcept>
#include <string>

namespace aeroloom::report {

/// Exit codes; part of the program's interface (docs/usage.md).
enum class ExitCode {
  ok = 0,
  usage = 2,  ///< command line or configuration
  cad = 3,
  surface = 4,
  volume = 5,
  quality_gate = 6,
  files = 7,  ///< files could not be read or written
  resources = 8,
  bug = 70,
};

/// A stage failed. Message and code are equal on every rank. The message names options by their keys.
class StageFailure : public std::runtime_error {
public:
  StageFailure(std::string stage, ExitCode code, const std::string& message)
      : std::runtime_error(cases::with_keys(message)), _stage(std::move(stage)), _code(code) {}
  const std::string& stage() const { return _stage; }
  ExitCode code() const { return _code; }

private:
  std::string _stage;
  ExitCode _code;
};

}  // namespace aeroloom::report
