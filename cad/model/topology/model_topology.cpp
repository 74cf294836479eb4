#include "cad/model/topology/model_topology.hpp"

#include "cad/model/evaluation/plane_snap.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomLib_IsPlanarSurface.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

// The CAD library's maps copy when they are moved.
struct Maps {  // NOLINT(bugprone-exception-escape)
  TopTools_IndexedMapOfShape vertices, edges, faces, solids;
  std::vector<VertexId> vertex_ids;  ///< by index in `vertices`, less one
};

/// Visits the edges of a face loop by loop, oriented as in the face oriented forward. Edges lying inside the
/// face bound no material and are passed over.
template <class Visit>
void for_each_edge(const TopoDS_Shape& face, Visit&& visit) {
  for (TopoDS_Iterator wires(face.Oriented(TopAbs_FORWARD)); wires.More(); wires.Next()) {
    if (wires.Value().ShapeType() != TopAbs_WIRE) continue;
    for (TopoDS_Iterator edges(wires.Value()); edges.More(); edges.Next()) {
      if (bounds_material(edges.Value())) visit(TopoDS::Wire(wires.Value()), TopoDS::Edge(edges.Value()));
    }
  }
}

Maps map_shapes(const TopoDS_Shape& shape) {
  Maps maps;
  TopExp::MapShapes(shape, TopAbs_FACE, maps.faces);
  TopExp::MapShapes(shape, TopAbs_SOLID, maps.solids);
  for (int i = 1; i <= maps.faces.Extent(); ++i) {
    for_each_edge(maps.faces(i), [&](const TopoDS_Wire&, const TopoDS_Edge& edge) {
      if (maps.edges.Contains(edge)) return;
      maps.edges.Add(edge.Oriented(TopAbs_FORWARD));
      TopoDS_Vertex first, last;
      TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
      if (first.IsNull() || last.IsNull())
        throw CadError(fmt::format("edge {} has no end vertices", maps.edges.Extent() - 1));
      maps.vertices.Add(first);
      maps.vertices.Add(last);
    });
  }
  return maps;
}

/// The vertices at which faces run to a point, by index in the map.
std::vector<char> mark_apexes(const Maps& maps) {
  std::vector<char> marks(static_cast<std::size_t>(maps.vertices.Extent()), 0);
  for (int i = 1; i <= maps.edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(maps.edges(i));
    if (BRep_Tool::Degenerated(edge)) marks[maps.vertices.FindIndex(TopExp::FirstVertex(edge)) - 1] = 1;
  }
  return marks;
}

/// Vertices of the CAD model become vertices. Where an apex lies on another one, the two are one: the CAD
/// library joins solids that meet in their corners, but not in their apexes.
void add_vertices(Maps& maps, Model::Data& data) {
  const double same = tolerances::coincident * data.body_bounds.diagonal();
  const std::vector<char> is_apex = mark_apexes(maps);
  std::vector<Vec3> places;
  for (int i = 1; i <= maps.vertices.Extent(); ++i)
    places.push_back(to_vec(BRep_Tool::Pnt(TopoDS::Vertex(maps.vertices(i)))));
  geometry::DisjointSets<VertexId> sets(places.size());
  for (std::size_t apex = 0; apex < places.size(); ++apex) {
    for (std::size_t v = 0; is_apex[apex] && v < places.size(); ++v)
      if (distance(places[apex], places[v]) <= same)
        sets.unite(static_cast<VertexId>(apex), static_cast<VertexId>(v));
  }
  for (std::size_t v = 0; v < places.size(); ++v) {
    const auto lowest = static_cast<std::size_t>(sets.root(static_cast<VertexId>(v)));
    if (lowest < v) {
      maps.vertex_ids.push_back(maps.vertex_ids[lowest]);
      continue;
    }
    maps.vertex_ids.push_back(static_cast<VertexId>(data.vertices.size()));
    data.vertices.push_back(places[v]);
  }
}

void add_edges(const Maps& maps, Model::Data& data) {
  for (int i = 1; i <= maps.edges.Extent(); ++i) {
    EdgeEvaluator evaluator;
    evaluator.shape = TopoDS::Edge(maps.edges(i));
    Edge edge;
    TopoDS_Vertex first, last;
    TopExp::Vertices(evaluator.shape, first, last);
    edge.first = maps.vertex_ids[maps.vertices.FindIndex(first) - 1];
    edge.last = maps.vertex_ids[maps.vertices.FindIndex(last) - 1];
    edge.degenerate = BRep_Tool::Degenerated(evaluator.shape);
    BRep_Tool::Range(evaluator.shape, edge.first_parameter, edge.last_parameter);
    if (!edge.degenerate) {
      double low, high;
      const Handle(Geom_Curve) curve = BRep_Tool::Curve(evaluator.shape, low, high);
      if (curve.IsNull()) {
        throw CadError(
            fmt::format("edge {} at {} has no curve", i - 1, place_in_file(data.vertices[edge.first])));
      }
      evaluator.curve.Load(curve, low, high);
      edge.first_parameter = low, edge.last_parameter = high;
    }
    data.edges.push_back(std::move(edge));
    data.edge_evaluators.push_back(std::move(evaluator));
  }
}

UseCurve use_curve(const TopoDS_Face& face, const TopoDS_Edge& edge, const Coedge& use) {
  UseCurve result;
  result.use = use;
  const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, result.first, result.last);
  if (curve.IsNull())
    throw CadError(fmt::format("edge {} has no parameter curve on one of its faces", use.edge));
  result.curve.Load(curve);
  return result;
}

ParameterRange parameter_range(double low, double high, double period, bool closed, double face_low) {
  if (period > 0) return {face_low, face_low + period, period, false};
  return {low, high, 0, closed};
}

/// One use with where it starts and ends in the loop's direction.
struct LoopSegment {
  Coedge use;
  VertexId start, end;
  Vec2 uv_start, uv_end;
};

LoopSegment loop_segment(const Model::Data& data, const UseCurve& curve) {
  const Edge& edge = data.edges[curve.use.edge];
  const gp_Pnt2d low = curve.curve.Value(curve.first), high = curve.curve.Value(curve.last);
  LoopSegment segment{curve.use, edge.first, edge.last, {low.X(), low.Y()}, {high.X(), high.Y()}};
  if (curve.use.reversed) {
    std::swap(segment.start, segment.end);
    std::swap(segment.uv_start, segment.uv_end);
  }
  return segment;
}

/// Chains the edges of a wire head to tail. Where several start at the vertex, the nearest in parameters
/// follows. A wire that touches itself may give several loops.
std::vector<std::vector<Coedge>> chain_loops(std::vector<LoopSegment> segments, Vec2 scale) {
  std::vector<std::vector<Coedge>> loops;
  while (!segments.empty()) {
    std::vector<Coedge>& loop = loops.emplace_back();
    const VertexId begin = segments.front().start;
    LoopSegment current = segments.front();
    segments.erase(segments.begin());
    loop.push_back(current.use);
    while (true) {
      auto best = segments.end();
      double least = std::numeric_limits<double>::max();
      for (auto segment = segments.begin(); segment != segments.end(); ++segment) {
        if (segment->start != current.end) continue;
        const Vec2 gap = segment->uv_start - current.uv_end;
        const double away = std::hypot(gap.x * scale.x, gap.y * scale.y);
        if (away < least) least = away, best = segment;
      }
      if (best == segments.end()) break;
      current = *best;
      segments.erase(best);
      loop.push_back(current.use);
    }
    if (current.end != begin) {
      throw CadError(
          fmt::format("a loop of edges does not close: it starts at vertex {} and stops at vertex {}", begin,
                      current.end));
    }
  }
  return loops;
}

/// The face's loops as seen along its surface's own normal, outer one first.
std::vector<std::vector<Coedge>> add_uses(const Maps& maps, Model::Data& data, FaceEvaluator& face) {
  const TopoDS_Wire outer = BRepTools::OuterWire(face.shape);
  TopTools_IndexedMapOfShape wires;
  if (!outer.IsNull()) wires.Add(outer);
  std::vector<std::vector<LoopSegment>> segments(wires.Extent());
  for_each_edge(face.shape, [&](const TopoDS_Wire& wire, const TopoDS_Edge& edge) {
    const std::size_t loop = wires.Add(wire) - 1;
    segments.resize(wires.Extent());
    Coedge use{maps.edges.FindIndex(edge) - 1, 0, edge.Orientation() == TopAbs_REVERSED};
    if (use.reversed && BRep_Tool::IsClosed(edge, face.shape)) use.use = 1;
    const auto taken = [&](const UseCurve& other) {
      return other.use.edge == use.edge && other.use.use == use.use;
    };
    if (std::any_of(face.uses.begin(), face.uses.end(), taken)) use.use = 1 - use.use;
    face.uses.push_back(use_curve(face.shape, edge, use));
    segments[loop].push_back(loop_segment(data, face.uses.back()));
  });
  const Vec2 extent = face.uv_high - face.uv_low;
  const Vec2 scale{extent.x > 0 ? 1 / extent.x : 1, extent.y > 0 ? 1 / extent.y : 1};
  std::vector<std::vector<Coedge>> loops;
  for (auto& wire : segments) {
    for (auto& loop : chain_loops(std::move(wire), scale)) loops.push_back(std::move(loop));
  }
  std::ranges::sort(face.uses, [](const UseCurve& a, const UseCurve& b) {
    return std::pair(a.use.edge, a.use.use) < std::pair(b.use.edge, b.use.use);
  });
  return loops;
}

/// Which solids lie on either side of each face, from the way each solid orients it. A face inside of a solid
/// has it on both sides.
void add_regions(const Maps& maps, Model::Data& data) {
  for (int region = 1; region <= maps.solids.Extent(); ++region) {
    for (TopExp_Explorer faces(maps.solids(region), TopAbs_FACE); faces.More(); faces.Next()) {
      const int id = maps.faces.FindIndex(faces.Current()) - 1;
      Face& face = data.faces[id];
      if (!bounds_material(faces.Current())) {
        face.front = face.back = region - 1;
        continue;
      }
      const bool reversed = faces.Current().Orientation() == TopAbs_REVERSED;
      if (face.front == no_entity) {
        face.front = region - 1;
        data.face_evaluators[id].reversed = reversed;
      } else if (face.back == no_entity && reversed != data.face_evaluators[id].reversed) {
        face.back = region - 1;
      } else {
        throw CadError(fmt::format("regions {} and {} lie on the same side of {}: the solids overlap",
                                   face.front, region - 1, data.describe_face(id)));
      }
    }
  }
}

/// Loops were collected along the surface's own normal; seen against the outward normal they run the other
/// way where the two are opposite.
void orient_loops(Model::Data& data) {
  for (std::size_t id = 0; id < data.faces.size(); ++id) {
    if (!data.face_evaluators[id].reversed) continue;
    for (auto& loop : data.faces[id].loops) {
      std::reverse(loop.begin(), loop.end());
      for (Coedge& use : loop) use.reversed = !use.reversed;
    }
    for (UseCurve& curve : data.face_evaluators[id].uses) curve.use.reversed = !curve.use.reversed;
  }
}

}  // namespace

FaceEvaluator make_evaluator(const TopoDS_Shape& shape, double planar_tolerance) {
  FaceEvaluator face;
  face.shape = TopoDS::Face(shape.Oriented(TopAbs_FORWARD));
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face.shape);
  if (surface.IsNull()) throw CadError("a face has no surface (a bare triangulation)");
  face.surface = SurfaceEvaluator(surface);
  BRepTools::UVBounds(face.shape, face.uv_low.x, face.uv_high.x, face.uv_low.y, face.uv_high.y);
  const GeomAdaptor_Surface& s = face.surface.adaptor();
  face.u = parameter_range(s.FirstUParameter(), s.LastUParameter(), s.IsUPeriodic() ? s.UPeriod() : 0,
                           s.IsUClosed(), face.uv_low.x);
  face.v = parameter_range(s.FirstVParameter(), s.LastVParameter(), s.IsVPeriodic() ? s.VPeriod() : 0,
                           s.IsVClosed(), face.uv_low.y);
  face.planar = s.GetType() == GeomAbs_Plane || GeomLib_IsPlanarSurface(surface, planar_tolerance).IsPlanar();
  return face;
}

const UseCurve& FaceEvaluator::use(const Coedge& wanted) const {
  const auto found =
      std::lower_bound(uses.begin(), uses.end(), wanted, [](const UseCurve& a, const Coedge& b) {
        return std::pair(a.use.edge, a.use.use) < std::pair(b.edge, b.use);
      });
  if (found == uses.end() || found->use.edge != wanted.edge || found->use.use != wanted.use) {
    throw std::out_of_range(
        fmt::format("edge {} (use {}) does not bound this face", wanted.edge, wanted.use));
  }
  return *found;
}

void index_topology(Model::Data& data) {
  Maps maps = map_shapes(data.shape);
  add_vertices(maps, data);
  add_edges(maps, data);
  data.faces.resize(maps.faces.Extent());
  for (int i = 1; i <= maps.faces.Extent(); ++i) {
    data.face_evaluators.push_back(
        make_evaluator(maps.faces(i), tolerances::coincident * data.bounds.diagonal()));
    data.faces[i - 1].loops = add_uses(maps, data, data.face_evaluators.back());
    for (const UseCurve& curve : data.face_evaluators.back().uses) {
      auto& users = data.edges[curve.use.edge].faces;
      if (users.empty() || users.back() != i - 1) users.push_back(i - 1);
    }
  }
  add_regions(maps, data);
  for (FaceId id = 0; id < static_cast<FaceId>(data.faces.size()); ++id) {
    if (data.faces[id].front == no_entity) throw CadError(data.describe_face(id) + " bounds no solid");
  }
  orient_loops(data);
  mark_exact_planes(data);
}

}  // namespace aeroloom::cad
