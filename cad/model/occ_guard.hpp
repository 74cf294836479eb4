/// The border to the CAD library: its exceptions become ours, its chatter stays inside. Seen by this folder
/// only.
#pragma once

#include "cad/model/model.hpp"

#include <string>
#include <utility>

#include <Standard_Failure.hxx>

namespace aeroloom::cad {

/// Stops the CAD library from printing; cheap to call again.
void silence_cad_library();

/// The CAD library's exception as a CadError saying what was being done.
[[noreturn]] void throw_cad_error(const std::string& doing, const Standard_Failure& failure);

/// Runs `action`; what the CAD library throws (it does not derive from std::exception) becomes a CadError.
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
