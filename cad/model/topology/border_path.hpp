/// A chain of edges measured by its length. Seen by this folder only.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"

#include <vector>

namespace aeroloom::cad {

/// Places along one long border of a strip, by the length passed.
class BorderPath {
public:
  /// A place on an edge of the chain.
  struct ChainPlace {
    std::size_t edge = 0;  ///< index in the chain
    double parameter = 0;  ///< on the edge's curve
    Vec3 point;
  };

  BorderPath(const Model& model, const std::vector<BorderEdge>& chain);

  double length() const { return _samples.back().passed; }
  /// Where length `passed` ends, on the chain's edge `edge`.
  ChainPlace at(double passed, std::size_t edge) const;
  ChainPlace at(double passed) const;
  /// The place nearest to a point, on the curves themselves: segments between samples may miss them by more
  /// than a strip is wide.
  ChainPlace nearest(Vec3 point) const;
  /// The length passed at a parameter of the chain's edge `edge`.
  double passed_at(std::size_t edge, double parameter) const;
  /// The length passed at the ends of each edge: one more than there are edges.
  const std::vector<double>& joints() const { return _joints; }
  /// The vertices there.
  const std::vector<VertexId>& vertices() const { return _vertices; }

private:
  struct Sample {
    double passed, parameter;
    Vec3 point;
  };
  const Model* _model;
  const std::vector<BorderEdge>* _chain;  // outlives the path
  std::vector<Sample> _samples;           // edge by edge, ends of edges twice
  std::vector<double> _joints;
  std::vector<VertexId> _vertices;
};

}  // namespace aeroloom::cad
