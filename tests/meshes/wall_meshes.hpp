/// Small walls for tests of layers, on any number of ranks: see tests/meshes/small_meshes.hpp.
#pragma once

#include "tests/meshes/small_meshes.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <tuple>
#include <vector>

namespace aeroloom::layers::examples {

using geometry::Vec3;

/// The side of a closed shape that the fluid is on.
enum class Fluid { inside, outside };

/// Closed shapes that bound a fluid. Each shape is a CAD face and a patch of its own.
class Shapes {
public:
  /// A ring of bricks around an axis: `place` maps the box from 0 to 1, whose first axis runs around and
  /// meets itself. The other two axes with it are right-handed.
  Shapes& add_ring(std::array<int, 3> n, const std::function<Vec3(Vec3)>& place) {
    return add_bricks({0, 0, 0}, {1, 1, 1}, n, Fluid::inside, place, 1);
  }
  /// A box of bricks, two triangles a square, `n` squares along each axis; its points moved by `place`.
  Shapes& add_box(
      Vec3 low, Vec3 high, std::array<int, 3> n, Fluid fluid,
      const std::function<Vec3(Vec3)>& place = [](Vec3 p) { return p; }) {
    return add_bricks(low, high, n, fluid, place, 0);
  }
  /// From a cube of n^3 bricks.
  Shapes& add_sphere(Vec3 center, double radius, int n, Fluid fluid) {
    return add_box({-1, -1, -1}, {1, 1, 1}, {n, n, n}, fluid, [=](Vec3 p) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::tan(p[axis] * M_PI / 4);  // equal angles
      return center + radius * normalized(p);
    });
  }

  /// Points at the same place become one.
  void merge_points() {
    std::map<std::tuple<double, double, double>, int> numbers;
    std::vector<int> first;
    for (const Vec3 p : _mesh.points)
      first.push_back(
          numbers.emplace(std::tuple(p.x, p.y, p.z), static_cast<int>(first.size())).first->second);
    for (std::vector<int>& cell : _mesh.cells) {
      for (int& v : cell) v = first[v];
    }
  }

  Shapes& move(const std::function<Vec3(Vec3)>& place) {
    for (Vec3& p : _mesh.points) p = place(p);
    return *this;
  }
  /// Gives triangles another CAD face, and a patch of its own, by their middle.
  Shapes& label(const std::function<int(Vec3)>& face_at) {
    _shapes = 0;
    for (std::size_t t = 0; t < _mesh.cells.size(); ++t) {
      Vec3 sum;
      for (const int v : _mesh.cells[t]) sum += _mesh.points[v];
      _mesh.faces[t] = _mesh.patches[t] = face_at(sum / 3);
      _shapes = std::max(_shapes, _mesh.faces[t] + 1);
    }
    return *this;
  }

  /// Each CAD face in so many slices along x.
  mesh::DistributedMesh distribute_faces(const parallel::Communicator& communicator, int slices) const {
    mesh::examples::WholeMesh whole = complete();
    whole.piece_of_cell.assign(whole.cells.size(), 0);
    for (int face = 0; face < _shapes; ++face) {
      std::vector<std::size_t> cells;
      for (const std::size_t t : along_x()) {
        if (whole.faces[t] == face) cells.push_back(t);
      }
      for (std::size_t i = 0; i < cells.size(); ++i)
        whole.piece_of_cell[cells[i]] = face * slices + static_cast<int>(i * slices / cells.size());
    }
    return mesh::examples::distribute(communicator, whole, _shapes * slices);
  }
  /// In pieces of consecutive slices along x.
  mesh::DistributedMesh distribute(const parallel::Communicator& communicator, int pieces) const {
    mesh::examples::WholeMesh whole = complete();
    whole.piece_of_cell.resize(whole.cells.size());
    const std::vector<std::size_t> order = along_x();
    for (std::size_t i = 0; i < order.size(); ++i)
      whole.piece_of_cell[order[i]] = static_cast<int>(i * pieces / order.size());
    return mesh::examples::distribute(communicator, whole, pieces);
  }

private:
  /// The first `around` axes, none or one, meet themselves.
  Shapes& add_bricks(Vec3 low, Vec3 high, std::array<int, 3> n, Fluid fluid,
                     const std::function<Vec3(Vec3)>& place, int around) {
    std::map<std::array<int, 3>, int> numbers;
    const auto number = [&](std::array<int, 3> at) {
      if (around == 1) at[0] %= n[0];
      const auto [found, is_new] = numbers.emplace(at, static_cast<int>(_mesh.points.size()));
      if (is_new) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
          p[axis] =
              at[axis] == n[axis] ? high[axis] : low[axis] + (high[axis] - low[axis]) * at[axis] / n[axis];
        _mesh.points.push_back(place(p));
      }
      return found->second;
    };
    for (int axis = around; axis < 3; ++axis) {
      for (const int end : {0, n[axis]}) {
        const int u = (axis + 1) % 3, w = (axis + 2) % 3;
        for (int i = 0; i < n[u]; ++i) {
          for (int j = 0; j < n[w]; ++j) {
            std::array<int, 3> at{};
            at[axis] = end;
            const auto corner = [&](int di, int dj) {
              at[u] = i + di, at[w] = j + dj;
              return number(at);
            };
            const std::array<int, 4> square{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
            const bool outward = end != 0;  // the normal of the square points out of the box
            const int first = (i + j) % 2;  // diagonals alternate
            for (const std::array<int, 3>& t : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
              add({square[(t[0] + first) % 4], square[(t[1] + first) % 4], square[(t[2] + first) % 4]},
                  outward == (fluid == Fluid::inside));
            }
          }
        }
      }
    }
    end_shape();
    return *this;
  }
  mesh::examples::WholeMesh complete() const {
    mesh::examples::WholeMesh whole = _mesh;
    whole.kind = mesh::CellKind::triangle;
    whole.dimensions.assign(whole.points.size(), mesh::CadDimension::face);
    whole.entities.assign(whole.points.size(), 0);
    for (int shape = 0; shape < _shapes; ++shape) {
      whole.face_names.push_back("face " + std::to_string(shape));
      whole.patch_names.push_back("patch " + std::to_string(shape));
    }
    return whole;
  }
  /// Triangles by the place of their middles.
  std::vector<std::size_t> along_x() const {
    std::vector<std::tuple<double, std::size_t>> order;
    for (std::size_t t = 0; t < _mesh.cells.size(); ++t) {
      double x = 0;
      for (const int v : _mesh.cells[t]) x += _mesh.points[v].x;
      order.emplace_back(x, t);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::size_t> triangles;
    for (const auto& [x, t] : order) triangles.push_back(t);
    return triangles;
  }
  void add(std::array<int, 3> corners, bool as_given) {
    if (!as_given) std::swap(corners[1], corners[2]);
    _mesh.cells.emplace_back(corners.begin(), corners.end());
    _mesh.faces.push_back(_shapes);
    _mesh.patches.push_back(_shapes);
  }
  void end_shape() { ++_shapes; }

  mesh::examples::WholeMesh _mesh;
  int _shapes = 0;
};

}  // namespace aeroloom::layers::examples
