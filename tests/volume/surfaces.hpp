/// Closed surfaces to fill.
#pragma once

#include "volume/volume_mesher.hpp"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace aeroloom::volume::surfaces {

/// Appends `part` to `whole`; `inward` turns its triangles, which makes it a void.
enum class Turn { outward, inward };
inline void append(ClosedSurface& whole, const ClosedSurface& part, Turn turn = Turn::outward) {
  const auto offset = static_cast<mesh::LocalIndex>(whole.points.size());
  whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
  for (auto [a, b, c] : part.triangles) {
    if (turn == Turn::inward) std::swap(b, c);
    whole.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

/// A box with nx, ny, nz squares per axis on its faces, two triangles each.
inline ClosedSurface box(geometry::Vec3 low, geometry::Vec3 high, int nx, int ny, int nz) {
  ClosedSurface surface;
  const int n[3] = {nx, ny, nz};
  std::map<std::array<int, 3>, mesh::LocalIndex> numbers;
  const auto number = [&](std::array<int, 3> at) {
    const auto [place, is_new] = numbers.emplace(at, static_cast<mesh::LocalIndex>(surface.points.size()));
    if (is_new) {
      geometry::Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = at[k] == n[k] ? high[k] : low[k] + (high[k] - low[k]) * at[k] / n[k];
      surface.points.push_back(p);
    }
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const bool top : {false, true}) {
      for (int i = 0; i < n[u]; ++i) {
        for (int j = 0; j < n[v]; ++j) {
          const auto at = [&](int di, int dj) {
            std::array<int, 3> index{};
            index[axis] = top ? n[axis] : 0;
            index[u] = i + di;
            index[v] = j + dj;
            return number(index);
          };
          const auto a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
          const bool diagonal = (i + j) % 2 == 0;
          const std::array<std::array<mesh::LocalIndex, 3>, 2> pair =
              diagonal ? std::array<std::array<mesh::LocalIndex, 3>, 2>{{{a, b, c}, {a, c, d}}}
                       : std::array<std::array<mesh::LocalIndex, 3>, 2>{{{a, b, d}, {b, c, d}}};
          for (auto [p, q, r] : pair) {
            if (!top) std::swap(q, r);
            surface.triangles.push_back({p, q, r});
          }
        }
      }
    }
  }
  return surface;
}

/// A cube of edge 2 r around `center` with n squares per edge.
inline ClosedSurface cube(geometry::Vec3 center, double r, int n) {
  return box(center - geometry::Vec3{r, r, r}, center + geometry::Vec3{r, r, r}, n, n, n);
}

/// A sphere from an icosahedron whose edges are split into `n` parts; edges are about 1.1 r / n long.
inline ClosedSurface sphere(geometry::Vec3 center, double r, int n) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<geometry::Vec3> corners{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                            {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                            {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  const std::vector<std::array<int, 3>> faces{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  ClosedSurface surface;
  std::map<std::vector<std::pair<int, int>>, mesh::LocalIndex> numbers;
  const auto number = [&](const std::array<int, 3>& face, std::array<int, 3> weights) {
    std::vector<std::pair<int, int>> key;
    geometry::Vec3 p;
    for (int k = 0; k < 3; ++k) {
      if (weights[k] > 0) key.emplace_back(face[k], weights[k]);
    }
    std::sort(key.begin(), key.end());
    for (const auto& [corner, weight] : key) p += static_cast<double>(weight) * corners[corner];
    const auto [place, is_new] = numbers.emplace(key, static_cast<mesh::LocalIndex>(surface.points.size()));
    if (is_new) surface.points.push_back(center + r * normalized(p));
    return place->second;
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
  return surface;
}

/// The cube [-2,2]^3 less the unit ball.
inline ClosedSurface cube_with_ball(int cube_squares, int ball_parts) {
  ClosedSurface surface = cube({0, 0, 0}, 2, cube_squares);
  append(surface, sphere({0, 0, 0}, 1, ball_parts), Turn::inward);
  return surface;
}

/// Enclosed volume, by the divergence theorem.
inline double volume(const ClosedSurface& surface) {
  const geometry::Vec3 apex = surface.points.front();
  double sum = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    sum += volume6(surface.points[a], surface.points[c], surface.points[b], apex) / 6;
  }
  return sum;
}

}  // namespace aeroloom::volume::surfaces
