/// Tiny meshes for tests, defined for any rank count: piece p lives on rank p % size, and the mesh is the
/// same whatever the communicator. On Communicator::self() one rank holds all of it.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace aeroloom::mesh::examples {

/// Simplices of a whole mesh, before it is cut into pieces. Vertices are numbered over the whole mesh.
struct WholeMesh {
  CellKind kind = CellKind::tetrahedron;
  std::vector<geometry::Vec3> points;
  std::vector<CadDimension> dimensions;
  std::vector<std::int32_t> entities;
  std::vector<std::vector<int>> cells;
  std::vector<int> piece_of_cell;
  std::vector<std::array<int, 3>> boundary;  ///< of a tetrahedral mesh
  std::vector<int> piece_of_triangle;
  std::vector<std::int32_t> faces, patches;  ///< per boundary triangle or triangular cell
  std::vector<std::string> face_names, patch_names;
};

/// The vertices of a whole mesh that several pieces know.
inline std::set<int> shared_vertices(const WholeMesh& whole) {
  std::map<int, std::set<int>> known_by;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const int v : whole.cells[c]) known_by[v].insert(whole.piece_of_cell[c]);
  }
  std::set<int> shared;
  for (const auto& [vertex, pieces] : known_by) {
    if (pieces.size() > 1) shared.insert(vertex);
  }
  return shared;
}

/// One piece of a whole mesh; its vertices in the order its cells meet them. shared-vertex keys are
/// arbitrary but fixed.
inline Piece cut_piece(const WholeMesh& whole, PieceId id, const std::set<int>& shared) {
  Piece piece;
  piece.id = id;
  piece.kind = whole.kind;
  std::map<int, LocalIndex> local;
  const auto vertex = [&](int v) {
    const auto [found, is_new] = local.emplace(v, piece.vertex_count());
    if (!is_new) return found->second;
    const geometry::Vec3 p = whole.points[v];
    piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
    piece.vertex_dimension.push_back(whole.dimensions[v]);
    piece.vertex_entity.push_back(whole.entities[v]);
    if (shared.count(v)) {
      piece.shared_vertices.push_back(found->second);
      const std::uint32_t anywhere =
          0x9e3779b9U * static_cast<std::uint32_t>(v + 1);  // keys in another order than vertices
      piece.shared_keys.push_back(curve_vertex_key(static_cast<std::int32_t>(anywhere >> 2), v));
    }
    return found->second;
  };
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    if (whole.piece_of_cell[c] != id) continue;
    for (const int v : whole.cells[c]) piece.cells.push_back(vertex(v));
    if (whole.kind == CellKind::triangle) {
      piece.triangle_face.push_back(whole.faces[c]);
      piece.triangle_patch.push_back(whole.patches[c]);
    }
  }
  for (std::size_t t = 0; t < whole.boundary.size(); ++t) {
    if (whole.piece_of_triangle[t] != id) continue;
    for (const int v : whole.boundary[t]) piece.boundary.push_back(vertex(v));
    piece.triangle_face.push_back(whole.faces[t]);
    piece.triangle_patch.push_back(whole.patches[t]);
  }
  return piece;
}

/// The pieces of a whole mesh that belong on this rank.
inline DistributedMesh distribute(const parallel::Communicator& communicator, const WholeMesh& whole,
                                  int pieces) {
  DistributedMesh mesh(communicator);
  mesh.kind = whole.kind;
  mesh.piece_count = pieces;
  mesh.patches = whole.patch_names;
  mesh.faces = whole.face_names;
  const std::set<int> shared = shared_vertices(whole);
  for (PieceId p = communicator.rank(); p < pieces; p += communicator.size()) {
    mesh.pieces.push_back(cut_piece(whole, p, shared));
  }
  return mesh;
}

/// Finds the faces that only one tetrahedron has and makes them the boundary, in the piece of their
/// tetrahedron. Each gets the CAD face and patch that `label(triangle)` returns as a pair.
template <class Label>
void add_boundary(WholeMesh& whole, const Label& label) {
  std::map<std::array<int, 3>, int> uses;
  const auto corners = [&](std::size_t c, int f) {
    const auto& cell = whole.cells[c];
    return std::array{cell[tetrahedron_faces[f][0]], cell[tetrahedron_faces[f][1]],
                      cell[tetrahedron_faces[f][2]]};
  };
  const auto sorted = [](std::array<int, 3> v) {
    std::sort(v.begin(), v.end());
    return v;
  };
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (int f = 0; f < 4; ++f) ++uses[sorted(corners(c, f))];
  }
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (int f = 0; f < 4; ++f) {
      if (uses[sorted(corners(c, f))] != 1) continue;
      whole.boundary.push_back(corners(c, f));
      whole.piece_of_triangle.push_back(whole.piece_of_cell[c]);
      const auto [face, patch] = label(whole.boundary.back());
      whole.faces.push_back(face);
      whole.patches.push_back(patch);
    }
  }
}

/// Two tetrahedra that share a face, one in each of two pieces.
inline DistributedMesh two_tets(const parallel::Communicator& communicator) {
  WholeMesh whole;
  whole.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.2, -1}};
  whole.dimensions.assign(5, CadDimension::vertex);
  whole.entities = {0, 1, 2, 3, 4};
  whole.cells = {{0, 1, 2, 3}, {0, 2, 1, 4}};
  whole.piece_of_cell = {0, 1};
  whole.face_names = {"upper", "lower"};
  whole.patch_names = {"wall"};
  add_boundary(
      whole, [](const auto& t) { return std::pair(*std::max_element(t.begin(), t.end()) == 4 ? 1 : 0, 0); });
  return distribute(communicator, whole, 2);
}

/// `count` >= 3 tetrahedra around one edge, each in a piece of its own: the edge is known by all of them.
inline DistributedMesh fan(const parallel::Communicator& communicator, int count) {
  WholeMesh whole;
  whole.points = {{0, 0, -0.5}, {0, 0, 0.5}};
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    whole.points.push_back({std::cos(angle), std::sin(angle), 0});
    whole.cells.push_back({0, 2 + i, 2 + (i + 1) % count, 1});
    whole.piece_of_cell.push_back(i);
  }
  whole.dimensions.assign(whole.points.size(), CadDimension::face);
  whole.entities.assign(whole.points.size(), 0);
  whole.face_names = {"rim"};
  whole.patch_names = {"wall"};
  add_boundary(whole, [](const auto&) { return std::pair(0, 0); });
  return distribute(communicator, whole, count);
}

/// The unit cube as n^3 cubes of six tetrahedra, in `pieces` runs of cubes of about equal length. Interior
/// vertices are moved a little, so tetrahedra differ. CAD faces 0 to 5 are x-, x+, y-, y+, z-, z+; patch =
/// face / 2.
inline WholeMesh whole_cube(int n, int pieces) {
  WholeMesh whole;
  const int row = n + 1;
  const auto jitter = [](int v, int axis) {
    const auto bits = (static_cast<std::uint64_t>(v) * 3 + axis + 1) * 0x9e3779b97f4a7c15ULL;
    return 0.1 * (static_cast<double>(bits >> 40) / (1 << 23) - 1);
  };
  for (int v = 0; v < row * row * row; ++v) {
    const int at[3] = {v % row, v / row % row, v / (row * row)};
    const auto on_side = std::count_if(at, at + 3, [n](int i) { return i == 0 || i == n; });
    geometry::Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = (at[axis] + (on_side == 0 ? jitter(v, axis) : 0)) / n;
    whole.points.push_back(p);
    whole.dimensions.push_back(static_cast<CadDimension>(3 - on_side));
    int face = 0;
    for (int axis = 2; axis >= 0; --axis)
      face = at[axis] == 0 ? 2 * axis : at[axis] == n ? 2 * axis + 1 : face;
    whole.entities.push_back(on_side == 1 ? face : on_side == 0 ? 0 : v);
  }
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {1, 0, 2}, {2, 1, 0}};
  for (int cube = 0; cube < n * n * n; ++cube) {
    const int corner = cube % n + row * (cube / n % n) + row * row * (cube / (n * n));
    const int step[3] = {1, row, row * row};
    for (int o = 0; o < 6; ++o) {
      std::vector<int> cell{corner};
      for (const int axis : orders[o]) cell.push_back(cell.back() + step[axis]);
      if (o >= 3) std::swap(cell[2], cell[3]);  // odd orders are mirror images
      whole.cells.push_back(cell);
      whole.piece_of_cell.push_back(static_cast<int>(static_cast<std::int64_t>(cube) * pieces / (n * n * n)));
    }
  }
  whole.face_names = {"x-", "x+", "y-", "y+", "z-", "z+"};
  whole.patch_names = {"x sides", "y sides", "z sides"};
  add_boundary(whole, [&](const std::array<int, 3>& t) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const bool on = std::all_of(t.begin(), t.end(), [&](int v) { return whole.points[v][axis] == side; });
        if (on) return std::pair(2 * axis + side, axis);
      }
    }
    return std::pair(-1, -1);
  });
  return whole;
}

inline DistributedMesh cube(const parallel::Communicator& communicator, int n, int pieces) {
  return distribute(communicator, whole_cube(n, pieces), pieces);
}

/// The boundary of that cube as a surface mesh: the same triangles, in `pieces` runs of about equal length.
inline DistributedMesh cube_surface(const parallel::Communicator& communicator, int n, int pieces) {
  WholeMesh whole = whole_cube(n, 1);
  whole.kind = CellKind::triangle;
  whole.cells.clear();
  whole.piece_of_cell.clear();
  const std::size_t count = whole.boundary.size();
  for (std::size_t t = 0; t < count; ++t) {
    whole.cells.emplace_back(whole.boundary[t].begin(), whole.boundary[t].end());
    whole.piece_of_cell.push_back(static_cast<int>(t * pieces / count));
  }
  whole.boundary.clear();
  return distribute(communicator, whole, pieces);
}

}  // namespace aeroloom::mesh::examples
