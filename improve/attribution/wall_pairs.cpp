#include "improve/attribution/wall_pairs.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/cad_dimension.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace aeroloom::attribution {
namespace {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;

/// The distance between the plane or line through the corners in the set and that through the others;
/// infinite where they are no plane or line.
double distance_between(const std::array<Vec3, 4>& p, unsigned set) {
  if (std::popcount(set) == 3) set ^= 0b1111;
  std::array<Vec3, 4> ordered;  // those in the set first
  int next = 0;
  for (const bool inside : {true, false}) {
    for (unsigned i = 0; i < 4; ++i) {
      if ((set >> i & 1) == static_cast<unsigned>(inside)) ordered[next++] = p[i];
    }
  }
  const auto& [a, b, c, d] = ordered;
  const bool corner_and_plane = std::popcount(set) == 1;
  const Vec3 normal = corner_and_plane ? cross(c - b, d - b) : cross(b - a, d - c);
  const Vec3 across = corner_and_plane ? b - a : c - a;
  const double length = norm(normal);
  return length > 0 ? std::abs(dot(normal, across)) / length : std::numeric_limits<double>::infinity();
}

double longest_edge(const std::array<Vec3, 4>& p) {
  double longest = 0;
  for (const auto& [a, b] : mesh::tetrahedron_edges) longest = std::max(longest, distance(p[a], p[b]));
  return longest;
}

}  // namespace

VertexFaces::VertexFaces(const mesh::DistributedMesh& mesh) {
  const auto sort_out = [](std::vector<Classification>& rows) { geometry::sort_unique(rows); };
  std::vector<Classification> mine;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      for (int i = 0; i < 3; ++i) {
        const LocalIndex v = piece.boundary_triangle(t)[i];
        if (is_on_curve(piece.vertex_dimension[v]))
          mine.push_back({static_cast<std::int32_t>(piece.vertex_dimension[v]), piece.vertex_entity[v],
                          piece.triangle_face[t]});
      }
    }
    sort_out(mine);
  }
  _rows = mesh.communicator.all_gather_items<Classification>(mine);
  sort_out(_rows);
}

void VertexFaces::list(const Piece& piece, LocalIndex vertex, std::vector<std::int32_t>& faces) const {
  const mesh::CadDimension dimension = piece.vertex_dimension[vertex];
  const std::int32_t entity = piece.vertex_entity[vertex];
  if (dimension == mesh::CadDimension::face) faces.push_back(entity);
  if (!is_on_curve(dimension)) return;
  const Classification first{static_cast<std::int32_t>(dimension), entity,
                             std::numeric_limits<std::int32_t>::min()};
  for (auto row = std::lower_bound(_rows.begin(), _rows.end(), first);
       row != _rows.end() && row->dimension == first.dimension && row->entity == entity; ++row) {
    faces.push_back(row->face);
  }
}

std::optional<WallPair> WallFinder::find(const Piece& piece, LocalIndex tet) {
  const LocalIndex* cell = piece.cell(tet);
  std::array<Vec3, 4> points;
  _faces.clear();
  for (int i = 0; i < 4; ++i) {
    points[i] = piece.point(cell[i]);
    _first[i] = _faces.size();
    _of_vertices.list(piece, cell[i], _faces);
    if (_faces.size() == _first[i]) return std::nullopt;
  }
  _first[4] = _faces.size();
  _candidates = _faces;
  geometry::sort_unique(_candidates);
  std::optional<WallPair> nearest;
  for (std::size_t low = 0; low < _candidates.size(); ++low) {
    for (std::size_t high = low + 1; high < _candidates.size(); ++high) {
      const std::optional<WallPair> walls = measure(_candidates[low], _candidates[high], points);
      if (walls && (!nearest || walls->gap < nearest->gap)) nearest = walls;
    }
  }
  if (nearest && nearest->gap > gap_fraction * longest_edge(points)) return std::nullopt;
  return nearest;
}

std::optional<WallPair> WallFinder::measure(std::int32_t low, std::int32_t high,
                                            const std::array<Vec3, 4>& points) const {
  const unsigned on_low = corners_on(low), on_high = corners_on(high), all = 0b1111;
  if ((on_low | on_high) != all || on_low == all || on_high == all) return std::nullopt;
  // Vertices on both count for either wall.
  double gap = std::numeric_limits<double>::infinity();
  for (unsigned side = 1; side < all; ++side) {
    if ((side & ~on_low) == 0 && (~side & all & ~on_high) == 0)
      gap = std::min(gap, distance_between(points, side));
  }
  return WallPair{low, high, gap, (on_low & on_high) != 0};
}

unsigned WallFinder::corners_on(std::int32_t face) const {
  unsigned corners = 0;
  for (unsigned i = 0; i < 4; ++i) {
    const auto begin = _faces.begin() + static_cast<std::ptrdiff_t>(_first[i]);
    const auto end = _faces.begin() + static_cast<std::ptrdiff_t>(_first[i + 1]);
    if (std::find(begin, end, face) != end) corners |= 1U << i;
  }
  return corners;
}

}  // namespace aeroloom::attribution
