/// The built-in aircraft in its far field, made once for tests of cases.
#pragma once

#include "cad/domain/domain.hpp"

namespace aeroloom::cases {

inline const cad::Model& transport() {
  static const cad::Model model = [] {
    cad::DomainOptions options;
    options.transport = cad::TransportDimensions{};
    return cad::prepare_domain(options).model;
  }();
  return model;
}

}  // namespace aeroloom::cases
