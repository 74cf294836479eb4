/// Completion of command lines in bash.
#pragma once

#include "pipeline/case/key_info.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

/// A bash script made from the program's commands and options and the keys of a case. It needs no other
/// package.
std::string bash_completion(const CLI::App& program, const std::vector<cases::KeyInfo>& keys);

}  // namespace aeroloom::pipeline
