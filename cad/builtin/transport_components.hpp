/// The components of the built-in aircraft. Each is a closed solid with named faces. Internal to
/// cad/builtin/.
#pragma once

#include "cad/builtin/transport.hpp"
#include "geometry/vec.hpp"

#include <string>
#include <vector>

#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

using geometry::Vec2;
using geometry::Vec3;

struct NamedFace {
  TopoDS_Face face;
  std::string name;
};

/// A closed solid, and its faces as they are stored in the solid.
struct Component {
  TopoDS_Shape solid;
  std::vector<NamedFace> faces;
};

/// Sews faces that meet along whole edges into one solid. The faces of the solid are oriented outward.
Component sew_component(const std::vector<NamedFace>& faces);

/// The face that covers the whole surface.
TopoDS_Face whole_face(const Handle(Geom_Surface) & surface);

/// A body of revolution whose axis is bent upward in the plane y = 0. Control points give position and
/// radius.
class Fuselage {
public:
  explicit Fuselage(const TransportDimensions& dimensions);

  Component make_component() const;
  /// Distance from the point to the surface, about. Positive inside, negative outside.
  double depth(Vec3 point) const;

private:
  /// A control point of the profile.
  struct Station {
    double x, radius, z;
  };
  Station evaluate(double parameter) const;

  std::vector<Station> _stations;
  std::vector<double> _breaks;  // parameters of nose tip, cabin front, cabin end, tail end
};

/// The direction of the span.
enum class SpreadTo { right, up };

/// Half of a lifting surface, or the whole fin. Stations are measured in metres along the span, from the same
/// origin as `half_span`. Faces are called `name` + "_upper" and "_lower", those of the fin "_right" and
/// "_left".
class Lifting {
public:
  Lifting(const LiftingSurface& surface, SpreadTo to) : _surface(surface), _to(to) {}

  Component make_component(const std::string& name, double inner_station) const;
  /// Points around the section at a station.
  std::vector<Vec3> section(double station) const;

private:
  Vec3 place(Vec2 point, double station) const;

  LiftingSurface _surface;
  SpreadTo _to;
};

}  // namespace aeroloom::cad
