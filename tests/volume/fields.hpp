/// Size fields to fill with.
#pragma once

#include "sizing/field/size_field.hpp"

#include <vector>

namespace aeroloom::volume::fields {

inline const geometry::Box domain{{-2, -2, -2}, {2, 2, 2}};

/// The same size everywhere.
inline sizing::SizeField uniform(double size, const geometry::Box& box = domain) {
  return sizing::SizeField::build(box, {}, {size, size, 12, 1.3});
}

/// `smallest` on the unit sphere, growing away from it at the limit.
inline sizing::SizeField around_unit_sphere(double smallest, double largest, double growth = 1.3,
                                            const geometry::Box& box = domain) {
  std::vector<sizing::SizeSource> sources;
  const int rings = static_cast<int>(4 / smallest);
  for (int i = 0; i <= rings; ++i) {
    const double polar = 3.14159265358979 * i / rings;
    const int around = std::max(1, static_cast<int>(2 * rings * std::sin(polar)));
    for (int j = 0; j < around; ++j) {
      const double azimuth = 2 * 3.14159265358979 * j / around;
      sources.push_back(
          {{std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)},
           smallest});
    }
  }
  return sizing::SizeField::build(box, sources, {smallest, largest, 12, growth});
}

}  // namespace aeroloom::volume::fields
