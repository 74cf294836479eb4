/// Blunt edges, such as trailing edges: strips between two faces that enclose a body at a sharp angle. They
/// are examined here and can be closed.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// An edge of one long border of a strip.
struct BorderEdge {
  Coedge strip_use;              ///< coedge in the loop of the strip
  bool against = false;          ///< the border runs against the edge's parameter
  FaceId neighbour = no_entity;  ///< the face on the other side
};

/// A cross-section of a strip.
struct BluntStation {
  Vec3 place;        ///< in the middle between the borders
  Vec3 along, into;  ///< unit; along the strip, and into the body behind it
  double width = 0;  ///< smallest distance between the borders
};

/// A strip with two long borders that run side by side from its start to its end.
struct BluntEdge {
  FaceId face = no_entity;
  std::array<std::vector<BorderEdge>, 2> borders;  ///< each ordered from start to end
  std::array<std::vector<EdgeId>, 2> ends;         ///< edges at start and end; empty where the borders meet
  double length = 0;                               ///< of the longer border
  double widest = 0;                               ///< largest distance from one border to the other
  double narrowest = 0;                            ///< smallest distance, without ends where the borders meet
  Vec3 place;                                      ///< in the middle of the strip
  std::vector<BluntStation> stations = {};  ///< from start to end; only if the shape is that of a blunt edge
};

/// The result of examining a narrow face.
struct BluntEdgeFinding {
  enum class Kind {
    closable,
    smooth,   ///< continues smoothly in a neighbour
    refused,  ///< a strip that cannot be closed, for `reason`
    wide,     ///< could be closed, but is wider than the limit
    other,    ///< not a strip
  };
  Kind kind = Kind::other;
  BluntEdge edge;
  std::string reason;
  double limit = 0;  ///< width up to which it may be closed; only if the shape is that of a blunt edge
};

/// Examines one face. `width` is the limit for closing; 0 takes the fractions below.
BluntEdgeFinding examine_blunt_edge(const Model& model, FaceId face, double width);

/// Default limits for closing: a fraction of the strip's length, and a fraction of the breadth of both
/// neighbours (area over border). Trailing edges have one or two hundredths of the chord, wing tips ten. Bars
/// are as thick as they are broad.
inline constexpr double blunt_edge_length_fraction = 0.03, blunt_edge_breadth_fraction = 0.1;

/// The model with these strips closed: virtual topology over an unchanged model. The two long borders of a
/// strip become one edge in their middle, its short ends vertices. Faces at a short end lose it; other edges
/// that ended there are moved to the vertex. Surfaces do not change, so near the closed edge faces end up to
/// half the strip's width beside their edges. The other faces keep their order. serialise() gives the closed
/// model.
/// Throws CadError that names the face if no valid model results, for example if another strip closes the
/// same border.
Model close_blunt_edges(const Model& model, const std::vector<BluntEdge>& strips);

}  // namespace aeroloom::cad
