#include "cad/model/facets/facet_refinement.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/topology/closed_edges_data.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The value at `at` of the line through pairs of values, whose `from` ascend or descend.
double interpolate(const std::vector<double>& from, const std::vector<double>& to, double at) {
  const bool ascends = from.back() > from.front();
  const auto above = std::lower_bound(from.begin() + 1, from.end() - 1, at, [&](double value, double wanted) {
    return ascends ? value < wanted : value > wanted;
  });
  const std::size_t i = static_cast<std::size_t>(above - from.begin());
  if (at == from[i]) return to[i];
  const double fraction = std::clamp((at - from[i - 1]) / (from[i] - from[i - 1]), 0.0, 1.0);
  return (1 - fraction) * to[i - 1] + fraction * to[i];
}

/// Facets of one face on their way from the base model.
class FacetClosing {
public:
  FacetClosing(const ClosedEdges& closed, const Model& model, FaceId id, Facets facets)
      : _closed(closed), _model(model), _id(id), _facets(std::move(facets)) {}

  Facets run() {
    _lines = std::move(_facets.boundary);
    _facets.boundary.clear();
    for (Facets::BoundaryLine& line : _lines) divide(line);
    geometry::DisjointSets<std::int32_t> nodes(_facets.points.size());
    for (const Facets::BoundaryLine& line : _lines) {
      if (fate(line).kind != BaseEdgeFate::Kind::collapsed) continue;
      for (const std::int32_t node : line.nodes) nodes.unite(line.nodes.front(), node);
    }
    for (const Facets::BoundaryLine& line : _lines) follow(line);
    for (auto& line : _facets.boundary) {
      for (std::int32_t& node : line.nodes) node = nodes.root(node);
    }
    for (auto& triangle : _facets.triangles) {
      for (std::int32_t& node : triangle) node = nodes.root(node);
    }
    std::erase_if(_facets.triangles,
                  [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    place_boundary();
    drop_unused_points(_facets);
    return std::move(_facets);
  }

private:
  const BaseEdgeFate& fate(const Facets::BoundaryLine& line) const { return _closed.fates[line.use.edge]; }
  FaceId base_face() const { return _closed.base_faces[_id]; }

  /// Gives the line a node wherever its edge is divided.
  void divide(Facets::BoundaryLine& line) {
    const BaseEdgeFate& what = fate(line);
    for (std::size_t i = 1; i < what.pieces.size(); ++i) {
      const double t = _closed.piece(what.pieces[i], base_face()).low();
      const auto above = std::lower_bound(line.parameters.begin() + 1, line.parameters.end() - 1, t);
      const auto k = above - line.parameters.begin();
      if (*above == t) continue;
      const std::int32_t a = line.nodes[k - 1], b = line.nodes[k];
      const auto node = static_cast<std::int32_t>(_facets.points.size());
      _facets.points.push_back(_closed.base.edge_point(line.use.edge, t));
      _facets.uv.push_back(_closed.base.edge_uv(base_face(), line.use, t));
      divide_triangle(a, b, node);
      line.parameters.insert(above, t);
      line.nodes.insert(line.nodes.begin() + k, node);
    }
  }

  void divide_triangle(std::int32_t a, std::int32_t b, std::int32_t node) {
    for (auto& t : _facets.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t from = t[i], to = t[(i + 1) % 3], apex = t[(i + 2) % 3];
        if (std::minmax(from, to) != std::minmax(a, b)) continue;
        t = {from, node, apex};
        _facets.triangles.push_back({node, to, apex});
        return;
      }
    }
  }

  /// Lines of the edges as they are now.
  void follow(const Facets::BoundaryLine& line) {
    const BaseEdgeFate& what = fate(line);
    if (what.kind == BaseEdgeFate::Kind::kept) {
      _facets.boundary.push_back(line);
      _facets.boundary.back().use.edge = what.edge;
    }
    for (const EdgeId id : what.pieces) {
      const BorderPiece& piece = _closed.piece(id, base_face());
      const auto [low, high] = std::minmax(piece.base.front(), piece.base.back());
      Facets::BoundaryLine own;
      own.use = {id, 0, line.use.reversed == piece.is_along()};
      for (std::size_t i = 0; i < line.nodes.size(); ++i) {
        if (line.parameters[i] < low || line.parameters[i] > high) continue;
        own.nodes.push_back(line.nodes[i]);
        own.parameters.push_back(piece.from_base(line.parameters[i]));
      }
      if (!piece.is_along()) {
        std::reverse(own.nodes.begin(), own.nodes.end());
        std::reverse(own.parameters.begin(), own.parameters.end());
      }
      _facets.boundary.push_back(std::move(own));
    }
  }

  void place_boundary() {
    for (const auto& line : _facets.boundary) {
      if (!_closed.moved[line.use.edge]) continue;
      for (std::size_t i = 0; i < line.nodes.size(); ++i) {
        _facets.points[line.nodes[i]] = _model.edge_point(line.use.edge, line.parameters[i]);
        _facets.uv[line.nodes[i]] = _model.edge_uv(_id, line.use, line.parameters[i]);
      }
    }
  }

  const ClosedEdges& _closed;
  const Model& _model;
  FaceId _id;
  Facets _facets;
  std::vector<Facets::BoundaryLine> _lines;  // of the base model's edges
};

}  // namespace

double BorderPiece::to_base(double parameter) const {
  return interpolate(own, base, parameter);
}

double BorderPiece::from_base(double parameter) const {
  return interpolate(base, own, parameter);
}

const BorderPiece& ClosedEdges::piece(EdgeId id, FaceId base_face) const {
  const auto& pieces = closed.at(id - (base_edges.size() - closed.size()));
  return pieces[0].face == base_face ? pieces[0] : pieces[1];
}

Vec2 ClosedEdges::base_uv(FaceId id, const Coedge& use, double parameter) const {
  const FaceId face = base_faces[id];
  if (base_edges[use.edge] != no_entity)
    return base.edge_uv(face, {base_edges[use.edge], use.use, use.reversed}, parameter);
  const BorderPiece& there = piece(use.edge, face);
  return base.edge_uv(face, there.use, there.to_base(parameter));
}

Facets ClosedEdges::facets(const Model& model, FaceId id, double deflection, double angle) const {
  const FaceId face = base_faces[id];
  Facets facets = base.facets(face, deflection, angle);
  const auto unchanged = [&](const Facets::BoundaryLine& line) {
    const BaseEdgeFate& fate = fates[line.use.edge];
    return fate.kind == BaseEdgeFate::Kind::kept && !moved[fate.edge];
  };
  if (std::ranges::all_of(facets.boundary, unchanged)) {
    for (auto& line : facets.boundary) line.use.edge = fates[line.use.edge].edge;
    return facets;
  }
  return FacetClosing(*this, model, id, std::move(facets)).run();
}

}  // namespace aeroloom::cad
