#include "volume/filling/owned_cells.hpp"

#include "geometry/predicates.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::RegionId;

namespace {

/// Whether a face and a triangle with the same three vertices are oriented alike.
bool same_orientation(const LocalTriangle& face, const LocalTriangle& triangle) {
  const auto at = std::find(triangle.begin(), triangle.end(), face[0]) - triangle.begin();
  return triangle[(at + 1) % 3] == face[1];
}

/// The triangles that bound cells: those of the surface, then border triangles, with no region beyond them.
class Bounds {
public:
  explicit Bounds(const ZoneProblem& problem) : _problem(problem) {}

  std::size_t count() const { return _problem.triangles.size() + _problem.borders.size(); }
  bool is_border(std::size_t t) const { return t >= _problem.triangles.size(); }
  const LocalTriangle& triangle(std::size_t t) const {
    return is_border(t) ? _problem.borders[t - _problem.triangles.size()] : _problem.triangles[t];
  }
  RegionId inside(std::size_t t) const {
    return is_border(t) ? _problem.border_regions[t - _problem.triangles.size()] : _problem.inside[t];
  }
  RegionId outside(std::size_t t) const { return is_border(t) ? mesh::no_region : _problem.outside[t]; }
  /// Which points are on the border.
  std::vector<std::uint8_t> at_border() const {
    std::vector<std::uint8_t> at(_problem.points.size(), 0);
    for (const LocalTriangle& t : _problem.borders) {
      for (const LocalIndex v : t) at[v] = 1;
    }
    return at;
  }

private:
  const ZoneProblem& _problem;
};

LocalTriangle sorted(LocalTriangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Finds border triangles by their lowest vertex, which has only a few.
class BorderTable {
public:
  explicit BorderTable(const ZoneProblem& problem) : _starts(problem.points.size() + 1, 0) {
    for (const LocalTriangle& t : problem.borders) ++_starts[*std::min_element(t.begin(), t.end()) + 1];
    std::partial_sum(_starts.begin(), _starts.end(), _starts.begin());
    _triangles.resize(problem.borders.size());
    std::vector<std::int32_t> next(_starts.begin(), _starts.end() - 1);
    for (std::size_t t = 0; t < problem.borders.size(); ++t) {
      const LocalTriangle vertices = sorted(problem.borders[t]);
      _triangles[next[vertices[0]]++] = {vertices, static_cast<std::int32_t>(t)};
    }
  }

  /// The border triangle with these vertices; -1: none.
  std::int32_t find(const LocalTriangle& t) const {
    const LocalTriangle vertices = sorted(t);
    for (std::int32_t i = _starts[vertices[0]]; i < _starts[vertices[0] + 1]; ++i) {
      if (_triangles[i].vertices == vertices) return _triangles[i].triangle;
    }
    return -1;
  }

private:
  struct Known {
    LocalTriangle vertices;
    std::int32_t triangle;
  };
  std::vector<std::int32_t> _starts;
  std::vector<Known> _triangles;
};

/// Marks the faces of the mesh that are border triangles.
void look_up_borders(const ZoneProblem& problem, const Bounds& bounds, TetgenMesh& mesh) {
  if (problem.borders.empty()) return;
  const BorderTable known(problem);
  // Vertices that TetGen added are never on the border.
  std::vector<std::uint8_t> stands_there = bounds.at_border();
  for (const LocalCell& cell : mesh.cells) {
    for (const LocalIndex v : cell) {
      if (static_cast<std::size_t>(v) >= stands_there.size()) stands_there.resize(v + 1, 0);
    }
  }
  const auto first = static_cast<std::int32_t>(problem.triangles.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const LocalCell& cell = mesh.cells[c];
    std::array<int, 4> there;
    for (int k = 0; k < 4; ++k) there[k] = stands_there[cell[k]];
    const int count = there[0] + there[1] + there[2] + there[3];
    if (count < 3) continue;
    for (int face = 0; face < 4; ++face) {
      const int* corner = mesh::tetrahedron_faces[face];
      if (mesh.neighbours[c][face] <= -2 || there[corner[0]] + there[corner[1]] + there[corner[2]] < 3)
        continue;
      const std::int32_t triangle = known.find(face_of(cell, face));
      if (triangle >= 0) mesh.neighbours[c][face] = -2 - first - triangle;
    }
  }
}

/// Finds the region of cells without lattice vertices.
class RegionSearch {
public:
  RegionSearch(const ZoneProblem& problem, const Bounds& bounds, const TetgenMesh& mesh)
      : _problem(problem),
        _bounds(bounds),
        _at_border(bounds.at_border()),
        _mesh(mesh),
        _first_lattice(static_cast<LocalIndex>(problem.surface_points())),
        _first_added(static_cast<LocalIndex>(problem.points.size())),
        _visit(mesh.cells.size(), 0),
        _found(mesh.cells.size(), unknown_region) {}

  /// Sets the region if the cell has a lattice vertex of the zone off the border; false: it has none.
  /// Vertices of other zones do not count: the cell may reach them through triangles that this zone lacks.
  bool region_from_vertex(std::int32_t cell, RegionId& region) const {
    for (const LocalIndex v : _mesh.cells[cell]) {
      if (v < _first_lattice || v >= _first_added || _problem.owners[v] != Owner::mine) continue;
      if (_at_border[v]) continue;
      region = _problem.regions[v - _first_lattice];
      return true;
    }
    return false;
  }

  /// The region of a cell with vertex v, found in the star of v. All cells that the search passed are in the
  /// same region, which is kept for them.
  RegionId region_in_star(std::int32_t cell, LocalIndex v) {
    if (_found[cell] != unknown_region) return _found[cell];
    const RegionId region = search_star(cell, v);
    if (v >= _first_added) return region;  // triangles around it may be missing here
    for (const std::int32_t c : _open) _found[c] = region;
    return region;
  }

  RegionId region_beside(std::int32_t cell, int face, std::int32_t triangle) const {
    const bool is_inside = same_orientation(face_of(_mesh.cells[cell], face), _bounds.triangle(triangle));
    return is_inside ? _bounds.inside(triangle) : _bounds.outside(triangle);
  }

private:
  static constexpr RegionId unknown_region = mesh::no_region - 1;

  RegionId search_star(std::int32_t cell, LocalIndex v) {
    ++_round;
    _open.assign(1, cell);
    _visit[cell] = _round;
    RegionId region = mesh::no_region;
    for (std::size_t i = 0; i < _open.size(); ++i) {
      const std::int32_t c = _open[i];
      if (region_from_vertex(c, region)) return region;
      for (int face = 0; face < 4; ++face) {
        if (_mesh.cells[c][face] == v) continue;
        const std::int32_t next = _mesh.neighbours[c][face];
        if (next <= -2) return region_beside(c, face, -2 - next);
        if (next < 0 || next == not_requested || _visit[next] == _round) continue;
        _visit[next] = _round;
        _open.push_back(next);
      }
    }
    if (v >= _first_added) return region_around_added();
    throw std::runtime_error("a point of the surface has no triangle around it");
  }

  /// For a point that TetGen added, whose star may have neither. Then other points of the zone in the star
  /// decide, or the triangles that bound it.
  RegionId region_around_added() {
    const std::vector<std::int32_t> star = _open;
    for (const std::int32_t c : star) {
      for (const LocalIndex w : _mesh.cells[c]) {
        if (w < _first_added && _problem.owners[w] == Owner::mine) return region_in_star(c, w);
      }
    }
    for (const std::int32_t c : star) {
      for (const LocalIndex w : _mesh.cells[c]) {
        if (w >= _first_lattice && w < _first_added && !_at_border[w])
          return _problem.regions[w - _first_lattice];
      }
      for (int face = 0; face < 4; ++face) {
        const std::int32_t triangle = -2 - _mesh.neighbours[c][face];
        if (triangle >= 0) return region_beside(c, face, triangle);
      }
    }
    throw std::runtime_error("the region around a point that TetGen added was not found");
  }

  const ZoneProblem& _problem;
  const Bounds& _bounds;
  std::vector<std::uint8_t> _at_border;
  const TetgenMesh& _mesh;
  LocalIndex _first_lattice, _first_added;
  std::vector<std::int32_t> _visit;
  std::vector<RegionId> _found;     // per cell that a search passed
  std::vector<std::int32_t> _open;  // cells of the last search
  std::int32_t _round = 0;
};

/// Checks that all triangles at vertices of the zone are faces of the mesh, with the right vertices. Returns
/// the border triangles that are missing.
std::vector<std::int32_t> require_triangles(const ZoneProblem& problem, const Bounds& bounds,
                                            const TetgenMesh& mesh) {
  std::vector<std::uint8_t> seen(bounds.count(), 0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    for (int face = 0; face < 4; ++face) {
      const std::int32_t next = mesh.neighbours[c][face];
      if (next > -2) continue;
      const std::int32_t t = -2 - next;
      if (sorted(face_of(mesh.cells[c], face)) != sorted(bounds.triangle(t)))
        throw std::runtime_error("a triangle of the surface was changed");
      seen[t] = 1;
    }
  }
  std::vector<std::int32_t> missing;
  for (std::size_t t = 0; t < seen.size(); ++t) {
    const auto& v = bounds.triangle(t);
    if (seen[t] ||
        std::none_of(v.begin(), v.end(), [&](LocalIndex w) { return problem.owners[w] == Owner::mine; }))
      continue;
    if (!bounds.is_border(t)) throw std::runtime_error("a triangle of the surface is missing");
    missing.push_back(static_cast<std::int32_t>(t - problem.triangles.size()));
  }
  return missing;
}

/// Surface points that cells of other zones may have too: points of other zones in cells that are kept, and
/// own points in cells that a lower zone may keep. Where sheets touch, such cells may share no face.
class TouchedPoints {
public:
  TouchedPoints(std::size_t surface_points, const std::vector<Owner>& owners)
      : _owners(owners), _touched(surface_points, 0) {}

  void add(const LocalCell& cell, bool is_kept) {
    for (const LocalIndex v : cell) {
      if (static_cast<std::size_t>(v) < _touched.size() && (_owners[v] == Owner::mine) != is_kept)
        _touched[v] = 1;
    }
  }
  std::vector<LocalIndex> list() const {
    std::vector<LocalIndex> list;
    for (std::size_t v = 0; v < _touched.size(); ++v) {
      if (_touched[v]) list.push_back(static_cast<LocalIndex>(v));
    }
    return list;
  }

private:
  const std::vector<Owner>& _owners;
  std::vector<std::uint8_t> _touched;
};

/// The owners of all vertices. A vertex that TetGen added belongs to the lowest zone in its star.
std::vector<Owner> owners_of(const ZoneProblem& problem, const TetgenMesh& mesh, std::size_t points) {
  std::vector<Owner> owners = problem.owners;
  const std::size_t given = owners.size();
  owners.resize(points, Owner::higher);
  const auto rank = [](Owner o) { return o == Owner::lower ? 0 : o == Owner::mine ? 1 : 2; };
  if (points == given) return owners;
  for (bool changed = true; changed;) {
    changed = false;
    for (const LocalCell& cell : mesh.cells) {
      Owner lowest = Owner::higher;
      for (const LocalIndex v : cell) {
        if (rank(owners[v]) < rank(lowest)) lowest = owners[v];
      }
      for (const LocalIndex v : cell) {
        if (static_cast<std::size_t>(v) < given || rank(owners[v]) <= rank(lowest)) continue;
        owners[v] = lowest;
        changed = true;
      }
    }
  }
  return owners;
}

}  // namespace

OwnedCells select_owned(const ZoneProblem& problem, TetgenMesh mesh, std::span<const Vec3> points) {
  const Bounds bounds(problem);
  look_up_borders(problem, bounds, mesh);
  OwnedCells result;
  result.missing_borders = require_triangles(problem, bounds, mesh);
  if (!result.missing_borders.empty()) return result;
  const std::vector<Owner> owners = owners_of(problem, mesh, points.size());
  RegionSearch search(problem, bounds, mesh);
  TouchedPoints touched(problem.surface_points(), owners);
  std::vector<std::int32_t> kept(mesh.cells.size(), -1);
  std::vector<std::int32_t> origin;  // of the kept ones
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const LocalCell& cell = mesh.cells[i];
    LocalIndex mine = -1;
    bool lower = false;
    for (const LocalIndex v : cell) {
      lower = lower || owners[v] == Owner::lower;
      if (owners[v] == Owner::mine) mine = mine < 0 ? v : std::min(mine, v);
    }
    if (lower) touched.add(cell, false);
    if (mine < 0 || lower) continue;
    const auto c = static_cast<std::int32_t>(i);
    RegionId region = mesh::no_region;
    if (!search.region_from_vertex(c, region)) region = search.region_in_star(c, mine);
    if (region == mesh::no_region) continue;
    if (!geometry::has_positive_volume(points[cell[0]], points[cell[1]], points[cell[2]], points[cell[3]]))
      throw std::runtime_error("a tetrahedron is flat or inverted");
    touched.add(cell, true);
    kept[i] = static_cast<std::int32_t>(result.cells.size());
    origin.push_back(c);
    result.cells.push_back(cell);
    result.regions.push_back(region);
  }
  for (std::size_t k = 0; k < origin.size(); ++k) {
    const auto& neighbours = mesh.neighbours[origin[k]];
    for (int face = 0; face < 4; ++face) {
      const std::int32_t next = neighbours[face];
      if (next == -1)
        throw std::runtime_error("the filling ends at a face that is no triangle of the surface");
      if (next >= 0) {
        if (next == not_requested || kept[next] < 0)
          result.crossings.push_back({static_cast<std::int32_t>(k), face});
        else if (result.regions[kept[next]] != result.regions[k])
          throw std::runtime_error("two regions touch without a triangle of the surface between them");
      } else if (bounds.is_border(-2 - next)) {
        result.borders.push_back({static_cast<std::int32_t>(k), face});
      } else if (same_orientation(face_of(result.cells[k], face), problem.triangles[-2 - next])) {
        result.triangles.push_back(-2 - next);
      }
    }
  }
  result.touched = touched.list();
  return result;
}

}  // namespace aeroloom::volume
