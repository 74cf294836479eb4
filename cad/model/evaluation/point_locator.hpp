/// Parameters of points that lie on a face or a curve, found without a guess.
#pragma once

#include "cad/model/model.hpp"

#include <optional>
#include <vector>

namespace aeroloom::cad {

/// Starts projections from samples of the faces and curves asked for, which it makes when first needed and
/// keeps. What it finds is a function of the model and the arguments alone.
class PointLocator {
public:
  /// The model must outlive the locator.
  explicit PointLocator(const Model& model);
  const Model& model() const { return _model; }

  /// Parameters at which the face passes within `tolerance` of the point; nothing where none are found, or
  /// the face cannot be sampled.
  std::optional<Vec2> on_face(FaceId id, Vec3 point, double tolerance);
  /// The parameter at which the curve passes within `tolerance` of the point.
  std::optional<double> on_edge(EdgeId id, Vec3 point, double tolerance);

private:
  struct FaceSamples {
    bool made = false;
    std::vector<Vec3> points;
    std::vector<Vec2> uv;
  };
  struct EdgeSamples {
    std::vector<Vec3> points;
    std::vector<double> parameters;
  };
  void sample(FaceId id, FaceSamples& samples) const;
  void sample(EdgeId id, EdgeSamples& samples) const;

  const Model& _model;
  std::vector<FaceSamples> _faces;
  std::vector<EdgeSamples> _edges;
};

/// The parameter of the curve's point nearest to `point`, by Gauss and Newton's method from `guess`; stays
/// within the edge's interval, on closed edges too.
double project_on_edge(const Model& model, EdgeId id, Vec3 point, double guess);

struct EdgeFoot {
  double parameter;
  Vec3 point;
  double away;  ///< distance of the point from it
};

/// The nearest place of the edge around the parameter `guess`, by Newton's method with steps that never lead
/// further away; within the edge's ends. Not for degenerate edges.
EdgeFoot foot_on_edge(const Model& model, EdgeId edge, Vec3 point, double guess);

}  // namespace aeroloom::cad
