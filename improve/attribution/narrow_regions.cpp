#include "improve/attribution/narrow_regions.hpp"

#include "geometry/sort_unique.hpp"
#include "improve/attribution/curve_edges.hpp"
#include "mesh/data/cad_dimension.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::attribution {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

/// A triangle is narrow when its height over a side on one curve is at most this fraction of that side.
/// Chosen, not measured.
constexpr double narrow_fraction = 0.4;
/// Two curves run along each other where their segments enclose less than 30 degrees, as in
/// surface/cusps/needles.cpp.
const double along_cosine = std::cos(30 * std::numbers::pi / 180);

/// The edges of an ascending list that join two vertices, one for each region.
std::span<const EdgeName> edges_between(const std::vector<EdgeName>& edges, GlobalIndex a, GlobalIndex b) {
  const EdgeName first{std::min(a, b), std::max(a, b), std::numeric_limits<std::int64_t>::min()};
  const auto begin = std::lower_bound(edges.begin(), edges.end(), first);
  auto end = begin;
  while (end != edges.end() && end->low == first.low && end->high == first.high) ++end;
  return {begin, end};
}

/// The name of a curve: its number, or a negative number made from two CAD vertices joined by one segment.
using CurveName = std::int64_t;

CurveName name_of_segment(std::int32_t a, std::int32_t b) {
  return -1 - ((static_cast<std::int64_t>(std::min(a, b)) << 31) + std::max(a, b));
}

/// An edge of a boundary triangle at a CAD vertex.
struct EdgeAtVertex {
  std::int32_t vertex, face;
  CurveName curve;    ///< that the other end lies on
  GlobalIndex other;  ///< other end
  Vec3 step;          ///< from the vertex to it
};

auto edge_key(const EdgeAtVertex& e) {
  return std::tie(e.vertex, e.curve, e.other, e.face);
}

/// The curves of a CAD face that end in a CAD vertex.
struct CurveAtVertex {
  std::int32_t vertex, face;
  CurveName curve;
  Vec3 step;  ///< along its first segment
};

void add_edges(const Piece& piece, const std::vector<GlobalIndex>& names, std::vector<EdgeAtVertex>& edges) {
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    for (int i = 0; i < 3; ++i) {
      for (const int k : {(i + 1) % 3, (i + 2) % 3}) {
        if (piece.vertex_dimension[v[i]] != mesh::CadDimension::vertex ||
            !is_on_curve(piece.vertex_dimension[v[k]]))
          continue;
        const std::int32_t vertex = piece.vertex_entity[v[i]], entity = piece.vertex_entity[v[k]];
        const bool between_vertices = piece.vertex_dimension[v[k]] == mesh::CadDimension::vertex;
        edges.push_back({vertex, piece.triangle_face[t],
                         between_vertices ? name_of_segment(vertex, entity) : entity, names[v[k]],
                         piece.point(v[k]) - piece.point(v[i])});
      }
    }
  }
}

/// A mesh edge is on a curve if triangles of two CAD faces meet at it.
std::vector<CurveAtVertex> curves_at_vertices(const mesh::NumberedMesh& mesh) {
  const auto sort_out = [](std::vector<EdgeAtVertex>& edges) {
    const auto same = [](const EdgeAtVertex& a, const EdgeAtVertex& b) { return edge_key(a) == edge_key(b); };
    geometry::sort_unique(
        edges, [](const EdgeAtVertex& a, const EdgeAtVertex& b) { return edge_key(a) < edge_key(b); }, same);
  };
  std::vector<EdgeAtVertex> edges;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    add_edges(mesh.pieces[i], mesh.numbering.vertices[i], edges);
  sort_out(edges);
  edges = mesh.communicator.all_gather_items<EdgeAtVertex>(edges);
  sort_out(edges);
  std::vector<CurveAtVertex> curves;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const EdgeAtVertex &a = edges[i - 1], &b = edges[i];
    if (std::tie(a.vertex, a.curve, a.other) != std::tie(b.vertex, b.curve, b.other)) continue;
    curves.push_back({a.vertex, a.face, a.curve, a.step});
    curves.push_back({b.vertex, b.face, b.curve, b.step});
  }
  // Curves of one vertex and face together, in the order they had.
  std::stable_sort(curves.begin(), curves.end(), [](const CurveAtVertex& a, const CurveAtVertex& b) {
    return std::tie(a.vertex, a.face) < std::tie(b.vertex, b.face);
  });
  return curves;
}

/// A boundary triangle that fills a narrow region of a CAD face from curve to curve, or from one strand of a
/// curve that turns back to the other.
struct NarrowTriangle {
  LocalIndex triangle = 0;                                  ///< among the boundary triangles of its piece
  std::array<std::pair<LocalIndex, LocalIndex>, 2> across;  ///< its edges across; may be twice the same
  double width = 0;                                         ///< its height over the side along the region
};

/// The height of a triangle of a piece over its side from a to b where that is narrow, else none.
std::optional<double> narrow_height(const Piece& piece, LocalIndex a, LocalIndex b, LocalIndex c) {
  const Vec3 side = piece.point(b) - piece.point(a);
  const double area2 = norm(cross(side, piece.point(c) - piece.point(a)));
  if (area2 > narrow_fraction * dot(side, side)) return std::nullopt;
  return area2 / norm(side);
}

class NarrowTriangleTest {
public:
  NarrowTriangleTest(const Piece& piece, const std::vector<CurveAtVertex>& curves)
      : _piece(piece), _curves(curves) {}

  /// Whether a and b lie on one curve of the face, and c on another that runs along it.
  bool joins_two_curves(LocalIndex a, LocalIndex b, LocalIndex c, std::int32_t face) {
    list(a, face, _at_a);
    list(b, face, _at_b);
    list(c, face, _at_c);
    const auto has = [](const std::vector<CurveName>& names, CurveName name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    const bool share = std::any_of(_at_a.begin(), _at_a.end(), [&](CurveName n) { return has(_at_b, n); });
    if (!share) return false;
    const Vec3 p = _piece.point(a), q = _piece.point(b), r = _piece.point(c);
    const Vec3 direction = distance(p, r) < distance(q, r) ? q - p : p - q;
    const auto is_apart = [&](CurveName n) { return !has(_at_a, n) && !has(_at_b, n); };
    if (_piece.vertex_dimension[c] != mesh::CadDimension::vertex)
      return std::any_of(_at_c.begin(), _at_c.end(), is_apart);
    // A short segment across the end of a curve makes no narrow region of the curves that it joins.
    const auto curves = curves_at(_piece.vertex_entity[c], face);
    return std::any_of(curves.begin(), curves.end(), [&](const CurveAtVertex& curve) {
      return is_apart(curve.curve) &&
             dot(curve.step, direction) >= along_cosine * norm(curve.step) * norm(direction);
    });
  }

private:
  void list(LocalIndex v, std::int32_t face, std::vector<CurveName>& names) const {
    names.clear();
    const std::int32_t entity = _piece.vertex_entity[v];
    if (_piece.vertex_dimension[v] != mesh::CadDimension::vertex) {
      names.push_back(entity);
      return;
    }
    for (const CurveAtVertex& curve : curves_at(entity, face)) names.push_back(curve.curve);
  }
  std::span<const CurveAtVertex> curves_at(std::int32_t vertex, std::int32_t face) const {
    const auto is_before = [](const CurveAtVertex& c, const std::pair<std::int32_t, std::int32_t>& wanted) {
      return std::tie(c.vertex, c.face) < std::tie(wanted.first, wanted.second);
    };
    const auto first = std::lower_bound(_curves.begin(), _curves.end(), std::pair(vertex, face), is_before);
    const auto last = std::find_if(
        first, _curves.end(), [&](const CurveAtVertex& c) { return c.vertex != vertex || c.face != face; });
    return {first, last};
  }

  const Piece& _piece;
  const std::vector<CurveAtVertex>& _curves;
  std::vector<CurveName> _at_a, _at_b, _at_c;
};

/// Boundary triangles of a piece with three corners on one curve, beside edges of the list.
std::vector<LocalIndex> triangles_of_one_curve(const Piece& piece, const std::vector<GlobalIndex>& names,
                                               const std::vector<EdgeName>& edges) {
  std::vector<LocalIndex> found;
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    const bool is_of_one = std::all_of(v, v + 3, [&](LocalIndex w) {
      return piece.vertex_dimension[w] == mesh::CadDimension::edge &&
             piece.vertex_entity[w] == piece.vertex_entity[v[0]];
    });
    if (!is_of_one) continue;
    for (int k = 0; k < 3; ++k) {
      if (!edges_between(edges, names[v[k]], names[v[(k + 1) % 3]]).empty()) {
        found.push_back(t);
        break;
      }
    }
  }
  return found;
}

/// Triangle t, with three corners on one curve, where the curve turns back: one side is on the curve and the
/// third corner on the other strand, or two sides are and enclose a sharp corner. None for a triangle beside
/// a curve that merely bends.
std::optional<NarrowTriangle> between_strands(const Piece& piece, LocalIndex t,
                                              const std::array<bool, 3>& is_on_curve) {
  const LocalIndex* v = piece.boundary_triangle(t);
  const auto count = std::count(is_on_curve.begin(), is_on_curve.end(), true);
  for (int k = 0; k < 3; ++k) {
    const LocalIndex a = v[k], b = v[(k + 1) % 3], c = v[(k + 2) % 3];
    if (count == 1 && is_on_curve[k]) {
      const std::optional<double> height = narrow_height(piece, a, b, c);
      if (height) return NarrowTriangle{t, {{{a, c}, {b, c}}}, *height};
    }
    if (count == 2 && !is_on_curve[k]) {
      const Vec3 to_a = piece.point(a) - piece.point(c), to_b = piece.point(b) - piece.point(c);
      const double longer = std::max(norm(to_a), norm(to_b));
      if (dot(to_a, to_b) >= along_cosine * norm(to_a) * norm(to_b))
        return NarrowTriangle{t, {{{a, b}, {a, b}}}, norm(cross(to_a, to_b)) / longer};
    }
  }
  return std::nullopt;
}

/// Triangles between strands of one curve, per piece. Collective.
std::vector<std::vector<NarrowTriangle>> triangles_between_strands(const mesh::NumberedMesh& mesh,
                                                                   const std::vector<EdgeName>& edges) {
  std::vector<std::vector<LocalIndex>> candidates;
  std::vector<EdgeEnds> sides;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const std::vector<GlobalIndex>& names = mesh.numbering.vertices[i];
    candidates.push_back(triangles_of_one_curve(mesh.pieces[i], names, edges));
    for (const LocalIndex t : candidates.back()) {
      const LocalIndex* v = mesh.pieces[i].boundary_triangle(t);
      for (int k = 0; k < 3; ++k) sides.push_back(ends_of(names, v[k], v[(k + 1) % 3]));
    }
  }
  const CurveEdges on_curves(mesh, std::move(sides));
  std::vector<std::vector<NarrowTriangle>> found(mesh.pieces.size());
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    for (const LocalIndex t : candidates[i]) {
      const LocalIndex* v = mesh.pieces[i].boundary_triangle(t);
      std::array<bool, 3> is_on_curve{};
      for (int k = 0; k < 3; ++k)
        is_on_curve[k] = on_curves.has(ends_of(mesh.numbering.vertices[i], v[k], v[(k + 1) % 3]));
      const auto narrow = between_strands(mesh.pieces[i], t, is_on_curve);
      if (narrow) found[i].push_back(*narrow);
    }
  }
  return found;
}

/// Triangles with two vertices on one curve and the third on another.
std::vector<NarrowTriangle> narrow_triangles(const Piece& piece, const std::vector<CurveAtVertex>& curves) {
  std::vector<NarrowTriangle> found;
  NarrowTriangleTest test(piece, curves);
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    const LocalIndex* v = piece.boundary_triangle(t);
    if (std::any_of(v, v + 3, [&](LocalIndex w) { return !is_on_curve(piece.vertex_dimension[w]); }))
      continue;
    for (int i = 0; i < 3; ++i) {
      const LocalIndex a = v[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
      const std::optional<double> height = narrow_height(piece, a, b, c);
      if (!height || !test.joins_two_curves(a, b, c, piece.triangle_face[t])) continue;
      found.push_back({t, {{{a, c}, {b, c}}}, *height});
      break;
    }
  }
  return found;
}

}  // namespace

std::vector<NarrowEdge> find_narrow_edges(const mesh::NumberedMesh& mesh,
                                          const std::vector<EdgeName>& edges) {
  const std::vector<CurveAtVertex> curves = curves_at_vertices(mesh);
  const std::vector<std::vector<NarrowTriangle>> between = triangles_between_strands(mesh, edges);
  std::vector<NarrowEdge> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const Piece& piece = mesh.pieces[i];
    const auto add = [&](const NarrowTriangle& narrow) {
      for (const auto& [a, b] : narrow.across) {
        // Only one side of a face has triangles in its pieces; edges count for the regions of both sides.
        for (const EdgeName& edge :
             edges_between(edges, mesh.numbering.vertices[i][a], mesh.numbering.vertices[i][b])) {
          mine.push_back({&edge - edges.data(), piece.triangle_face[narrow.triangle], narrow.width,
                          0.5 * (piece.point(a) + piece.point(b))});
        }
      }
    };
    for (const NarrowTriangle& narrow : narrow_triangles(piece, curves)) add(narrow);
    for (const NarrowTriangle& narrow : between[i]) add(narrow);
  }
  std::vector<NarrowEdge> narrow = mesh.communicator.all_gather_items<NarrowEdge>(mine);
  const auto same = [](const NarrowEdge& a, const NarrowEdge& b) { return a.edge == b.edge; };
  geometry::sort_unique(
      narrow,
      [](const NarrowEdge& a, const NarrowEdge& b) {
        return std::tie(a.edge, a.width, a.face) < std::tie(b.edge, b.width, b.face);
      },
      same);
  return narrow;
}

const NarrowEdge* find_narrow_edge(const std::vector<NarrowEdge>& narrow, std::int64_t edge) {
  const auto found =
      std::lower_bound(narrow.begin(), narrow.end(), edge,
                       [](const NarrowEdge& each, std::int64_t wanted) { return each.edge < wanted; });
  return found != narrow.end() && found->edge == edge ? &*found : nullptr;
}

}  // namespace aeroloom::attribution
