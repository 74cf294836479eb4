/// The parts of the built-in aircraft, each a closed solid with named faces. Seen by this folder only.
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

/// A closed solid and its faces as they occur in it.
struct Component {
  TopoDS_Shape solid;
  std::vector<NamedFace> faces;
};

/// Sews faces that meet along whole edges into one solid, its faces oriented outward.
Component sew_component(const std::vector<NamedFace>& faces);

/// The face that covers the whole surface.
TopoDS_Face whole_face(const Handle(Geom_Surface) & surface);

/// Circles around an axis in the plane y = 0 along a control polygon: a body of revolution bent upward.
class Fuselage {
public:
  explicit Fuselage(const TransportDimensions& dimensions);

  Component make_component() const;
  /// How deep the point lies inside; negative outside.
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

/// Where a lifting surface spreads to.
enum class SpreadTo { right, up };

/// One half of a lifting surface (the fin: all of it) as a solid between two stations of its span, in metres
/// from where `half_span` is counted. Upper and lower faces are `name` + "_upper", "_lower"; a fin has
/// "_right" and "_left".
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
