/// Errors of the surface stage.
#pragma once

#include <stdexcept>

namespace aeroloom::surface {

/// A face cannot be meshed. The message names the face and its patch, the place, the size there and the
/// remedy.
class SurfaceError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace aeroloom::surface
