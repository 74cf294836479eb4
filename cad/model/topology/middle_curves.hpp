/// Curves half-way between the borders of a strip, and curves whose ends moved. Seen by this folder only.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"
#include "cad/model/topology/border_path.hpp"

#include <vector>

#include <GeomAdaptor_Curve.hxx>
#include <Geom_Curve.hxx>

namespace aeroloom::cad {

/// Where the edge that takes a strip's place begins, ends or is divided: on both borders.
struct Station {
  std::array<double, 2> passed;                            ///< length along each border
  std::array<VertexId, 2> vertices{no_entity, no_entity};  ///< of the borders, where they have one there
};

/// Stations from the start of the borders to their end: wherever either has a vertex or a kink. Vertices that
/// face each other, nearer than the strip is wide, are one station.
std::vector<Station> place_stations(const Model& model, const BluntEdge& strip,
                                    const std::array<BorderPath, 2>& borders);

/// A curve between two stations and the places on the borders that it lies between.
struct MiddleCurve {
  Handle(Geom_Curve) curve;
  std::vector<double> parameters;                        ///< of the curve, ascending, first to last
  std::array<std::size_t, 2> edges{0, 0};                ///< of the borders' chains
  std::array<std::vector<double>, 2> border_parameters;  ///< on those edges, one per parameter
};

/// Half-way between the borders, moved a little so that it runs from `first` to `last`.
MiddleCurve draw_middle(const std::array<BorderPath, 2>& borders, const Station& from, const Station& to,
                        Vec3 first, Vec3 last);

/// A move of an end of a curve, which fades out along it. Curves that are near each other at their common end
/// stay so: each moves by what depends on the place alone.
struct EndMove {
  Vec3 from, by;
  double radius = 1;  ///< what is further away stays

  Vec3 operator()(Vec3 point) const;
};

/// The curve with its ends moved; it keeps its parameters, and a line stays one.
Handle(Geom_Curve) move_ends(const GeomAdaptor_Curve& curve, const EndMove& first, const EndMove& last);

}  // namespace aeroloom::cad
