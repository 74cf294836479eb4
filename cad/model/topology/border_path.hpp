/// A chain of edges, parametrised by its length. Internal to cad/model/.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// Points along one long border of a strip, by the length from its start.
class BorderPath {
public:
  /// A point on an edge of the chain.
  struct ChainPlace {
    std::size_t edge = 0;  ///< index in the chain
    double parameter = 0;  ///< on the edge's curve
    Vec3 point;
  };

  BorderPath(const Model& model, const std::vector<BorderEdge>& chain);

  double length() const { return _samples.back().passed; }
  /// The point at length `passed`. With `edge`, it lies on that edge of the chain.
  ChainPlace at(double passed, std::size_t edge) const;
  ChainPlace at(double passed) const;
  /// The nearest point of the chain. It is found on the curves, since segments between samples are not
  /// accurate enough for narrow strips.
  ChainPlace nearest(Vec3 point) const;
  /// The length at a parameter of the chain's edge `edge`.
  double passed_at(std::size_t edge, double parameter) const;
  /// The lengths at the ends of the edges, one more than there are edges.
  const std::vector<double>& joints() const { return _joints; }
  /// The vertices at these ends.
  const std::vector<VertexId>& vertices() const { return _vertices; }

private:
  struct Sample {
    double passed, parameter;
    Vec3 point;
  };
  const Model* _model;
  const std::vector<BorderEdge>* _chain;  // outlives the path
  std::vector<Sample> _samples;           // edge by edge; ends of edges occur twice
  std::vector<double> _joints;
  std::vector<VertexId> _vertices;
};

}  // namespace aeroloom::cad
