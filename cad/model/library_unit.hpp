/// The unit in which shapes are made. The CAD library tells points 1e-7 apart whatever the unit, so tiny and
/// huge shapes are made in a unit of their own, a power of two of the file's. Internal to cad/.
#pragma once

#include "geometry/vec.hpp"

#include <string>

namespace aeroloom::cad {

/// The unit for shapes of this extent, in the file's unit. It is 1 where the library's tolerances serve;
/// beyond, the extent becomes one unit to two. Lengths are then scaled without rounding.
double library_unit(double extent);

/// While it lives, lengths of shapes in this thread are in this unit. One may live within another.
class InLibraryUnit {
public:
  explicit InLibraryUnit(double unit);
  ~InLibraryUnit();
  InLibraryUnit(const InLibraryUnit&) = delete;
  InLibraryUnit& operator=(const InLibraryUnit&) = delete;

private:
  double _before;
};

/// A length of shapes in the file's unit, for messages; an area with power 2, a volume with 3.
double in_file(double length, int power = 1);
/// geometry::place_text() of a place in shapes.
std::string place_in_file(geometry::Vec3 place);

}  // namespace aeroloom::cad
