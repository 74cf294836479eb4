/// The built-in aircraft with trailing edges of a thousandth of the chord, made once. Those of the horizontal
/// tail are sharp.
#pragma once

#include "cad/domain/domain.hpp"

namespace aeroloom::sizing::shapes {

constexpr double thin_share = 1e-3;

inline cad::TransportDimensions thin_dimensions() {
  cad::TransportDimensions dimensions;
  dimensions.wing.trailing_edge = dimensions.vertical_tail.trailing_edge = thin_share;
  dimensions.horizontal_tail.trailing_edge = 0;
  return dimensions;
}

inline const cad::Model& thin_aircraft() {
  static const cad::Model model = [] {
    cad::DomainOptions options;
    options.transport = thin_dimensions();
    return cad::prepare_domain(options).model;
  }();
  return model;
}

}  // namespace aeroloom::sizing::shapes
