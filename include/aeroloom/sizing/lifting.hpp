/// Lifting bodies of a model: wings, tails, flaps, slats, nacelles; where they begin and end, and how long
/// they are.
///
/// A trailing edge is a blunt strip, or a sharp edge of the CAD, behind which the body ends against the flow.
/// From each of its places a plane along the flow cuts the skin in front of it: the point of the section that
/// is farthest away is the leading edge, its distance the local chord. What is found depends on the geometry
/// and the direction of the flow alone.
#pragma once

#include "aeroloom/sizing/model_sampler.hpp"

#include <array>
#include <set>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// A place along the span.
struct LiftingStation {
  geometry::Vec3 trailing, leading;
  double chord = 0;      ///< the local chord
  double thickness = 0;  ///< of the section, about
};

/// A line along an edge, with the local chord at each of its points.
struct EdgeLine {
  std::vector<geometry::Vec3> points;
  std::vector<double> chords;
};

/// What lies before one strip or sharp edge of the CAD.
struct LiftingElement {
  cad::FaceId strip = cad::no_entity;    ///< the blunt trailing edge
  cad::EdgeId edge = cad::no_entity;     ///< the sharp one
  std::vector<LiftingStation> stations;  ///< from one end to the other, two at least
  std::vector<EdgeLine> leading;  ///< in parts where sections change abruptly; may reach beyond stations
  EdgeLine trailing;              ///< along the sharp edge, or a border of the strip
  std::vector<geometry::Vec3>
      opposite;                ///< of a strip: by point of `trailing`, the nearest of its other border
  std::set<cad::EdgeId> ends;  ///< where the skin meets other faces: roots and tips
  std::array<std::set<cad::VertexId>, 2> end_vertices;  ///< of the trailing edge
};

struct LiftingBodies {
  std::vector<LiftingElement> elements;  ///< strips by face, then sharp edges
  double reference_chord = 0;  ///< mean aerodynamic chord of the largest: the integral of c^2 over that of c
  double semispan = 0;  ///< half of what the body extends along the span of the largest; of half models all
};

/// Finds them. `flow`: a unit vector. `named`: patterns of the names of faces or patches; only trailing edges
/// of these faces are taken, of all where there are none. For the model before any of its faces were joined.
/// The same on every rank; collective. Throws parallel::CollectiveError where the CAD library fails.
LiftingBodies find_lifting_bodies(const ModelSampler& sampler, geometry::Vec3 flow,
                                  const std::vector<std::string>& named = {});

}  // namespace aeroloom::sizing
