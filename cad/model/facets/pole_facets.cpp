#include "cad/model/facets/facet_refinement.hpp"
#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace aeroloom::cad {
namespace {

using Triangle = std::array<std::int32_t, 3>;

/// A facet between the pole and a side of the ring around it.
struct FanFacet {
  std::int32_t from, to;  ///< the side, counter-clockwise seen from the pole
  double at;              ///< its middle along the pole's line, 0 to 1
};

class PoleSpreader {
public:
  PoleSpreader(const Model& model, FaceId id, std::size_t line, Facets& facets)
      : _model(model),
        _id(id),
        _line(facets.boundary[line]),
        _facets(facets),
        _on_pole(facets.points.size(), 0) {
    for (const std::int32_t node : _line.nodes) _on_pole[node] = 1;
    _origin = facets.uv[_line.nodes.front()];
    _along = facets.uv[_line.nodes.back()] - _origin;
  }

  void spread() {
    std::vector<FanFacet> fan = collect_fan();
    if (fan.empty() || !(norm(_along) > 0)) return;
    std::sort(fan.begin(), fan.end(), [](const FanFacet& a, const FanFacet& b) { return a.at < b.at; });
    // Counter-clockwise round the pole is with its line or against it, as the face lies on one side of it or
    // the other.
    const bool with_line = place(fan.front().to) > place(fan.front().from);
    for (std::size_t i = 1; i < fan.size(); ++i) {
      const bool chained = with_line ? fan[i - 1].to == fan[i].from : fan[i - 1].from == fan[i].to;
      if (!chained || !(fan[i].at > fan[i - 1].at)) return;
    }
    if (fan.front().at <= 0 || fan.back().at >= 1) return;
    build(fan, with_line);
  }

private:
  double place(std::int32_t node) const {
    return dot(_facets.uv[node] - _origin, _along) / dot(_along, _along);
  }

  std::vector<FanFacet> collect_fan() const {
    std::vector<FanFacet> fan;
    for (const Triangle& t : _facets.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t from = t[(i + 1) % 3], to = t[(i + 2) % 3];
        if (_on_pole[t[i]] && !_on_pole[from] && !_on_pole[to])
          fan.push_back({from, to, 0.5 * (place(from) + place(to))});
      }
    }
    return fan;
  }

  void build(const std::vector<FanFacet>& fan, bool with_line) {
    const Edge& edge = _model.edge(_line.use.edge);
    Facets::BoundaryLine line{_line.use, {_line.nodes.front()}, {_line.parameters.front()}};
    std::vector<Vec2> uv;
    for (const FanFacet& facet : fan) {
      line.nodes.push_back(static_cast<std::int32_t>(_facets.points.size() + uv.size()));
      line.parameters.push_back(edge.first_parameter +
                                facet.at * (edge.last_parameter - edge.first_parameter));
      uv.push_back(_model.edge_uv(_id, _line.use, line.parameters.back()));
    }
    line.nodes.push_back(_line.nodes.back());
    line.parameters.push_back(_line.parameters.back());
    const auto uv_of = [&](std::int32_t node) {
      const auto old = static_cast<std::int32_t>(_facets.uv.size());
      return node < old ? _facets.uv[node] : uv[node - old];
    };
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i <= fan.size(); ++i) {
      const std::int32_t before = line.nodes[i], after = line.nodes[i + 1];
      const std::int32_t ring = i < fan.size() ? (with_line ? fan[i].from : fan[i].to)
                                               : (with_line ? fan.back().to : fan.back().from);
      triangles.push_back(with_line ? Triangle{after, before, ring} : Triangle{before, after, ring});
      if (i < fan.size()) triangles.push_back({after, fan[i].from, fan[i].to});
    }
    for (const Triangle& t : triangles) {
      if (orient2d(uv_of(t[0]), uv_of(t[1]), uv_of(t[2])) <= 0) return;
    }
    replace(triangles, uv, std::move(line));
  }

  void replace(const std::vector<Triangle>& triangles, const std::vector<Vec2>& uv,
               Facets::BoundaryLine line) {
    const Vec3 pole = _facets.points[_line.nodes.front()];
    std::erase_if(_facets.triangles, [&](const Triangle& t) {
      return std::any_of(t.begin(), t.end(), [&](std::int32_t node) { return _on_pole[node]; });
    });
    _facets.triangles.insert(_facets.triangles.end(), triangles.begin(), triangles.end());
    _facets.uv.insert(_facets.uv.end(), uv.begin(), uv.end());
    _facets.points.insert(_facets.points.end(), uv.size(), pole);
    _line = std::move(line);
  }

  const Model& _model;
  FaceId _id;
  Facets::BoundaryLine& _line;
  Facets& _facets;
  std::vector<char> _on_pole;
  Vec2 _origin, _along;
};

}  // namespace

void spread_poles(const Model& model, FaceId id, Facets& facets) {
  for (std::size_t line = 0; line < facets.boundary.size(); ++line) {
    const auto& nodes = facets.boundary[line].nodes;
    // A line that has vertices already would leave them behind.
    if (model.edge(facets.boundary[line].use.edge).degenerate && nodes.size() == 2) {
      PoleSpreader(model, id, line, facets).spread();
    }
  }
}

}  // namespace aeroloom::cad
