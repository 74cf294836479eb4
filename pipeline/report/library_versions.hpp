/// The versions of the libraries that the program is made of.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::report {

/// The version of the program: "0.2.0".
std::string program_version();

/// Names and versions of the libraries, of those that are loaded where they can be asked, otherwise of those
/// compiled against.
std::vector<std::pair<std::string, std::string>> library_versions();

/// All of it with the licence, as `aeroloom --version` prints it.
std::string version_text();

}  // namespace aeroloom::report
