#include "volume/filling/zone_piece.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::Piece;
using mesh::RegionId;

namespace {

class PieceMaker {
public:
  PieceMaker(const ZoneInput& input, const ZoneFilling& filling, bool surface_numbers)
      : _input(input),
        _filling(filling),
        _surface_numbers(surface_numbers),
        _shared(input.problem.points.size(), 0) {
    mark_shared();
  }

  Piece make(RegionId region, CoreSide& side) const {
    const OwnedCells& owned = _filling.owned;
    Piece piece;
    piece.id = region;
    piece.region = region;
    std::vector<LocalIndex> number(_input.problem.points.size() + _filling.added.size(), -1);
    std::size_t count = 0;
    for (std::size_t c = 0; c < owned.cells.size(); ++c) {
      if (owned.regions[c] != region) continue;
      ++count;
      for (const LocalIndex v : owned.cells[c]) number[v] = 0;
    }
    add_vertices(region, number, piece);
    note_core_side(region, number, side);
    piece.cells.reserve(4 * count);
    for (std::size_t c = 0; c < owned.cells.size(); ++c) {
      if (owned.regions[c] != region) continue;
      for (const LocalIndex v : owned.cells[c]) piece.cells.push_back(number[v]);
    }
    for (const std::int32_t t : owned.triangles) {
      if (_input.problem.inside[t] != region) continue;
      for (const LocalIndex v : _input.problem.triangles[t]) piece.boundary.push_back(number[v]);
      piece.triangle_face.push_back(_input.face[t]);
      piece.triangle_patch.push_back(_input.patch[t]);
    }
    return piece;
  }

  std::vector<ZoneFace> faces() const {
    std::vector<ZoneFace> result;
    for (const Crossing& crossing : _filling.owned.crossings) {
      ZoneFace face{};
      face.zone = _input.zone;
      face.region = _filling.owned.regions[crossing.cell];
      LocalTriangle v = face_of(_filling.owned.cells[crossing.cell], crossing.face);
      const auto order = [&](int i, int j) {
        if (vertex_key(v[j]) < vertex_key(v[i])) std::swap(v[i], v[j]), face.odd ^= 1;
      };
      order(0, 1), order(1, 2), order(0, 1);
      for (int k = 0; k < 3; ++k) {
        face.vertices[k] = vertex_key(v[k]);
        face.leaves[k] = leaf(v[k]);
      }
      result.push_back(face);
    }
    return result;
  }

private:
  /// `number` has the local index in the piece for each vertex of the zone.
  void note_core_side(RegionId region, const std::vector<LocalIndex>& number, CoreSide& side) const {
    for (std::size_t v = _input.problem.surface_points(); v < given(); ++v) {
      if (number[v] < 0) continue;
      if (side.lattice.empty()) side.first_lattice = number[v];
      side.lattice.push_back(static_cast<std::int64_t>(_input.vertex_keys[v]) - _input.surface_vertices);
    }
    for (const Crossing& border : _filling.owned.borders) {
      if (_filling.owned.regions[border.cell] != region) continue;
      const auto [a, b, c] = face_of(_filling.owned.cells[border.cell], border.face);
      side.borders.push_back({number[a], number[b], number[c]});
    }
  }

  std::size_t given() const { return _input.problem.points.size(); }
  mesh::SharedVertexKey vertex_key(LocalIndex v) const {
    if (static_cast<std::size_t>(v) < given()) return _input.vertex_keys[v];
    return mesh::added_key(_input.zone, static_cast<std::int64_t>(v) - static_cast<std::int64_t>(given()));
  }
  LeafNumber leaf(LocalIndex v) const {
    return static_cast<std::size_t>(v) < given() ? _input.leaves[v] : -1;
  }

  /// Marks vertices on faces to other zones, and where triangles of several regions meet.
  void mark_shared() {
    for (const Crossing& crossing : _filling.owned.crossings) {
      for (const LocalIndex v : face_of(_filling.owned.cells[crossing.cell], crossing.face))
        if (static_cast<std::size_t>(v) < given()) _shared[v] = 1;
    }
    for (const LocalIndex v : _filling.owned.touched) _shared[v] = 1;
    const ZoneProblem& problem = _input.problem;
    std::vector<RegionId> first(problem.surface_points(), mesh::no_region);
    for (std::size_t t = 0; t < problem.triangles.size(); ++t) {
      for (const RegionId region : {problem.inside[t], problem.outside[t]}) {
        if (region == mesh::no_region) continue;
        for (const LocalIndex v : problem.triangles[t]) {
          if (first[v] == mesh::no_region) first[v] = region;
          if (first[v] != region) _shared[v] = 1;
        }
      }
    }
  }

  /// Adds the vertices that are used, in their order.
  void add_vertices(RegionId region, std::vector<LocalIndex>& number, Piece& piece) const {
    const std::size_t surface_points = _input.problem.surface_points();
    const auto used = static_cast<std::size_t>(std::count(number.begin(), number.end(), 0));
    piece.coordinates.reserve(3 * used);
    piece.vertex_dimension.reserve(used);
    piece.vertex_entity.reserve(used);
    LocalIndex next = 0;
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] < 0) continue;
      number[v] = next++;
      const Vec3 p = v < given() ? _input.problem.points[v] : _filling.added[v - given()];
      piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
      const bool on_surface = v < surface_points;
      piece.vertex_dimension.push_back(on_surface ? _input.dimension[v] : mesh::CadDimension::region);
      piece.vertex_entity.push_back(on_surface ? _input.entity[v] : region);
      if (_surface_numbers)
        piece.surface_numbers.push_back(on_surface ? static_cast<mesh::GlobalIndex>(_input.vertex_keys[v])
                                                   : -1);
      if (v >= given() || !_shared[v]) continue;
      piece.shared_vertices.push_back(number[v]);
      piece.shared_keys.push_back(_input.vertex_keys[v]);
    }
  }

  const ZoneInput& _input;
  const ZoneFilling& _filling;
  bool _surface_numbers;
  std::vector<std::uint8_t> _shared;  // per given point
};

}  // namespace

ZoneResult make_pieces(const ZoneInput& input, const ZoneFilling& filling, bool surface_numbers) {
  ZoneResult result;
  result.zone = input.zone;
  std::vector<RegionId> regions = filling.owned.regions;
  geometry::sort_unique(regions);
  const PieceMaker maker(input, filling, surface_numbers);
  for (const RegionId region : regions)
    result.pieces.push_back(maker.make(region, result.core_sides.emplace_back()));
  result.faces = maker.faces();
  result.steiner_points = static_cast<std::int64_t>(filling.added.size());
  result.tetrahedra = static_cast<std::int64_t>(filling.owned.cells.size());
  return result;
}

mesh::DistributedMesh assemble_mesh(const mesh::DistributedMesh& surface,
                                    std::map<ZoneIndex, ZoneResult>& results, std::vector<Piece> core,
                                    ZoneIndex zones) {
  struct PieceRegion {
    std::int32_t place;  ///< a zone, or a range of the core after them
    RegionId region;
    auto operator<=>(const PieceRegion&) const = default;
  };
  std::vector<PieceRegion> rows;
  for (const auto& [zone, result] : results) {
    for (const Piece& piece : result.pieces) rows.push_back({zone, piece.region});
  }
  for (const Piece& piece : core) rows.push_back({zones + piece.id, piece.region});
  rows = surface.communicator.gather_sorted(rows);
  mesh::DistributedMesh mesh(surface.communicator);
  mesh.piece_count = static_cast<mesh::PieceId>(rows.size());
  const auto add = [&](std::int32_t place, Piece& piece) {
    piece.id = static_cast<mesh::PieceId>(
        std::lower_bound(rows.begin(), rows.end(), PieceRegion{place, piece.region}) - rows.begin());
    mesh.pieces.push_back(std::move(piece));
  };
  for (auto& [zone, result] : results) {
    for (Piece& piece : result.pieces) add(zone, piece);
  }
  for (Piece& piece : core) add(zones + piece.id, piece);
  mesh.patches = surface.patches;
  mesh.faces = surface.faces;
  mesh.regions = surface.regions;
  mesh.sides = surface.sides;
  return mesh;
}

}  // namespace aeroloom::volume
