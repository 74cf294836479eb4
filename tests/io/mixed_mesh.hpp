/// A hand-made mesh of tetrahedra, pyramids and prisms, for writers and readers: the same for any number of
/// ranks, part p on rank p % size.
///
/// A slab of n by n squares, one high, is cut into prisms (region "lower layer"); on it lies another one, of
/// tetrahedra (region "upper"). Beside the first one stands a row of n cubes, each of five pyramids around
/// its middle and, on the far side, two tetrahedra. An affine map makes all of it oblique.
#pragma once

#include "io/file_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::io::examples {

struct WholeCell {
  CellShape shape;
  std::vector<int> corners;
  std::int32_t region, part;
};
struct WholeFace {
  std::vector<int> corners;
  std::int32_t patch;
  std::size_t cell;
};

/// All of the mesh, before it is cut into parts.
class MixedMesh {
public:
  explicit MixedMesh(int squares, int parts) : _n(squares), _parts(parts) {
    add_slabs();
    add_cubes();
    add_faces();
  }

  std::vector<geometry::Vec3> points;
  std::vector<WholeCell> cells;
  std::vector<WholeFace> faces;
  static constexpr std::int32_t wall = 0, symmetry = 1, far = 2, interface = 3;
  std::vector<mesh::Patch> patches = {{"wing / lower side", mesh::PatchType::wall},
                                      {"symmetry", mesh::PatchType::symmetry},
                                      {"far field", mesh::PatchType::farfield},
                                      {"interface", mesh::PatchType::interior}};
  std::vector<std::string> regions = {"lower layer", "upper"};

  static geometry::Vec3 map(geometry::Vec3 p) {
    return {2 * p.x + 0.25 * p.y, 1.5 * p.y + 0.125 * p.z, p.z + 0.0625 * p.x - 3};
  }

private:
  /// Twice the coordinates of a point before it is mapped.
  using Place = std::array<int, 3>;

  int point(Place place) {
    const auto [found, is_new] = _known.try_emplace(place, static_cast<int>(points.size()));
    if (is_new) {
      points.push_back(map({0.5 * place[0], 0.5 * place[1], 0.5 * place[2]}));
      _places.push_back(place);
    }
    return found->second;
  }
  int corner(int i, int j, int k) { return point({2 * i, 2 * j, 2 * k}); }
  void add(CellShape shape, std::vector<int> corners, std::int32_t region, int column) {
    cells.push_back(
        {shape, std::move(corners), region, static_cast<std::int32_t>(column * _parts / (_n + 1))});
  }

  void add_slabs() {
    for (int i = 0; i < _n; ++i) {
      for (int j = 0; j < _n; ++j) {
        for (const bool upper : {false, true}) {
          // The two ways round a square, along its diagonal.
          const std::array<std::array<int, 2>, 2> turn = {{{1, 0}, {0, 1}}};
          for (int side = 0; side < 2; ++side) {
            std::array<std::array<int, 2>, 3> t = {
                {{i, j}, {i + turn[side][0], j + turn[side][1]}, {i + 1, j + 1}}};
            if (side == 1) std::swap(t[1], t[2]);
            std::array<int, 3> low{}, high{};
            for (int k = 0; k < 3; ++k) {
              low[k] = corner(t[k][0], t[k][1], upper ? 1 : 0);
              high[k] = corner(t[k][0], t[k][1], upper ? 2 : 1);
            }
            if (upper) {
              add_cut_prism(low, high, i);
            } else {
              add(CellShape::prism, {low[0], low[1], low[2], high[0], high[1], high[2]}, 0, i);
            }
          }
        }
      }
    }
  }

  /// Three tetrahedra; diagonals rise from the point of the lower number, so that neighbours agree.
  void add_cut_prism(std::array<int, 3> low, std::array<int, 3> high, int column) {
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return low[a] < low[b]; });
    const auto [a, b, c] = order;
    for (std::vector<int> tet : {std::vector<int>{low[a], low[b], low[c], high[c]},
                                 {low[a], low[b], high[c], high[b]},
                                 {low[a], high[b], high[c], high[a]}}) {
      if (volume6(tet) < 0) std::swap(tet[0], tet[1]);
      add(CellShape::tetrahedron, tet, 1, column);
    }
  }

  double volume6(const std::vector<int>& t) const {
    const geometry::Vec3 a = points[t[0]];
    return dot(cross(points[t[1]] - a, points[t[2]] - a), points[t[3]] - a);
  }

  void add_cubes() {
    for (int j = 0; j < _n; ++j) {
      const int middle = point({2 * _n + 1, 2 * j + 1, 1});
      const auto at = [&](int x, int y, int z) { return corner(_n + x, j + y, z); };
      const std::array<std::array<int, 4>, 5> bases = {{
          {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)},
          {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)},
          {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)},
          {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)},
          {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)},
      }};
      for (auto base : bases) {
        if (volume6({base[0], base[1], base[2], middle}) < 0) std::swap(base[1], base[3]);
        add(CellShape::pyramid, {base[0], base[1], base[2], base[3], middle}, 0, _n);
      }
      for (std::vector<int> tet : {std::vector<int>{at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), middle},
                                   {at(1, 0, 0), at(1, 1, 1), at(1, 0, 1), middle}}) {
        if (volume6(tet) < 0) std::swap(tet[0], tet[1]);
        add(CellShape::tetrahedron, tet, 0, _n);
      }
    }
  }

  /// The patch of a face of one cell alone, by where it lies.
  std::int32_t patch_at(const std::vector<int>& corners) const {
    const auto all_at = [&](int axis, int value) {
      return std::all_of(corners.begin(), corners.end(), [&](int v) { return _places[v][axis] == value; });
    };
    return all_at(2, 0) ? wall : all_at(1, 0) ? symmetry : far;
  }

  void add_faces() {
    std::map<std::vector<int>, std::vector<WholeFace>> met;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      for (const CellFace& face : faces_of(cells[c].shape)) {
        WholeFace found{{}, 0, c};
        for (const std::int8_t k : face) {
          if (k >= 0) found.corners.push_back(cells[c].corners[k]);
        }
        std::vector<int> key = found.corners;
        std::sort(key.begin(), key.end());
        met[key].push_back(found);
      }
    }
    for (auto& [key, sides] : met) {
      if (sides.size() == 1) {
        sides[0].patch = patch_at(sides[0].corners);
        faces.push_back(sides[0]);
      } else if (cells[sides[0].cell].region != cells[sides[1].cell].region) {
        WholeFace& front = cells[sides[0].cell].region == 0 ? sides[0] : sides[1];
        front.patch = interface;
        faces.push_back(front);
      }
    }
  }

  int _n, _parts;
  std::map<Place, int> _known;
  std::vector<Place> _places;
};

/// One part of a mesh; `numbers` of its points, and which part owns each.
inline std::unique_ptr<PartArrays> cut_part(const MixedMesh& whole, std::int32_t id,
                                            const std::vector<mesh::GlobalIndex>& numbers,
                                            const std::vector<std::int32_t>& owner) {
  auto arrays = std::make_unique<PartArrays>();
  std::vector<int> used;
  for (const WholeCell& cell : whole.cells) {
    if (cell.part == id) used.insert(used.end(), cell.corners.begin(), cell.corners.end());
  }
  std::sort(used.begin(), used.end(), [&](int a, int b) { return numbers[a] < numbers[b]; });
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::map<int, mesh::LocalIndex> local;
  for (const int v : used) {
    local[v] = static_cast<mesh::LocalIndex>(arrays->numbers.size());
    arrays->numbers.push_back(numbers[v]);
    arrays->owned.push_back(owner[v] == id ? 1 : 0);
    const geometry::Vec3 p = whole.points[v];
    arrays->coordinates.insert(arrays->coordinates.end(), {p.x, p.y, p.z});
  }
  for (std::int32_t region = 0; region < static_cast<std::int32_t>(whole.regions.size()); ++region) {
    for (const WholeCell& cell : whole.cells) {
      if (cell.part != id || cell.region != region) continue;
      const auto s = static_cast<std::size_t>(cell.shape);
      for (const int v : cell.corners) arrays->cells[s].push_back(local[v]);
      arrays->cell_regions[s].push_back(region);
    }
  }
  for (std::int32_t patch = 0; patch < static_cast<std::int32_t>(whole.patches.size()); ++patch) {
    for (const WholeFace& face : whole.faces) {
      if (whole.cells[face.cell].part != id || face.patch != patch) continue;
      const std::size_t s = face.corners.size() - 3;
      for (const int v : face.corners) arrays->faces[s].push_back(local[v]);
      arrays->face_patches[s].push_back(patch);
    }
  }
  return arrays;
}

inline FileMesh distribute(const parallel::Communicator& communicator, const MixedMesh& whole, int parts) {
  std::vector<std::int32_t> owner(whole.points.size(), parts);
  for (const WholeCell& cell : whole.cells) {
    for (const int v : cell.corners) owner[v] = std::min(owner[v], cell.part);
  }
  std::vector<mesh::GlobalIndex> numbers(whole.points.size());
  mesh::GlobalIndex next = 0;
  for (std::int32_t part = 0; part < parts; ++part) {
    for (std::size_t v = 0; v < owner.size(); ++v) {
      if (owner[v] == part) numbers[v] = next++;
    }
  }
  std::vector<OwnedPart> mine;
  for (std::int32_t id = communicator.rank(); id < parts; id += communicator.size())
    mine.push_back({id, cut_part(whole, id, numbers, owner)});
  return make_file_mesh(communicator, parts, std::move(mine), whole.patches, whole.regions);
}

/// The mesh above with `squares` along each side.
inline FileMesh mixed_mesh(const parallel::Communicator& communicator, int squares = 4, int parts = 3) {
  return distribute(communicator, MixedMesh(squares, parts), parts);
}

}  // namespace aeroloom::io::examples
