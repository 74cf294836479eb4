/// Surfaces around a flow, for tests: grids of triangles that share vertices where they have the same points.
#pragma once

#include "tests/meshes/small_meshes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::picture::examples {

using geometry::Vec3;

/// A surface mesh in the making. Each grid is a CAD face in two pieces.
class SurfaceBuilder {
public:
  /// Triangles over [0,1]^2, nu by nv squares; the normal du x dv points out of the flow.
  void add_grid(int nu, int nv, const std::function<Vec3(double, double)>& place, int patch) {
    const auto at = [&](int i, int j) { return vertex(place(double(i) / nu, double(j) / nv)); };
    for (int j = 0; j < nv; ++j) {
      for (int i = 0; i < nu; ++i) {
        const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        const int piece = 2 * _faces + (2 * i >= nu ? 1 : 0);
        add_triangle({a, b, c}, piece, patch);
        add_triangle({a, c, d}, piece, patch);
      }
    }
    ++_faces;
  }

  /// The walls of a box as seen by a flow inside of it (or around it), six faces.
  void add_box(Vec3 low, Vec3 high, int n, bool flow_inside, int patch) {
    const Vec3 size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool is_high : {false, true}) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        add_grid(
            n, n,
            [&](double s, double t) {
              if (is_high != flow_inside) std::swap(s, t);
              Vec3 p;
              p[axis] = is_high ? high[axis] : low[axis];
              p[u] = low[u] + s * size[u];
              p[v] = low[v] + t * size[v];
              return p;
            },
            patch);
      }
    }
  }

  mesh::DistributedMesh distribute(const parallel::Communicator& communicator,
                                   std::vector<std::string> patches) {
    _whole.kind = mesh::CellKind::triangle;
    _whole.dimensions.assign(_whole.points.size(), mesh::CadDimension::face);
    _whole.entities.assign(_whole.points.size(), 0);
    _whole.patch_names = std::move(patches);
    for (int f = 0; f < _faces; ++f) _whole.face_names.push_back("face_" + std::to_string(f));
    return mesh::examples::distribute(communicator, _whole, 2 * _faces);
  }

private:
  int vertex(Vec3 p) {
    const auto rounded = [](double x) { return std::llround(x * 1e7); };
    const auto [found, is_new] =
        _numbers.emplace(std::tuple(rounded(p.x), rounded(p.y), rounded(p.z)), _whole.points.size());
    if (is_new) _whole.points.push_back(p);
    return static_cast<int>(found->second);
  }
  void add_triangle(const std::array<int, 3>& v, int piece, int patch) {
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) return;
    _whole.cells.push_back({v[0], v[1], v[2]});
    _whole.piece_of_cell.push_back(piece);
    _whole.faces.push_back(_faces);
    _whole.patches.push_back(patch);
  }

  mesh::examples::WholeMesh _whole;
  std::map<std::tuple<long long, long long, long long>, std::size_t> _numbers;
  int _faces = 0;
};

/// A wing without ends, along y from -2 to 2, nose at x = -1, in a box. Patches: "far", "wing".
inline mesh::DistributedMesh wing_in_box(const parallel::Communicator& communicator) {
  SurfaceBuilder builder;
  builder.add_box({-6, -5, -4}, {7, 5, 4}, 6, true, 0);
  for (const double side : {-1.0, 1.0}) {
    builder.add_grid(
        40, 48,
        [side](double s, double t) {
          const double angle = side > 0 ? M_PI * s : M_PI * (1 + s);
          return Vec3{std::cos(angle), 4 * t - 2, 0.12 * std::sin(angle)};
        },
        1);
  }
  return builder.distribute(communicator, {"far", "wing"});
}

/// A step, along y from -2 to 2, with a crease at x = 2, z = 1, in a box. Patches: "far", "step".
inline mesh::DistributedMesh step_in_box(const parallel::Communicator& communicator) {
  SurfaceBuilder builder;
  builder.add_box({-12, -10, -9}, {16, 10, 11}, 6, true, 0);
  const std::vector<Vec3> section = {{0, 0, 0}, {4, 0, 0}, {4, 0, 1}, {2, 0, 1},
                                     {2, 0, 2}, {0, 0, 2}, {0, 0, 0}};
  for (std::size_t i = 0; i + 1 < section.size(); ++i) {
    const Vec3 a = section[i], b = section[i + 1];
    builder.add_grid(
        6, 24,
        [=](double s, double t) {
          return a + s * (b - a) + Vec3{0, 4 * t - 2, 0};
        },
        1);
  }
  return builder.distribute(communicator, {"far", "step"});
}

/// A box with the flow inside.
inline mesh::DistributedMesh plain_box(const parallel::Communicator& communicator) {
  SurfaceBuilder builder;
  builder.add_box({0, 0, 0}, {2, 1, 1}, 6, true, 0);
  return builder.distribute(communicator, {"walls"});
}

}  // namespace aeroloom::picture::examples
