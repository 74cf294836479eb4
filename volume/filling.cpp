#include "volume/filling.hpp"

#include "geometry/predicates.hpp"
#include "mesh/mixing.hpp"
#include "sizing/morton.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// A triangle as a set, and whether it took an odd permutation to sort it.
struct SortedTriangle {
  Triangle vertices;
  bool odd = false;
};

SortedTriangle sorted(mesh::LocalIndex a, mesh::LocalIndex b, mesh::LocalIndex c) {
  bool odd = false;
  if (a > b) std::swap(a, b), odd = !odd;
  if (b > c) std::swap(b, c), odd = !odd;
  if (a > b) std::swap(a, b), odd = !odd;
  return {{a, b, c}, odd};
}

SortedTriangle sorted_face(const Cell& cell, int face) {
  const int* corner = mesh::tetrahedron_faces[face];
  return sorted(cell[corner[0]], cell[corner[1]], cell[corner[2]]);
}

/// Opposite orientations give opposite values, so the two sides of a face cancel.
std::uint64_t oriented_hash(const SortedTriangle& face) {
  const auto& v = face.vertices;
  std::uint64_t hash = 0;
  for (const mesh::LocalIndex vertex : v) hash = mesh::mix_in(hash, static_cast<std::uint64_t>(vertex));
  return face.odd ? 0 - hash : hash;
}

enum class Side : std::int8_t { unknown, inside, outside };

/// The surface's triangles by vertices, to ask which way one is turned.
class TriangleTable {
public:
  explicit TriangleTable(std::span<const Triangle> triangles) {
    _entries.reserve(triangles.size());
    for (const Triangle& t : triangles) _entries.push_back(sorted(t[0], t[1], t[2]));
    std::sort(_entries.begin(), _entries.end(), less);
  }

  /// The side of the surface a cell is on whose face, counter-clockwise seen from outside the cell, this is.
  Side side_of(const SortedTriangle& face) const {
    const auto found = std::lower_bound(_entries.begin(), _entries.end(), face, less);
    if (found == _entries.end() || found->vertices != face.vertices) {
      throw std::runtime_error("the filling ends at a face that is no triangle of the surface");
    }
    return found->odd == face.odd ? Side::inside : Side::outside;
  }

private:
  static bool less(const SortedTriangle& a, const SortedTriangle& b) { return a.vertices < b.vertices; }
  std::vector<SortedTriangle> _entries;
};

/// Gives `side` to all cells reachable from `start` without crossing the surface.
void spread(const TetgenMesh& mesh, std::int32_t start, Side side, std::vector<Side>& sides,
            std::vector<std::int32_t>& stack) {
  stack.push_back(start);
  sides[start] = side;
  while (!stack.empty()) {
    const std::int32_t cell = stack.back();
    stack.pop_back();
    for (const std::int32_t next : mesh.neighbours[cell]) {
      if (next < 0 || sides[next] == side) continue;
      if (sides[next] != Side::unknown) throw std::runtime_error("the surface has a gap");
      sides[next] = side;
      stack.push_back(next);
    }
  }
}

}  // namespace

std::vector<Cell> cells_inside(const TetgenMesh& mesh, std::span<const Triangle> triangles) {
  const TriangleTable table(triangles);
  std::vector<Side> sides(mesh.cells.size(), Side::unknown);
  std::vector<std::int32_t> stack;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (int face = 0; face < 4; ++face) {
      if (mesh.neighbours[c][face] >= 0) continue;
      const Side side = table.side_of(sorted_face(mesh.cells[c], face));
      if (sides[c] == Side::unknown) spread(mesh, static_cast<std::int32_t>(c), side, sides, stack);
      if (sides[c] != side) throw std::runtime_error("a region lies inside and outside of the surface");
    }
  }
  std::vector<Cell> inside;
  inside.reserve(mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (sides[c] == Side::inside) inside.push_back(mesh.cells[c]);
  }
  return inside;
}

void check_filling(std::span<const Vec3> points, std::span<const Cell> cells,
                   std::span<const Triangle> triangles) {
  std::uint64_t boundary = 0;
  std::size_t inverted = 0;
  for (const Cell& c : cells) {
    inverted += !geometry::has_positive_volume(points[c[0]], points[c[1]], points[c[2]], points[c[3]]);
    for (int face = 0; face < 4; ++face) boundary += oriented_hash(sorted_face(c, face));
  }
  for (const Triangle& t : triangles) boundary -= oriented_hash(sorted(t[0], t[1], t[2]));
  if (inverted > 0) throw std::runtime_error(std::to_string(inverted) + " tetrahedra are flat or inverted");
  if (boundary != 0) throw std::runtime_error("the boundary of the filling is not the surface");
}

std::vector<std::uint8_t> drop_unused_points(std::vector<Vec3>& points, std::vector<Cell>& cells,
                                             std::size_t first_removable) {
  std::vector<std::uint8_t> used(points.size(), 0);
  for (const Cell& c : cells) {
    for (const auto v : c) used[v] = 1;
  }
  std::vector<mesh::LocalIndex> renumbered(points.size(), -1);
  mesh::LocalIndex next = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!used[v] && v < first_removable)
      throw std::runtime_error("a point of the surface is in no tetrahedron");
    if (!used[v]) continue;
    points[next] = points[v];
    renumbered[v] = next++;
  }
  points.resize(next);
  for (Cell& c : cells) {
    for (auto& v : c) v = renumbered[v];
  }
  return used;
}

void sort_along_curve(std::span<const Vec3> points, std::vector<Cell>& cells) {
  // By radix: a few bits of the key in each pass, the lowest ones first.
  constexpr int passes = 3, bits = 11;
  constexpr std::uint64_t mask = (1 << bits) - 1;
  geometry::Box box;
  for (const Vec3& p : points) box.add(p);
  const Vec3 size = box.size();
  const double scale = static_cast<double>(mask) / std::max({size.x, size.y, size.z});
  struct Place {
    std::uint64_t key;
    std::uint32_t cell;
  };
  std::vector<Place> order(cells.size()), sorted(cells.size());
  std::array<std::array<std::uint32_t, mask + 2>, passes> first{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Cell& c = cells[i];
    const Vec3 q = scale * (0.25 * (points[c[0]] + points[c[1]] + points[c[2]] + points[c[3]]) - box.low);
    const std::uint64_t key = sizing::morton_key(
        {static_cast<std::uint32_t>(q.x), static_cast<std::uint32_t>(q.y), static_cast<std::uint32_t>(q.z)});
    order[i] = {key, static_cast<std::uint32_t>(i)};
    for (int pass = 0; pass < passes; ++pass) ++first[pass][(key >> (pass * bits) & mask) + 1];
  }
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t k = 0; k < mask; ++k) first[pass][k + 1] += first[pass][k];
    for (const Place& place : order) sorted[first[pass][place.key >> (pass * bits) & mask]++] = place;
    order.swap(sorted);
  }
  std::vector<Cell> result(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) result[i] = cells[order[i].cell];
  cells.swap(result);
}

}  // namespace aeroloom::volume
