/// Shapes of the places where a case requests sizes.
#pragma once

#include "geometry/vec.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace aeroloom::sizing {

// A solid shape answers four questions:
//   distance_to(p)  how far a point is from it; 0 inside
//   box()           the box around it
//   cells(edge)     cubes of that edge that hold it, about and rather too many; infinity: its box tells
//   scaled(factor)  the shape with all places and lengths so many times as large

struct PointShape {
  geometry::Vec3 center;

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  PointShape scaled(double factor) const;
};

struct LineShape {
  geometry::Vec3 from, to;

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  LineShape scaled(double factor) const;
};

struct SphereShape {
  geometry::Vec3 center;
  double radius = 0;

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  SphereShape scaled(double factor) const;
};

struct BoxShape {
  geometry::Vec3 low, high;  ///< any two opposite corners

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  BoxShape scaled(double factor) const;
};

/// With plane ends.
struct CylinderShape {
  geometry::Vec3 from, to;  ///< ends of the axis
  double radius = 0;

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  CylinderShape scaled(double factor) const;
};

/// With plane ends.
struct ConeShape {
  geometry::Vec3 from, to;            ///< ends of the axis
  double radius = 0, end_radius = 0;  ///< at `from` and at `to`

  double distance_to(geometry::Vec3 p) const;
  geometry::Box box() const;
  double cells(double edge) const;
  ConeShape scaled(double factor) const;
};

/// The sheet that flows off a line, or off the trailing edges of faces. It answers scaled() alone, since only
/// the model knows where trailing edges are; surface_request.hpp makes the sheet.
struct WakeShape {
  std::vector<std::string> behind;         ///< patterns of faces' or patches' names; none: `from` and `to`
  std::optional<geometry::Vec3> from, to;  ///< ends of the line
  geometry::Vec3 direction;                ///< of any length but 0
  double length = 0;
  std::optional<double> end_size;  ///< at the end, linear in between; none: one size everywhere

  WakeShape scaled(double factor) const;
};

/// A shape that is filled with elements of one size.
using SolidShape = std::variant<PointShape, LineShape, SphereShape, BoxShape, CylinderShape, ConeShape>;
/// Any shape, in the order of the key `shape`.
using SizeShape =
    std::variant<PointShape, LineShape, SphereShape, BoxShape, CylinderShape, ConeShape, WakeShape>;

// The questions above of any shape. None has an answer for shapes that do not answer it.
double distance_to(const SolidShape& shape, geometry::Vec3 p);
geometry::Box box_of(const SolidShape& shape);
double cells_of(const SolidShape& shape, double edge);
SizeShape scaled(const SizeShape& shape, double factor);

}  // namespace aeroloom::sizing
