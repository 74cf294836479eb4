#include "cad/model/model_data.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

constexpr int axes = 3;

void add_point(Box& box, const gp_Pnt& p) {
  box.add(Vec3{p.X(), p.Y(), p.Z()});
}

/// The box of control points and tolerances: never too small.
Box loose_box(const TopoDS_Shape& shape) {
  Bnd_Box bounds;
  BRepBndLib::Add(shape, bounds, false);
  Box box;
  constexpr double everywhere = 1e300;  // finite, so that sums of it are
  if (bounds.IsVoid() || bounds.IsOpen())
    return {{-everywhere, -everywhere, -everywhere}, {everywhere, everywhere, everywhere}};
  bounds.Get(box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
  return box;
}

/// The largest value of a function of one variable near the best of its samples, by golden section.
template <class Function>
void refine(Function&& height, double low, double high) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  constexpr int steps = 40;  // 0.618^40: the interval has shrunk to 4e-9, its square is rounding at a maximum
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = height(a), at_b = height(b);
  for (int i = 0; i < steps; ++i) {
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a;
      a = high - golden * (high - low), at_a = height(a);
    } else {
      low = a, a = b, at_a = at_b;
      b = low + golden * (high - low), at_b = height(b);
    }
  }
}

/// Extremes of an edge: samples, then golden section around the best of them.
class EdgeExtremes {
public:
  explicit EdgeExtremes(const TopoDS_Edge& edge) : _curve(edge) {}

  void add_samples(Box& box) {
    // Between two knots a curve has few extremes; curves of thousands of knots have them closer together than
    // they bend. Chosen, not measured.
    constexpr int per_interval = 8, most_intervals = 200;
    _samples = per_interval * std::min(most_intervals, _curve.NbIntervals(GeomAbs_C2)) + per_interval;
    _first = _curve.FirstParameter(), _step = (_curve.LastParameter() - _first) / _samples;
    std::array<double, 2 * axes> farthest;
    farthest.fill(-std::numeric_limits<double>::max());
    for (int i = 0; i <= _samples; ++i) {
      const gp_Pnt p = _curve.Value(_first + i * _step);
      add_point(box, p);
      for (int side = 0; side < 2 * axes; ++side) {
        const double height = (side % 2 ? 1 : -1) * p.Coord(side / 2 + 1);
        if (height > farthest[side]) farthest[side] = height, _best[side] = i;
      }
    }
  }

  bool is_line() const { return _curve.GetType() == GeomAbs_Line; }

  void refine_samples(Box& box) const {
    for (int side = 0; side < 2 * axes; ++side) {
      const auto height = [&](double parameter) {
        const gp_Pnt p = _curve.Value(parameter);
        add_point(box, p);
        return (side % 2 ? 1 : -1) * p.Coord(side / 2 + 1);
      };
      refine(height, _first + std::max(0, _best[side] - 1) * _step,
             _first + std::min(_samples, _best[side] + 1) * _step);
    }
  }

private:
  BRepAdaptor_Curve _curve;
  int _samples = 0;
  double _first = 0, _step = 0;
  std::array<int, 2 * axes> _best{};
};

/// Only edges whose control points lie outside the samples of all can add to these.
void add_edge_extremes(Box& box, const TopTools_IndexedMapOfShape& edges) {
  std::vector<std::pair<int, EdgeExtremes>> curved;
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    EdgeExtremes extremes(edge);
    extremes.add_samples(box);
    if (!extremes.is_line()) curved.emplace_back(i, std::move(extremes));
  }
  for (const auto& [i, extremes] : curved) {
    if (!box.contains(loose_box(edges(i)))) extremes.refine_samples(box);
  }
}

/// Extremes inside a face: samples, then Newton's method for the point where the distance along a direction
/// falls again.
class FaceExtremes {
public:
  FaceExtremes(const TopoDS_Face& face, Box& box)
      : _box(box), _surface(face, false), _classifier(face, tolerances::on_loop) {
    BRepTools::UVBounds(face, _low.x, _high.x, _low.y, _high.y);
  }

  void add() {
    std::vector<Sample> grid;
    grid.reserve(std::size_t{samples + 1} * std::size_t{samples + 1});
    for (int i = 0; i <= samples; ++i) {
      for (int j = 0; j <= samples; ++j) {
        const Vec2 uv{_low.x + (_high.x - _low.x) * i / samples, _low.y + (_high.y - _low.y) * j / samples};
        grid.push_back({uv, _surface.Value(uv.x, uv.y)});
      }
    }
    // From the highest sample on the face; whether one is on it takes far longer to tell than how high it is.
    std::vector<std::int32_t> order(grid.size());
    for (int side = 0; side < 2 * axes; ++side) {
      const auto height = [&](std::int32_t i) {
        return (side % 2 ? 1 : -1) * grid[i].point.Coord(side / 2 + 1);
      };
      std::iota(order.begin(), order.end(), 0);
      std::ranges::sort(order, [&](std::int32_t a, std::int32_t b) {
        return height(a) != height(b) ? height(a) > height(b) : a < b;
      });
      const auto highest =
          std::find_if(order.begin(), order.end(), [&](std::int32_t i) { return lies_on_face(grid[i]); });
      if (highest != order.end()) climb(grid[*highest].uv, side / 2 + 1, side % 2 ? 1 : -1);
    }
  }

private:
  static constexpr int samples = 16;  // each way: Newton's method converges from one of them to each extreme
  static constexpr int newton_steps = 20;  // most end after few, at a step that leads no higher

  struct Sample {
    Vec2 uv;
    gp_Pnt point;
    std::optional<bool> on_face = {};  // when it was asked for
  };

  bool lies_on_face(Sample& sample) {
    if (!sample.on_face) sample.on_face = lies_on_face(sample.uv);
    return *sample.on_face;
  }
  bool lies_on_face(Vec2 uv) { return _classifier.Perform({uv.x, uv.y}) != TopAbs_OUT; }

  /// Ends at the border of the face at the latest: its edges were looked at on their own.
  void climb(Vec2 uv, int axis, double sign) {
    for (int step = 0; step < newton_steps; ++step) {
      gp_Pnt p;
      gp_Vec du, dv, duu, dvv, duv;
      _surface.D2(uv.x, uv.y, p, du, dv, duu, dvv, duv);
      add_point(_box, p);
      const double gu = sign * du.Coord(axis), gv = sign * dv.Coord(axis);
      const double a = sign * duu.Coord(axis), b = sign * duv.Coord(axis), c = sign * dvv.Coord(axis);
      const double determinant = a * c - b * b;
      Vec2 move{(-gu * c + gv * b) / determinant, (-gv * a + gu * b) / determinant};
      if (!(determinant > 0 && a < 0)) {
        const double fraction =
            std::max(std::abs(gu) / (_high.x - _low.x), std::abs(gv) / (_high.y - _low.y));
        if (!(fraction > 0)) return;
        move = Vec2{gu, gv} / (fraction * 2 * samples);
      }
      const Vec2 next{std::clamp(uv.x + move.x, _low.x, _high.x), std::clamp(uv.y + move.y, _low.y, _high.y)};
      const gp_Pnt there = _surface.Value(next.x, next.y);
      if (sign * (there.Coord(axis) - p.Coord(axis)) <= 0 || !lies_on_face(next)) return;
      uv = next;
    }
  }

  Box& _box;
  BRepAdaptor_Surface _surface;
  BRepTopAdaptor_FClass2d _classifier;
  Vec2 _low, _high;
};

}  // namespace

Box tight_box(const TopoDS_Shape& shape) {
  return tight_box(std::vector<TopoDS_Shape>{shape});
}

Box tight_box(const std::vector<TopoDS_Shape>& shapes) {
  Box box;
  TopTools_IndexedMapOfShape edges, faces;
  for (const TopoDS_Shape& shape : shapes) {
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
  }
  add_edge_extremes(box, edges);
  for (int i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Face face = TopoDS::Face(faces(i).Oriented(TopAbs_FORWARD));
    if (BRepAdaptor_Surface(face, false).GetType() == GeomAbs_Plane) continue;
    if (!box.empty() && box.contains(loose_box(face))) continue;
    FaceExtremes(face, box).add();
  }
  return box;
}

}  // namespace aeroloom::cad
