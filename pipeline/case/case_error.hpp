/// Errors in a case, with their place in the file.
#pragma once

#include <stdexcept>

namespace aeroloom::cases {

/// The message starts with the place: "file:line:column: " or "--set key=value: ".
class CaseError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace aeroloom::cases
