/// Finds parameters of points on faces and edges.
#pragma once

#include "cad/model/model.hpp"

#include <optional>
#include <vector>

namespace aeroloom::cad {

/// Projects points from samples of a face or an edge. Samples are made when first needed, and kept. Results
/// depend on the model and the arguments alone.
class PointLocator {
public:
  /// The model must outlive the locator.
  explicit PointLocator(const Model& model);
  const Model& model() const { return _model; }

  /// Parameters at which the face passes within `tolerance` of the point. Empty if none are found or the face
  /// cannot be sampled.
  std::optional<Vec2> on_face(FaceId id, Vec3 point, double tolerance);
  /// The parameter at which the edge passes within `tolerance` of the point.
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

/// The parameter of the nearest point of the edge, by Gauss-Newton steps from `guess`. Stays within the
/// edge's interval, also on closed edges.
double project_on_edge(const Model& model, EdgeId id, Vec3 point, double guess);

/// The point with the coordinate of an exact plane (Model::is_exact_plane); of other faces the point itself.
Vec3 onto_exact_plane(const Model& model, FaceId face, Vec3 point);

struct EdgeFoot {
  double parameter;
  Vec3 point;
  double away;  ///< distance between the two points
};

/// The nearest point of the edge around `guess`, by a few Newton steps, none of which increases the distance.
/// Not for degenerate edges.
EdgeFoot foot_on_edge(const Model& model, EdgeId edge, Vec3 point, double guess);

}  // namespace aeroloom::cad
