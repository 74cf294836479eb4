/// Versions of the program and its libraries.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::report {

/// The version of the program: "0.2.0".
std::string program_version();

/// Names and versions of the libraries: of the loaded library if it can be asked, else of the headers.
std::vector<std::pair<std::string, std::string>> library_versions();

/// Versions and licence, as printed by `aeroloom --version`.
std::string version_text();

}  // namespace aeroloom::report
