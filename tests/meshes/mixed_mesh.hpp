/// A hand-made mesh of tetrahedra, pyramids, prisms and hexahedra, for all that takes such: the same for any
/// number of ranks, piece p on rank p % size.
///
/// A slab of n by n squares, one high, is cut into prisms (region "lower layer"); on it lies another one, of
/// tetrahedra (region "upper"). Beside the first one stands a row of n cubes, each of five pyramids around
/// its middle and, on the far side, two tetrahedra; on another side a row of n hexahedra. An affine map makes
/// all of it oblique.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::mesh::examples {

struct WholeCell {
  CellShape shape;
  std::vector<int> corners;
  std::int32_t region, piece;
};
struct WholeFace {
  std::vector<int> corners;
  std::int32_t patch;
  std::size_t cell;
};

/// Columns of squares: those of the slabs, then the cubes.
struct SquareColumns {
  int first = 0, last = 0;
};

/// All of the mesh, or some columns of it, before it is cut into pieces.
class MixedMesh {
public:
  MixedMesh(int squares, int pieces) : MixedMesh(squares, SquareColumns{0, squares + 1}) {
    for (WholeCell& cell : cells) cell.piece = cell.piece * pieces / (squares + 1);
    add_faces();
  }
  /// Without faces; the piece of a cell is its column.
  MixedMesh(int squares, SquareColumns columns) : _n(squares) {
    add_slabs(columns);
    if (columns.last > squares) add_cubes();
  }

  /// The number of a point, whatever columns there are.
  GlobalIndex id(int v) const {
    const Place& at = _places[static_cast<std::size_t>(v)];
    return (at[0] * GlobalIndex{2 * _n + 3} + at[1]) * 5 + at[2];
  }

  std::vector<geometry::Vec3> points;
  std::vector<WholeCell> cells;
  std::vector<WholeFace> faces;
  static constexpr std::int32_t wall = 0, symmetry = 1, far = 2, interface = 3;
  std::vector<Patch> patches = {{"wing / lower side", PatchType::wall},
                                {"symmetry", PatchType::symmetry},
                                {"far field", PatchType::farfield},
                                {"interface", PatchType::interior}};
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
    cells.push_back({shape, std::move(corners), region, column});
  }

  void add_slabs(SquareColumns columns) {
    for (int i = columns.first; i < std::min(columns.last, _n); ++i) {
      add_hexahedron(i);
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

  void add_hexahedron(int i) {
    std::vector<int> corners;
    for (const int k : {0, 1}) {
      for (const auto& [x, y] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}})
        corners.push_back(corner(i + x, _n + y, k));
    }
    add(CellShape::hexahedron, corners, 0, i);
  }

  /// Three tetrahedra; diagonals rise from the point of the lower id, so that neighbours agree whatever other
  /// columns there are.
  void add_cut_prism(std::array<int, 3> low, std::array<int, 3> high, int column) {
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int a, int b) { return id(low[a]) < id(low[b]); });
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

  int _n;
  std::map<Place, int> _known;
  std::vector<Place> _places;
};

/// A face of the model: a patch where it bounds one region, or lies between two.
using ModelFace = std::array<std::int32_t, 3>;

/// By face of the mesh: `interface` lies between both regions, or is a baffle in a single one; others bound
/// that of their cell.
inline std::vector<ModelFace> model_faces(const MixedMesh& whole) {
  std::vector<ModelFace> faces;
  for (const WholeFace& face : whole.faces) {
    const bool inner = face.patch == MixedMesh::interface;
    const auto last = static_cast<std::int32_t>(whole.regions.size()) - 1;
    faces.push_back({face.patch, whole.cells[face.cell].region, inner ? last : no_region});
  }
  return faces;
}

/// Cuts the mesh: vertices of a piece by the lowest piece that knows them, then as in the whole mesh.
class MixedCutter {
public:
  explicit MixedCutter(const MixedMesh& whole) : _whole(whole), _of_face(model_faces(whole)) {
    _known_by.resize(whole.points.size());
    for (const WholeCell& cell : whole.cells) {
      for (const int v : cell.corners) _known_by[v].insert(cell.piece);
    }
    const std::set<ModelFace> faces(_of_face.begin(), _of_face.end());
    _faces.assign(faces.begin(), faces.end());
    _entity.assign(whole.points.size(), -1);
    for (std::size_t f = 0; f < whole.faces.size(); ++f) {
      for (const int v : whole.faces[f].corners) _entity[v] = std::max(_entity[v], id_of_face(f));
    }
  }

  DistributedMesh names() const {
    DistributedMesh mesh;
    mesh.regions = _whole.regions;
    for (const Patch& patch : _whole.patches) {
      mesh.patches.push_back(patch.name);
      mesh.patch_types.push_back(patch.type);
    }
    for (const auto& [patch, front, back] : _faces) {
      mesh.faces.push_back(_whole.patches[patch].name + " of " + _whole.regions[front]);
      mesh.sides.push_back({front, back});
    }
    return mesh;
  }

  Piece cut(PieceId id) const {
    Piece piece;
    piece.id = id;
    const std::map<int, LocalIndex> local = add_vertices(piece);
    const auto add = [&](const std::vector<int>& corners, std::vector<LocalIndex>& to) {
      for (const int v : corners) to.push_back(local.at(v));
    };
    std::vector<LocalIndex>* const cells[] = {&piece.cells, &piece.pyramids, &piece.prisms, &piece.hexahedra};
    LocalIndex count = 0;
    for (const CellShape shape : cell_shapes) {
      for (std::int32_t region = 0; region < static_cast<std::int32_t>(_whole.regions.size()); ++region) {
        for (const WholeCell& cell : _whole.cells) {
          if (cell.piece != id || cell.region != region || cell.shape != shape) continue;
          add(cell.corners, *cells[static_cast<std::size_t>(shape)]);
          if (piece.runs.empty() || piece.runs.back().region != region) piece.runs.push_back({region, 0});
          piece.runs.back().end = ++count;
        }
      }
    }
    if (!piece.runs.empty()) piece.region = piece.runs.front().region;
    if (piece.runs.size() == 1) piece.runs.clear();
    for (std::int32_t patch = 0; patch < static_cast<std::int32_t>(_whole.patches.size()); ++patch) {
      for (std::size_t f = 0; f < _whole.faces.size(); ++f) {
        const WholeFace& face = _whole.faces[f];
        if (_whole.cells[face.cell].piece != id || face.patch != patch) continue;
        const bool triangle = face.corners.size() == 3;
        add(face.corners, triangle ? piece.boundary : piece.quads);
        (triangle ? piece.triangle_face : piece.quad_face).push_back(id_of_face(f));
        (triangle ? piece.triangle_patch : piece.quad_patch).push_back(patch);
      }
    }
    return piece;
  }

private:
  std::int32_t id_of_face(std::size_t f) const {
    return static_cast<std::int32_t>(std::lower_bound(_faces.begin(), _faces.end(), _of_face[f]) -
                                     _faces.begin());
  }

  std::map<int, LocalIndex> add_vertices(Piece& piece) const {
    std::vector<std::pair<PieceId, int>> known;
    for (std::size_t v = 0; v < _known_by.size(); ++v) {
      if (_known_by[v].count(piece.id)) known.emplace_back(*_known_by[v].begin(), static_cast<int>(v));
    }
    std::sort(known.begin(), known.end());
    std::map<int, LocalIndex> local;
    for (const auto& [owner, v] : known) {
      const LocalIndex place = piece.vertex_count();
      local[v] = place;
      const geometry::Vec3 p = _whole.points[v];
      piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
      piece.vertex_dimension.push_back(_entity[v] < 0 ? CadDimension::region : CadDimension::face);
      piece.vertex_entity.push_back(std::max(_entity[v], 0));
      if (_known_by[v].size() < 2) continue;
      piece.shared_vertices.push_back(place);
      piece.shared_keys.push_back(running_key(v));
    }
    return local;
  }

  const MixedMesh& _whole;
  std::vector<ModelFace> _of_face, _faces;
  std::vector<std::set<PieceId>> _known_by;
  std::vector<std::int32_t> _entity;
};

inline DistributedMesh distribute(const parallel::Communicator& communicator, const MixedMesh& whole,
                                  int pieces) {
  const MixedCutter cutter(whole);
  DistributedMesh mesh = cutter.names();
  mesh.communicator = communicator;
  mesh.piece_count = pieces;
  for (PieceId id = communicator.rank(); id < pieces; id += communicator.size())
    mesh.pieces.push_back(cutter.cut(id));
  return mesh;
}

/// The mesh above with `squares` along each side.
inline DistributedMesh mixed_mesh(const parallel::Communicator& communicator, int squares = 4,
                                  int pieces = 3) {
  return distribute(communicator, MixedMesh(squares, pieces), pieces);
}

}  // namespace aeroloom::mesh::examples
