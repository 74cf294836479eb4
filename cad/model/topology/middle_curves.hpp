/// Curves in the middle between two borders of a strip, and curves with moved ends. Internal to cad/model/.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"
#include "cad/model/topology/border_path.hpp"

#include <vector>

#include <GeomAdaptor_Curve.hxx>
#include <Geom_Curve.hxx>

namespace aeroloom::cad {

/// A station divides the edge that replaces a strip. It is a pair of points on the two borders.
struct Station {
  std::array<double, 2> passed;                            ///< length along each border
  std::array<VertexId, 2> vertices{no_entity, no_entity};  ///< vertices of the borders there, if any
};

/// Stations from start to end, wherever a border has a vertex or a kink. Two vertices that face each other at
/// less than about the strip's width form one station.
std::vector<Station> place_stations(const Model& model, const BluntEdge& strip,
                                    const std::array<BorderPath, 2>& borders);

/// A curve between two stations, with the corresponding points on the borders.
struct MiddleCurve {
  Handle(Geom_Curve) curve;
  std::vector<double> parameters;                        ///< of the curve, ascending, ends included
  std::array<std::size_t, 2> edges{0, 0};                ///< indices in the borders' chains
  std::array<std::vector<double>, 2> border_parameters;  ///< on those edges, one per parameter
};

/// The curve in the middle of the borders, moved slightly so that it runs from `first` to `last`.
MiddleCurve draw_middle(const std::array<BorderPath, 2>& borders, const Station& from, const Station& to,
                        Vec3 first, Vec3 last);

/// A displacement of a curve's end that fades along the curve. It depends on the position alone, so curves
/// near each other at the end stay near each other.
struct EndMove {
  Vec3 from, by;
  double radius = 1;  ///< points farther away do not move

  Vec3 operator()(Vec3 point) const;
};

/// The curve with moved ends. Its parametrisation does not change, and lines stay lines.
Handle(Geom_Curve) move_ends(const GeomAdaptor_Curve& curve, const EndMove& first, const EndMove& last);

}  // namespace aeroloom::cad
