#include "cad/repair/border_chains.hpp"

#include "cad/model/to_vec.hpp"
#include "cad/repair/plane_loops.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Ax3.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {
namespace {

/// Of an edge; chosen, not measured.
constexpr int chain_samples = 32;

TopoDS_Vertex first_of(const TopoDS_Edge& edge) {
  return TopExp::FirstVertex(edge, true);
}
TopoDS_Vertex last_of(const TopoDS_Edge& edge) {
  return TopExp::LastVertex(edge, true);
}

/// Points along an edge in its direction.
std::vector<gp_Pnt> points_of(const TopoDS_Edge& edge) {
  const BRepAdaptor_Curve curve(edge);
  const double first = curve.FirstParameter(), last = curve.LastParameter();
  std::vector<gp_Pnt> points;
  for (int i = 0; i <= chain_samples; ++i)
    points.push_back(curve.Value(first + (last - first) * i / chain_samples));
  if (edge.Orientation() == TopAbs_REVERSED) std::reverse(points.begin(), points.end());
  return points;
}

/// Builds the faces of one chain.
class ChainFiller {
public:
  ChainFiller(const BorderChain& chain, const AxisPlane& plane, const FillLimits& limits)
      : _edges(chain.edges), _plane(plane), _limits(limits), _group(chain.edges.size() + 1, 0) {
    for (std::size_t i = 0; i < _edges.size(); ++i) _group[i + 1] = _group[i] + (is_steep(_edges[i]) ? 0 : 1);
    if (_group.back() == 0) stand_alone();
    for (int g = 0; g <= _group.back(); ++g) _feet.push_back(make_foot(g));
  }

  ChainFilling fill() {
    measure();
    for (std::size_t i = 0; i < _edges.size();) {
      if (_group[i] == _group[i + 1]) {
        ++i;
        continue;
      }
      const std::size_t end = end_of_run(i);
      if (!add_face(i, end)) {
        _filling.faces.clear();
        _filling.is_wide = true;
        return _filling;
      }
      i = end;
    }
    return _filling;
  }

private:
  /// A vertex on the plane below a group of vertices that steep edges join, and the edge up to the lowest.
  struct Foot {
    TopoDS_Vertex vertex;
    TopoDS_Edge upright;     ///< null where the vertex is one of the group
    std::size_t lowest = 0;  ///< of the group, a number in the chain
  };

  TopoDS_Vertex node(std::size_t i) const {
    return i == 0 ? first_of(_edges.front()) : last_of(_edges[i - 1]);
  }

  bool is_steep(const TopoDS_Edge& edge) const {
    const std::vector<gp_Pnt> points = points_of(edge);
    const gp_Pnt foot = _plane.foot(points.front());
    return std::ranges::all_of(
        points, [&](const gp_Pnt& point) { return _plane.foot(point).Distance(foot) <= _limits.reach; });
  }

  /// A spike of steep edges alone: each of them counts.
  void stand_alone() {
    for (std::size_t i = 0; i < _group.size(); ++i) _group[i] = static_cast<int>(i);
  }

  Foot make_foot(int group) const {
    if (group == _group.front()) return {node(0), {}, 0};
    if (group == _group.back()) return {node(_edges.size()), {}, _edges.size()};
    Foot foot;
    double least = -1;
    for (std::size_t i = 0; i < _group.size(); ++i) {
      if (_group[i] != group) continue;
      const double height = std::abs(_plane.height(BRep_Tool::Pnt(node(i))));
      if (least < 0 || height < least) least = height, foot.lowest = i;
    }
    const TopoDS_Vertex lowest = node(foot.lowest);
    BRep_Builder builder;
    builder.MakeVertex(foot.vertex, _plane.foot(BRep_Tool::Pnt(lowest)), tolerances::library_length);
    foot.upright = BRepBuilderAPI_MakeEdge(foot.vertex, lowest).Edge();
    return foot;
  }

  /// Edges from a foot up to a vertex of its group, in order.
  std::vector<TopoDS_Edge> way_up(const Foot& foot, std::size_t to) const {
    std::vector<TopoDS_Edge> way;
    if (!foot.upright.IsNull()) way.push_back(foot.upright);
    for (std::size_t i = foot.lowest; i < to; ++i) way.push_back(_edges[i]);
    for (std::size_t i = foot.lowest; i > to; --i) way.push_back(TopoDS::Edge(_edges[i - 1].Reversed()));
    return way;
  }

  static std::vector<TopoDS_Edge> reversed(std::vector<TopoDS_Edge> way) {
    std::reverse(way.begin(), way.end());
    for (TopoDS_Edge& edge : way) edge.Reverse();
    return way;
  }

  void measure() {
    for (const TopoDS_Edge& edge : _edges) {
      _filling.length += GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
      for (const gp_Pnt& point : points_of(edge)) {
        const double height = std::abs(_plane.height(point));
        if (height > _filling.width) _filling.width = height, _filling.where = to_vec(point);
      }
    }
  }

  /// Whether the feet of edges run forward along a straight line.
  bool is_straight(std::size_t begin, std::size_t end) const {
    const gp_Pnt from = _plane.foot(BRep_Tool::Pnt(node(begin))), to = _plane.foot(BRep_Tool::Pnt(node(end)));
    const double length = from.Distance(to);
    if (length <= _limits.straight) return false;
    const gp_Vec along = gp_Vec(from, to) / length;
    double before = 0;
    for (std::size_t i = begin; i < end; ++i) {
      for (const gp_Pnt& point : points_of(_edges[i])) {
        const gp_Vec way(from, _plane.foot(point));
        const double at = way.Dot(along);
        if ((way - at * along).Magnitude() > _limits.straight || at < before - _limits.straight) return false;
        before = at;
      }
    }
    return true;
  }

  std::size_t end_of_run(std::size_t begin) const {
    std::size_t end = begin + 1;
    const auto goes_on = [&] {
      return end < _edges.size() && _group[end] != _group[end + 1] && _group[end] != _group[end - 1] &&
             is_straight(begin, end + 1);
    };
    while (goes_on()) ++end;
    return end;
  }

  /// False if the face would be too wide.
  bool add_face(std::size_t begin, std::size_t end) {
    const Foot &left = _feet[_group[begin]], &right = _feet[_group[end]];
    std::vector<TopoDS_Edge> loop = way_up(left, begin);
    loop.insert(loop.end(), _edges.begin() + static_cast<std::ptrdiff_t>(begin),
                _edges.begin() + static_cast<std::ptrdiff_t>(end));
    const std::vector<TopoDS_Edge> down = reversed(way_up(right, end));
    loop.insert(loop.end(), down.begin(), down.end());
    if (is_straight(begin, end)) {
      const TopoDS_Edge chord = BRepBuilderAPI_MakeEdge(left.vertex, right.vertex).Edge();
      loop.push_back(TopoDS::Edge(chord.Reversed()));
      _filling.faces.push_back(make_planar(loop, left.vertex, right.vertex));
      return true;
    }
    if (_filling.width > _limits.widest) return false;
    for (std::size_t i = begin; i < end; ++i)
      _filling.faces.push_back(make_ruled(loop, _edges[i], left.vertex, right.vertex));
    return !_filling.faces.back().IsNull();
  }

  static TopoDS_Wire wire_of(const std::vector<TopoDS_Edge>& loop) {
    TopoDS_Wire wire;
    BRep_Builder builder;
    builder.MakeWire(wire);
    for (const TopoDS_Edge& edge : loop) builder.Add(wire, edge);
    wire.Closed(true);
    return wire;
  }

  gp_Dir normal() const {
    gp_XYZ coordinates(0, 0, 0);
    coordinates.SetCoord(_plane.axis + 1, 1);
    return gp_Dir(coordinates);
  }

  TopoDS_Face make_planar(const std::vector<TopoDS_Edge>& loop, const TopoDS_Vertex& left,
                          const TopoDS_Vertex& right) const {
    const gp_Pnt from = BRep_Tool::Pnt(left);
    const gp_Dir along(gp_Vec(from, BRep_Tool::Pnt(right)));
    return make_plane_face(gp_Pln(gp_Ax3(from, along.Crossed(normal()), along)), wire_of(loop), {});
  }

  /// Lines along the normal, from the edge to its feet. `loop` lacks these.
  TopoDS_Face make_ruled(std::vector<TopoDS_Edge> loop, const TopoDS_Edge& edge, const TopoDS_Vertex& left,
                         const TopoDS_Vertex& right) const {
    double first, last;
    const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
    const opencascade::handle<Geom_Curve> curve = BRep_Tool::Curve(forward, first, last),
                                          below = curve_on_plane(forward, _plane, first, last);
    if (curve.IsNull() || below.IsNull()) return {};
    const bool along = edge.Orientation() != TopAbs_REVERSED;
    const TopoDS_Vertex from = along ? left : right, to = along ? right : left;
    BRep_Builder builder;
    TopoDS_Edge low;
    builder.MakeEdge(low, below, tolerances::library_length);
    for (const auto& [vertex, at] : {std::pair(from, first), std::pair(to, last)})
      builder.UpdateVertex(vertex,
                           BRep_Tool::Tolerance(vertex) + BRep_Tool::Pnt(vertex).Distance(below->Value(at)));
    builder.Add(low, from.Oriented(TopAbs_FORWARD));
    builder.Add(low, to.Oriented(TopAbs_REVERSED));
    builder.Range(low, first, last);
    loop.push_back(along ? TopoDS::Edge(low.Reversed()) : low);
    // The surface's parameters run along the curve and the normal; the loop runs up, along the edge, and
    // down.
    const bool inverse = along == (_plane.height(curve->Value(0.5 * (first + last))) > 0);
    TopoDS_Face face;
    builder.MakeFace(face, new Geom_SurfaceOfLinearExtrusion(curve, normal()), tolerances::library_length);
    const TopoDS_Wire wire = wire_of(loop);
    builder.Add(face, inverse ? TopoDS::Wire(wire.Reversed()) : wire);
    for (const TopoDS_Edge& each : loop) ShapeFix_Edge().FixAddPCurve(each, face, false);
    return face;
  }

  std::vector<TopoDS_Edge> _edges;
  AxisPlane _plane;
  FillLimits _limits;
  std::vector<int> _group;  ///< by vertex: those that steep edges join have one
  std::vector<Foot> _feet;  ///< by group
  ChainFilling _filling;
};

}  // namespace

std::optional<std::vector<BorderChain>> find_chains(const std::vector<TopoDS_Edge>& edges,
                                                    const TopTools_IndexedMapOfShape& feet, Vec3& branch) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopTools_IndexedMapOfShape numbers;
  for (const TopoDS_Edge& each : edges) {
    const TopoDS_Edge edge = TopoDS::Edge(each.Oriented(TopAbs_FORWARD));
    numbers.Add(edge);
    TopExp::MapShapesAndAncestors(edge, TopAbs_VERTEX, TopAbs_EDGE, users);
  }
  for (int i = 1; i <= users.Extent(); ++i) {
    if (feet.Contains(users.FindKey(i)) || users(i).Extent() == 2) continue;
    branch = to_vec(BRep_Tool::Pnt(TopoDS::Vertex(users.FindKey(i))));
    return std::nullopt;
  }
  std::vector<char> used(edges.size(), 0);
  std::vector<BorderChain> chains;
  const auto follow = [&](TopoDS_Edge edge, bool on_plane) {
    BorderChain chain;
    chain.on_plane = on_plane;
    const TopoDS_Vertex begin = first_of(edge);
    while (true) {
      used[numbers.FindIndex(edge) - 1] = 1;
      chain.edges.push_back(edge);
      const TopoDS_Vertex end = last_of(edge);
      if (feet.Contains(end) || end.IsSame(begin)) break;
      for (const TopoDS_Shape& next : users.FindFromKey(end)) {
        if (used[numbers.FindIndex(next) - 1]) continue;
        edge = TopoDS::Edge(next.Oriented(TopAbs_FORWARD));
        if (!first_of(edge).IsSame(end)) edge.Reverse();
        break;
      }
      if (used[numbers.FindIndex(edge) - 1]) break;
    }
    chains.push_back(std::move(chain));
  };
  for (const bool on_plane : {true, false}) {
    for (int i = 1; i <= numbers.Extent(); ++i) {
      if (used[i - 1]) continue;
      const TopoDS_Edge edge = TopoDS::Edge(numbers(i));
      if (!on_plane || feet.Contains(first_of(edge)))
        follow(edge, on_plane);
      else if (feet.Contains(last_of(edge)))
        follow(TopoDS::Edge(edge.Reversed()), on_plane);
    }
  }
  return chains;
}

ChainFilling fill_to_plane(const BorderChain& chain, const AxisPlane& plane, const FillLimits& limits) {
  return ChainFiller(chain, plane, limits).fill();
}

}  // namespace aeroloom::cad
