/// Completion of the command line in bash.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

/// A script for bash to source, made from the commands and options of the program and the keys of a case. It
/// needs no package beside bash.
std::string bash_completion(const CLI::App& program, const std::vector<cases::KeyInfo>& keys);

}  // namespace aeroloom::pipeline
