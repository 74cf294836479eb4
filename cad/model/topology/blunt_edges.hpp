/// Blunt edges: strips between two faces that enclose a body at a sharp angle, as wings end in them.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// An edge on the way along one long border of a strip.
struct BorderEdge {
  Coedge strip_use;              ///< as the strip's loop passes it
  bool against = false;          ///< the border runs against the edge's parameter
  FaceId neighbour = no_entity;  ///< the face across it
};

/// A place along a strip.
struct BluntStation {
  Vec3 place;        ///< half-way between the borders
  Vec3 along, into;  ///< unit: along the strip; from it into what its neighbours enclose
  double width = 0;  ///< the nearest distance from one border to the other
};

/// A strip with two long borders, which run side by side from its start to its end.
struct BluntEdge {
  FaceId face = no_entity;
  std::array<std::vector<BorderEdge>, 2> borders;  ///< each in its order from start to end
  std::array<std::vector<EdgeId>, 2> ends;  ///< edges across at start and end; none where the borders meet
  double length = 0;                        ///< of the longer border
  double widest = 0;                        ///< largest of the nearest distances from one border to the other
  double narrowest = 0;                     ///< the least of them, apart from ends where the borders meet
  Vec3 place;                               ///< in the middle
  std::vector<BluntStation> stations = {};  ///< from start to end; where the shape is that of a blunt edge
};

/// The verdict on a narrow face.
struct BluntEdgeFinding {
  enum class Kind {
    closable,
    smooth,   ///< goes on smoothly in a neighbour
    refused,  ///< a strip, for `reason` none that can be closed
    wide,     ///< could be closed, but is wider than asked for
    other,    ///< no strip
  };
  Kind kind = Kind::other;
  BluntEdge edge;
  std::string reason;
  double limit = 0;  ///< of the width that may be closed; where the shape is that of a blunt edge
};

/// Looks at one face. `width`: the widest that may be closed; 0: the fractions below.
BluntEdgeFinding examine_blunt_edge(const Model& model, FaceId face, double width);

/// Without a width asked for, strips are closed up to this fraction of their length: trailing edges have at
/// most one or two hundredths of the chord, and wing tips ten. And up to this fraction of both neighbours'
/// breadth (area over border; skins may be cut along the span): bars are as thick as they are broad.
inline constexpr double blunt_edge_length_fraction = 0.03, blunt_edge_breadth_fraction = 0.1;

/// The model with these strips closed; their faces vanish, the others keep their order. serialise() gives the
/// closed model. Throws CadError naming the face where what is left would be no model: borders that
/// another strip closes, ends that become one vertex.
Model close_blunt_edges(const Model& model, const std::vector<BluntEdge>& strips);

}  // namespace aeroloom::cad
