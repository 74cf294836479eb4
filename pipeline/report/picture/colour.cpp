#include "pipeline/report/picture/colour.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::picture {
namespace {

std::uint8_t component(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

}  // namespace

Colour mix(Colour a, Colour b, double fraction) {
  const int of_b = static_cast<int>(256 * std::clamp(fraction, 0.0, 1.0));
  const auto between = [of_b](int x, int y) {
    return static_cast<std::uint8_t>((x * (256 - of_b) + y * of_b + 128) >> 8);
  };
  return {between(a.red, b.red), between(a.green, b.green), between(a.blue, b.blue)};
}

Colour lit(Colour colour, double brightness) {
  return {component(brightness * colour.red), component(brightness * colour.green),
          component(brightness * colour.blue)};
}

std::string html_name(Colour colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

std::size_t angle_class(double degrees) {
  std::size_t i = 0;
  while (i + 1 < angle_classes.size() && !(degrees < angle_classes[i].below)) ++i;
  return i;
}

}  // namespace aeroloom::picture
