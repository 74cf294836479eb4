/// Converts exceptions of the CAD library and stops its output. Internal to cad/.
#pragma once

#include "cad/model/model.hpp"

#include <string>
#include <utility>

#include <Standard_Failure.hxx>

namespace aeroloom::cad {

/// Stops the CAD library from printing. May be called often.
void silence_cad_library();

/// Throws a CadError that says what was being done and what the CAD library reports.
[[noreturn]] void throw_cad_error(const std::string& doing, const Standard_Failure& failure);

/// Runs `action`. Exceptions of the CAD library, which do not derive from std::exception, become CadError.
template <class Action>
decltype(auto) guarded(const std::string& doing, Action&& action) {
  silence_cad_library();
  try {
    return std::forward<Action>(action)();
  } catch (const Standard_Failure& failure) {
    throw_cad_error(doing, failure);
  }
}

}  // namespace aeroloom::cad
