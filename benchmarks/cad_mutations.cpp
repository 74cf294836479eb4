#include "benchmarks/cad_mutations.hpp"

#include "benchmarks/redrawn_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepLib.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

namespace aeroloom::mutations {
namespace {

/// The standard's distributions differ between libraries.
double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0;
}
std::size_t pick(std::mt19937& random, std::size_t count) {
  return static_cast<std::size_t>(uniform(random) * static_cast<double>(count));
}
double between_powers(std::mt19937& random, double low, double high) {
  return std::pow(10, low + (high - low) * uniform(random));
}

std::string words(const char* what, const gp_Pnt& at, double far, double share) {
  char text[300];
  std::snprintf(text, sizeof text, "%s at (%.6g, %.6g, %.6g) by %.3g, %.1e of the diagonal", what, at.X(),
                at.Y(), at.Z(), far, share);
  return text;
}

class Mutator {
public:
  Mutator(const TopoDS_Shape& shape, std::mt19937& random) : _shape(shape), _random(random) {
    TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, _faces_of);
    TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_VERTEX, TopAbs_EDGE, _edges_of);
    Bnd_Box box;
    BRepBndLib::Add(shape, box, Standard_False);
    _diagonal = std::sqrt(box.SquareExtent());
  }

  Mutated run(Mutation mutation) {
    constexpr int attempts = 50;
    for (int i = 0; i < attempts; ++i) {
      _change = new BRepTools_ReShape;
      std::string what;
      switch (mutation) {
        case Mutation::vertex_moved:
          what = move_vertex();
          break;
        case Mutation::edge_split:
          what = split_edge();
          break;
        case Mutation::face_offset:
          what = offset_face();
          break;
        case Mutation::sliver_inserted:
          what = insert_sliver();
          break;
        case Mutation::tolerances_loosened:
          return {_shape, loosen()};
      }
      if (!what.empty()) return {_change->Apply(_shape), what};
    }
    throw std::runtime_error("no place for the mutation");
  }

private:
  TopoDS_Edge any_edge() {
    return TopoDS::Edge(
        _faces_of.FindKey(1 + static_cast<int>(pick(_random, _faces_of.Extent()))).Oriented(TopAbs_FORWARD));
  }

  bool has_seam(const TopoDS_Edge& edge) const {
    for (const TopoDS_Shape& face : _faces_of.FindFromKey(edge)) {
      if (BRep_Tool::IsClosed(edge, TopoDS::Face(face))) return true;
    }
    return false;
  }

  std::string move_vertex() {
    const TopoDS_Edge along = any_edge();
    Stretch stretch;
    if (!look_at(along, stretch)) return {};
    TopoDS_Vertex first, last;
    TopExp::Vertices(along, first, last);
    if (first.IsSame(last)) return {};
    const double share = between_powers(_random, -8, -4), far = share * _diagonal;
    if (far > 0.1 * stretch.length) return {};
    // The new place of the last vertex: along the curve, by so much.
    gp_Pnt end;
    gp_Vec tangent;
    stretch.curve->D1(stretch.last, end, tangent);
    if (tangent.Magnitude() == 0) return {};
    const double step = far / tangent.Magnitude();
    const gp_Pnt moved = stretch.curve->Value(stretch.last - step);
    for (const TopoDS_Shape& each : _edges_of.FindFromKey(last)) {
      const TopoDS_Edge edge = TopoDS::Edge(each.Oriented(TopAbs_FORWARD));
      Stretch own;
      if (!look_at(edge, own) || has_seam(edge) || far > 0.1 * own.length) return {};
      TopoDS_Vertex a, b;
      TopExp::Vertices(edge, a, b);
      if (a.IsSame(b)) return {};
    }
    BRep_Builder builder;
    TopoDS_Vertex now;
    builder.MakeVertex(now, moved, 1e-7);
    const gp_Vec by(end, moved);
    for (const TopoDS_Shape& each : _edges_of.FindFromKey(last)) {
      const TopoDS_Edge edge = TopoDS::Edge(each.Oriented(TopAbs_FORWARD));
      Stretch own;
      look_at(edge, own);
      TopoDS_Vertex a, b;
      TopExp::Vertices(edge, a, b);
      TopoDS_Edge made;
      if (edge.IsSame(along)) {
        made = TopoDS::Edge(edge.EmptyCopied());
        BRepLib::SameRange(made);
        builder.Range(made, own.first, own.last - step);
      } else {
        std::vector<gp_Pnt> points;
        for (int i = 0; i <= intervals; ++i) {
          const double weight = static_cast<double>(b.IsSame(last) ? i : intervals - i) / intervals;
          points.push_back(at(own, i).Translated(weight * by));
        }
        if (!redraw(edge, own, points, made)) return {};
      }
      builder.Add(made, (a.IsSame(last) ? now : a).Oriented(TopAbs_FORWARD));
      builder.Add(made, (b.IsSame(last) ? now : b).Oriented(TopAbs_REVERSED));
      _change->Replace(edge, made);
    }
    builder.UpdateVertex(now, 1.1 * far);
    return words("vertex moved", end, far, share);
  }

  /// The edge through other points, without vertices.
  bool redraw(const TopoDS_Edge& edge, const Stretch& stretch, const std::vector<gp_Pnt>& points,
              TopoDS_Edge& made) {
    BRep_Builder builder;
    const Handle(Geom_Curve) curve = through(stretch, points);
    if (curve.IsNull()) return false;
    builder.MakeEdge(made, curve, 1e-7);
    builder.Range(made, stretch.first, stretch.last);
    for (const TopoDS_Shape& user : _faces_of.FindFromKey(edge)) {
      const TopoDS_Face face = TopoDS::Face(user.Oriented(TopAbs_FORWARD));
      const Handle(Geom2d_Curve) on_face = image(face, stretch, edge, points);
      if (on_face.IsNull()) return false;
      const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
      double apart = 1e-7;
      for (int i = 0; i <= intervals; ++i) {
        const gp_Pnt2d uv = on_face->Value(parameter(stretch, i));
        apart = std::max(apart, surface->Value(uv.X(), uv.Y()).Distance(points[i]));
      }
      builder.UpdateEdge(made, on_face, face, 1.5 * apart);
      builder.Range(made, face, stretch.first, stretch.last);
    }
    return true;
  }

  std::string split_edge() {
    const TopoDS_Edge edge = any_edge();
    Stretch stretch;
    if (!look_at(edge, stretch)) return {};
    BRepLib::SameRange(edge);
    const double share = between_powers(_random, -8, -4), far = share * _diagonal;
    gp_Pnt start;
    gp_Vec tangent;
    stretch.curve->D1(stretch.first, start, tangent);
    if (tangent.Magnitude() == 0 || far > 0.1 * stretch.length) return {};
    const double cut = stretch.first + far / tangent.Magnitude();
    TopoDS_Vertex first, last, middle;
    TopExp::Vertices(edge, first, last);
    BRep_Builder builder;
    builder.MakeVertex(middle, stretch.curve->Value(cut), 1e-7);
    TopoDS_Wire parts;
    builder.MakeWire(parts);
    const auto add = [&](double from, double to, const TopoDS_Vertex& a, const TopoDS_Vertex& b) {
      TopoDS_Edge part = TopoDS::Edge(edge.EmptyCopied());
      builder.Range(part, from, to);
      builder.Add(part, a.Oriented(TopAbs_FORWARD));
      builder.Add(part, b.Oriented(TopAbs_REVERSED));
      builder.Add(parts, part);
    };
    add(stretch.first, cut, first, middle);
    add(cut, stretch.last, middle, last);
    _change->Replace(edge, parts);
    return words("edge split", start, far, share);
  }

  std::string offset_face() {
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(_shape, TopAbs_FACE, faces);
    const TopoDS_Face face =
        TopoDS::Face(faces(1 + static_cast<int>(pick(_random, faces.Extent()))).Oriented(TopAbs_FORWARD));
    TopLoc_Location location;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face, location);
    double u0, u1, v0, v1;
    bounds_of(face, u0, u1, v0, v1);
    gp_Pnt place;
    gp_Vec du, dv;
    surface->D1(0.5 * (u0 + u1), 0.5 * (v0 + v1), place, du, dv);
    gp_Vec normal = du.Crossed(dv);
    if (normal.Magnitude() == 0) return {};
    normal.Normalize();
    const double share = between_powers(_random, -9, -6), far = share * _diagonal;
    BRep_Builder builder;
    TopoDS_Face made;
    const Handle(Geom_Surface) moved = Handle(Geom_Surface)::DownCast(surface->Translated(far * normal));
    builder.MakeFace(made, moved, location, BRep_Tool::Tolerance(face));
    for (TopoDS_Iterator wires(face); wires.More(); wires.Next()) builder.Add(made, wires.Value());
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(face, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
      const TopoDS_Edge edge = TopoDS::Edge(edges(i).Oriented(TopAbs_FORWARD));
      double low, high;
      const Handle(Geom2d_Curve) one = BRep_Tool::CurveOnSurface(edge, face, low, high);
      if (one.IsNull()) continue;
      if (BRep_Tool::IsClosed(edge, face)) {
        const Handle(Geom2d_Curve) other =
            BRep_Tool::CurveOnSurface(TopoDS::Edge(edge.Reversed()), face, low, high);
        builder.UpdateEdge(edge, one, other, made, 1.1 * far);
      } else {
        builder.UpdateEdge(edge, one, made, 1.1 * far);
      }
      builder.Range(edge, made, low, high);
      raise(edge, 1.1 * far);
    }
    _change->Replace(face, made);
    return words("face offset", place.Transformed(location), far, share);
  }

  static void raise(const TopoDS_Edge& edge, double tolerance) {
    BRep_Builder builder;
    builder.UpdateEdge(edge, tolerance);
    for (TopoDS_Iterator ends(edge); ends.More(); ends.Next())
      builder.UpdateVertex(TopoDS::Vertex(ends.Value()), 1.01 * tolerance);
  }

  /// A lens between an edge and a curve beside it in one of the edge's faces.
  std::string insert_sliver() {
    const TopoDS_Edge edge = any_edge();
    Stretch stretch;
    if (!look_at(edge, stretch) || has_seam(edge)) return {};
    TopoDS_Vertex first, last;
    TopExp::Vertices(edge, first, last);
    if (first.IsSame(last)) return {};
    const double share = between_powers(_random, -8, -5), far = share * _diagonal;
    if (far > 0.02 * stretch.length) return {};
    const TopTools_ListOfShape& users = _faces_of.FindFromKey(edge);
    const TopoDS_Face face =
        TopoDS::Face((uniform(_random) < 0.5 ? users.First() : users.Last()).Oriented(TopAbs_FORWARD));
    TopLoc_Location location;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    double low, high;
    const Handle(Geom2d_Curve) before = BRep_Tool::CurveOnSurface(edge, face, low, high);
    if (before.IsNull()) return {};
    bool reversed = false;
    TopoDS_Wire wire;
    for (TopoDS_Iterator wires(face); wires.More(); wires.Next()) {
      for (TopoDS_Iterator edges(wires.Value()); edges.More(); edges.Next()) {
        if (!edges.Value().IsSame(edge)) continue;
        wire = TopoDS::Wire(wires.Value());
        reversed =
            (edges.Value().Orientation() == TopAbs_REVERSED) != (wire.Orientation() == TopAbs_REVERSED);
      }
    }
    std::vector<gp_Pnt> points;
    for (int i = 0; i <= intervals; ++i) {
      gp_Pnt2d uv;
      gp_Vec2d along;
      before->D1(low + (high - low) * i / intervals, uv, along);
      gp_Pnt p;
      gp_Vec du, dv, tangent;
      surface->D1(uv.X(), uv.Y(), p, du, dv);
      tangent = along.X() * du + along.Y() * dv;
      gp_Vec inward = du.Crossed(dv).Crossed(tangent);
      if (inward.Magnitude() == 0) return {};
      inward.Normalize();
      const double bulge = i == 0 || i == intervals ? 0 : std::sin(std::numbers::pi * i / intervals);
      points.push_back(at(stretch, i).Translated((reversed ? -far : far) * bulge * inward));
    }
    BRep_Builder builder;
    TopoDS_Edge beside;
    const Handle(Geom_Curve) curve = through(stretch, points);
    const Handle(Geom2d_Curve) on_face = image(face, stretch, edge, points);
    if (curve.IsNull() || on_face.IsNull()) return {};
    builder.MakeEdge(beside, curve, 1e-7);
    builder.Range(beside, stretch.first, stretch.last);
    builder.UpdateEdge(beside, on_face, face, 1e-7);
    builder.Add(beside, first.Oriented(TopAbs_FORWARD));
    builder.Add(beside, last.Oriented(TopAbs_REVERSED));
    TopoDS_Wire border;
    builder.MakeWire(border);
    builder.Add(border, edge.Oriented(reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
    builder.Add(border, beside.Oriented(reversed ? TopAbs_FORWARD : TopAbs_REVERSED));
    TopoDS_Face sliver = TopoDS::Face(face.EmptyCopied());
    builder.Add(sliver, border);
    // The face with the other border, and the sliver beside it in every shell.
    BRepTools_ReShape inner;
    inner.Replace(edge, beside);
    TopoDS_Face rest = TopoDS::Face(face.EmptyCopied());
    for (TopoDS_Iterator wires(face); wires.More(); wires.Next())
      builder.Add(rest, wires.Value().IsSame(wire) ? inner.Apply(wires.Value()) : wires.Value());
    TopoDS_Shell both;
    builder.MakeShell(both);
    builder.Add(both, rest);
    builder.Add(both, sliver);
    _change->Replace(face, both);
    return words("sliver inserted", at(stretch, intervals / 2), far, share);
  }

  std::string loosen() {
    const double share = between_powers(_random, -8, -4), far = share * _diagonal;
    for (int i = 1; i <= _faces_of.Extent(); ++i) {
      if (uniform(_random) < 1.0 / 3) raise(TopoDS::Edge(_faces_of.FindKey(i)), far);
    }
    return words("tolerances loosened", gp_Pnt(), far, share);
  }

  TopoDS_Shape _shape;
  std::mt19937& _random;
  TopTools_IndexedDataMapOfShapeListOfShape _faces_of, _edges_of;
  double _diagonal = 0;
  Handle(BRepTools_ReShape) _change;
};

}  // namespace

Mutated mutate(const TopoDS_Shape& shape, Mutation mutation, std::mt19937& random) {
  return Mutator(shape, random).run(mutation);
}

}  // namespace aeroloom::mutations
