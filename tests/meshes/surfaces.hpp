/// Small surfaces to fill, and their way into a distributed mesh.
#pragma once

#include "geometry/predicates.hpp"
#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/mixing.hpp"
#include "parallel/communication/communicator.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/lattice/surface_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::volume::surfaces {

using geometry::Vec3;
using mesh::RegionId;

/// Triangles on CAD faces, counter-clockwise seen from outside of the face's front region.
struct Surface {
  std::vector<Vec3> points;
  std::vector<LocalTriangle> triangles;
  std::vector<std::int32_t> face;      ///< per triangle
  std::vector<mesh::FaceSides> sides;  ///< per face
};

/// Appends `part` to `whole`; `inward` turns its triangles, which makes it a void.
enum class Turn { outward, inward };
inline void append(Surface& whole, const Surface& part, Turn turn = Turn::outward) {
  const auto first_point = static_cast<mesh::LocalIndex>(whole.points.size());
  const auto first_face = static_cast<std::int32_t>(whole.sides.size());
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  whole.sides.insert(whole.sides.end(), part.sides.begin(), part.sides.end());
  for (auto [a, b, c] : part.triangles) {
    if (turn == Turn::inward) std::swap(b, c);
    whole.triangles.push_back({a + first_point, b + first_point, c + first_point});
  }
  for (const std::int32_t f : part.face) whole.face.push_back(f + first_face);
}

/// The same triangles between other regions.
inline Surface between(Surface surface, RegionId front, RegionId back) {
  for (mesh::FaceSides& sides : surface.sides) sides = {front, back};
  return surface;
}

/// The surface around and between the regions of n[0] n[1] n[2] cells of a grid, two triangles per square.
/// `region_of(i, j, k)` is asked for each cell, mesh::no_region outside of all. `place` maps grid to space
/// and keeps the orientation. A CAD face for each plane and pair of regions.
inline Surface voxels(std::array<int, 3> n, const std::function<RegionId(int, int, int)>& region_of,
                      const std::function<Vec3(Vec3)>& place) {
  Surface surface;
  std::map<std::array<int, 3>, mesh::LocalIndex> numbers;
  const auto number = [&](std::array<int, 3> at) {
    const auto [known, is_new] = numbers.emplace(at, static_cast<mesh::LocalIndex>(surface.points.size()));
    if (is_new) surface.points.push_back(place({double(at[0]), double(at[1]), double(at[2])}));
    return known->second;
  };
  const auto region_at = [&](std::array<int, 3> at) {
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] < 0 || at[axis] >= n[axis]) return mesh::no_region;
    }
    return region_of(at[0], at[1], at[2]);
  };
  std::map<std::tuple<int, int, RegionId, RegionId, bool>, std::int32_t> faces;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::array<int, 3> at{};
    for (at[axis] = 0; at[axis] <= n[axis]; ++at[axis]) {
      for (at[u] = 0; at[u] < n[u]; ++at[u]) {
        for (at[v] = 0; at[v] < n[v]; ++at[v]) {
          std::array<int, 3> before = at;
          --before[axis];
          const RegionId low = region_at(before), high = region_at(at);
          if (low == high) continue;
          const bool low_in_front = high == mesh::no_region || (low != mesh::no_region && low < high);
          const RegionId front = low_in_front ? low : high, back = low_in_front ? high : low;
          const auto [face, is_new] = faces.emplace(std::tuple{axis, at[axis], front, back, low_in_front},
                                                    static_cast<std::int32_t>(surface.sides.size()));
          if (is_new) surface.sides.push_back({front, back});
          const auto corner = [&](int du, int dv) {
            std::array<int, 3> c = at;
            c[u] += du, c[v] += dv;
            return number(c);
          };
          const auto a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
          const bool even = (at[u] + at[v]) % 2 == 0;
          for (LocalTriangle t : {even ? LocalTriangle{a, b, c} : LocalTriangle{a, b, d},
                                  even ? LocalTriangle{a, c, d} : LocalTriangle{b, c, d}}) {
            if (!low_in_front) std::swap(t[1], t[2]);
            surface.triangles.push_back(t);
            surface.face.push_back(face->second);
          }
        }
      }
    }
  }
  return surface;
}

/// The map of grids with n cells per axis onto a box.
inline std::function<Vec3(Vec3)> onto(Vec3 low, Vec3 high, std::array<int, 3> n) {
  return [=](Vec3 grid) {
    Vec3 p;
    for (int k = 0; k < 3; ++k)
      p[k] = grid[k] == n[k] ? high[k] : low[k] + (high[k] - low[k]) * grid[k] / n[k];
    return p;
  };
}

/// A box with n squares per axis on its sides.
inline Surface box(Vec3 low, Vec3 high, std::array<int, 3> n) {
  return voxels(
      n, [](int, int, int) { return 0; }, onto(low, high, n));
}

/// A cube of edge 2 r around `center` with n squares per edge.
inline Surface cube(Vec3 center, double r, int n) {
  return box(center - Vec3{r, r, r}, center + Vec3{r, r, r}, {n, n, n});
}

/// A sphere from an icosahedron whose edges are split into `n` parts; edges are about 1.1 r / n long.
inline Surface sphere(Vec3 center, double r, int n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Vec3> corners{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  const std::vector<std::array<int, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  Surface surface;
  surface.sides.push_back({0, mesh::no_region});
  std::map<std::vector<std::pair<int, int>>, mesh::LocalIndex> numbers;
  const auto number = [&](const std::array<int, 3>& face, std::array<int, 3> weights) {
    std::vector<std::pair<int, int>> key;
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      if (weights[k] > 0) key.emplace_back(face[k], weights[k]);
    }
    std::sort(key.begin(), key.end());
    for (const auto& [corner, weight] : key) p += static_cast<double>(weight) * corners[corner];
    const auto [known, is_new] = numbers.emplace(key, static_cast<mesh::LocalIndex>(surface.points.size()));
    if (is_new) surface.points.push_back(center + r * normalized(p));
    return known->second;
  };
  for (const auto& face : faces) {
    const auto at = [&](int i, int j) { return number(face, {n - i - j, i, j}); };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        surface.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < n) surface.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  surface.face.assign(surface.triangles.size(), 0);
  return surface;
}

/// The cube [-2,2]^3 less the unit ball.
inline Surface cube_with_ball(int cube_squares, int ball_parts) {
  Surface surface = cube({0, 0, 0}, 2, cube_squares);
  append(surface, sphere({0, 0, 0}, 1, ball_parts), Turn::inward);
  return surface;
}

/// The cube [-1,1]^3 of n squares per edge, n a multiple of 4: region 1 within [-1/2,1/2]^3, region 0 around.
inline Surface nested_cubes(int n) {
  const auto inner = [=](int i) { return 4 * i >= n && 4 * i < 3 * n; };
  return voxels(
      {n, n, n}, [=](int i, int j, int k) { return inner(i) && inner(j) && inner(k) ? 1 : 0; },
      onto({-1, -1, -1}, {1, 1, 1}, {n, n, n}));
}

/// A surface made of squares along the axes, in general position: vertices moved at random by up to `amount`
/// within their sides and edges, triangles then the Delaunay triangulation of each side. With points off it,
/// all of them are in the Delaunay mesh of the volume, and that is unique.
inline Surface shaken(Surface surface, double amount) {
  const auto axis_of = [&](const LocalTriangle& t) {
    int axis = -1;
    for (int k = 0; k < 3; ++k) {
      const double x = surface.points[t[0]][k];
      if (surface.points[t[1]][k] == x && surface.points[t[2]][k] == x) axis = k;
    }
    return axis;
  };
  std::vector<int> axes;
  std::vector<std::array<bool, 3>> held(surface.points.size());
  for (const LocalTriangle& t : surface.triangles) {
    axes.push_back(axis_of(t));
    for (const auto v : t) {
      for (int k = 0; k < 3; ++k) held[v][k] = held[v][k] || axes.back() < 0 || axes.back() == k;
    }
  }
  std::uint64_t state = 1;
  for (std::size_t v = 0; v < surface.points.size(); ++v) {
    for (int k = 0; k < 3; ++k) {
      state = mesh::mix_in(state, v);
      if (!held[v][k]) surface.points[v][k] += amount * (2 * static_cast<double>(state >> 11) * 0x1p-53 - 1);
    }
  }
  // Flips of edges within a side until none is left (Lawson).
  const auto flip_some = [&] {
    std::map<std::pair<mesh::LocalIndex, mesh::LocalIndex>, std::vector<std::size_t>> at_edge;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k)
        at_edge[std::minmax(surface.triangles[t][k], surface.triangles[t][(k + 1) % 3])].push_back(t);
    }
    std::vector<bool> changed(surface.triangles.size(), false);
    bool any = false;
    for (const auto& [edge, around] : at_edge) {
      if (around.size() != 2 || changed[around[0]] || changed[around[1]]) continue;
      LocalTriangle &s = surface.triangles[around[0]], &t = surface.triangles[around[1]];
      const int axis = axes[around[0]];
      if (axis < 0 || surface.face[around[0]] != surface.face[around[1]]) continue;
      const auto apex = [&edge = edge](LocalTriangle& triangle) {  // first, the edge behind it
        while (triangle[0] == edge.first || triangle[0] == edge.second)
          std::rotate(triangle.begin(), triangle.begin() + 1, triangle.end());
        return triangle[0];
      };
      const auto p = apex(s), q = apex(t);
      const auto flat = [&](mesh::LocalIndex v) {
        return geometry::Vec2{surface.points[v][(axis + 1) % 3], surface.points[v][(axis + 2) % 3]};
      };
      const geometry::Vec2 a = flat(p), b = flat(s[1]), c = flat(s[2]), d = flat(q);
      if (geometry::orient2d(a, b, c) * geometry::in_circle(a, b, c, d) <= 0) continue;
      const auto first = s[1], second = s[2];
      s = {p, first, q};
      t = {p, q, second};
      changed[around[0]] = changed[around[1]] = any = true;
    }
    return any;
  };
  while (flip_some()) {
  }
  return surface;
}

inline RegionId region_count(const Surface& surface) {
  RegionId last = 0;
  for (const mesh::FaceSides& sides : surface.sides) last = std::max({last, sides.front, sides.back});
  return last + 1;
}

/// What a region's triangles enclose, by the divergence theorem.
inline double volume(const Surface& surface, RegionId region = 0) {
  const Vec3 apex = surface.points.front();
  double sum = 0;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const mesh::FaceSides sides = surface.sides[surface.face[t]];
    const double part = volume6(surface.points[a], surface.points[c], surface.points[b], apex) / 6;
    sum += (sides.front == region ? part : 0) - (sides.back == region ? part : 0);
  }
  return sum;
}

/// Triangles of one face each, so many together.
inline std::vector<std::vector<std::size_t>> parts_of_faces(const Surface& surface,
                                                            std::size_t triangles_per_part) {
  std::vector<std::vector<std::size_t>> parts;
  for (std::size_t f = 0; f < surface.sides.size(); ++f) {
    std::vector<std::size_t> part;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      if (surface.face[t] != static_cast<std::int32_t>(f)) continue;
      part.push_back(t);
      if (part.size() == triangles_per_part) parts.push_back(std::move(part)), part = {};
    }
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

/// A surface as pieces of triangles of one CAD face each, piece p on rank p % size, its vertices classified
/// by the number of faces they lie on. The whole mesh is the same for any number of ranks.
inline mesh::DistributedMesh spread(const parallel::Communicator& communicator, const Surface& surface,
                                    std::size_t triangles_per_piece = 40) {
  std::vector<std::set<std::int32_t>> faces_at(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (const auto v : surface.triangles[t]) faces_at[v].insert(surface.face[t]);
  }
  std::map<std::set<std::int32_t>, std::int32_t> curves;
  for (const auto& faces : faces_at) {
    if (faces.size() == 2) curves.emplace(faces, static_cast<std::int32_t>(curves.size()));
  }
  const std::vector<std::vector<std::size_t>> parts = parts_of_faces(surface, triangles_per_piece);
  std::vector<std::set<std::size_t>> parts_at(surface.points.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const std::size_t t : parts[p]) {
      for (const auto v : surface.triangles[t]) parts_at[v].insert(p);
    }
  }
  mesh::DistributedMesh mesh(communicator);
  mesh.kind = mesh::CellKind::triangle;
  mesh.piece_count = static_cast<mesh::PieceId>(parts.size());
  for (std::size_t p = communicator.rank(); p < parts.size(); p += communicator.size()) {
    mesh::Piece& piece = mesh.pieces.emplace_back();
    piece.id = static_cast<mesh::PieceId>(p);
    piece.kind = mesh::CellKind::triangle;
    std::map<mesh::LocalIndex, mesh::LocalIndex> local;
    for (const std::size_t t : parts[p]) {
      for (const auto v : surface.triangles[t]) {
        const auto [known, is_new] = local.emplace(v, piece.vertex_count());
        piece.cells.push_back(known->second);
        if (!is_new) continue;
        const Vec3 x = surface.points[v];
        piece.coordinates.insert(piece.coordinates.end(), {x.x, x.y, x.z});
        const auto& faces = faces_at[v];
        piece.vertex_dimension.push_back(faces.size() == 1   ? mesh::CadDimension::face
                                         : faces.size() == 2 ? mesh::CadDimension::edge
                                                             : mesh::CadDimension::vertex);
        piece.vertex_entity.push_back(faces.size() == 1   ? *faces.begin()
                                      : faces.size() == 2 ? curves.at(faces)
                                                          : v);
        if (parts_at[v].size() < 2) continue;
        piece.shared_vertices.push_back(known->second);
        piece.shared_keys.push_back(static_cast<mesh::SharedVertexKey>(v));
      }
      piece.triangle_face.push_back(surface.face[t]);
      piece.triangle_patch.push_back(surface.face[t] % 2);
    }
  }
  mesh.patches = {"even", "odd"};
  for (std::size_t f = 0; f < surface.sides.size(); ++f) mesh.faces.push_back("face " + std::to_string(f));
  mesh.sides = surface.sides;
  for (RegionId r = 0; region_count(surface) > 1 && r < region_count(surface); ++r)
    mesh.regions.push_back("region " + std::to_string(r));
  return mesh;
}

/// The triangles as a rank gets them, numbered as they are here.
inline std::vector<SurfaceTriangle> numbered_triangles(const Surface& surface) {
  std::vector<SurfaceTriangle> result;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    SurfaceTriangle triangle{};
    triangle.number = static_cast<mesh::GlobalIndex>(t);
    for (int k = 0; k < 3; ++k) {
      triangle.vertices[k] = surface.triangles[t][k];
      triangle.points[k] = surface.points[surface.triangles[t][k]];
    }
    triangle.face = surface.face[t];
    triangle.inside = surface.sides[surface.face[t]].front;
    triangle.outside = surface.sides[surface.face[t]].back;
    result.push_back(triangle);
  }
  return result;
}

}  // namespace aeroloom::volume::surfaces
