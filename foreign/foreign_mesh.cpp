#include "foreign/foreign_mesh.hpp"

#include "io/vtk/vtk_reader.hpp"
#include "mesh/tet_faces.hpp"
#include "mesh/tokens.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "partition/graph_partition.hpp"
#include "partition/piece_size.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <fmt/format.h>

namespace aeroloom::foreign {
namespace {

using mesh::LocalIndex;
using mesh::Piece;
using mesh::PieceId;
using mesh::RegionId;

/// Cuts regions into pieces and builds them on the rank that read the file.
class ForeignMesh {
public:
  ForeignMesh(io::TetrahedraFile file, const std::string& path, std::optional<std::int64_t> piece_tets)
      : _file(std::move(file)),
        _path(path),
        _piece_tets(
            piece_tets.value_or(partition::suitable_piece_tets(static_cast<double>(_file.tets.size())))),
        _faces(mesh::sorted_faces(_file.tets)) {}

  mesh::DistributedMesh build() {
    require_conformity();
    mesh::DistributedMesh mesh;
    mesh.kind = mesh::CellKind::tetrahedron;
    mesh.regions = _file.region_names;
    cut();
    name_faces(mesh);
    mesh.piece_count = _pieces;
    build_pieces(mesh);
    return mesh;
  }

private:
  void require_conformity() const {
    for (std::size_t i = 2; i < _faces.size(); ++i) {
      if (_faces[i].key != _faces[i - 2].key) continue;
      throw std::runtime_error(fmt::format(
          "'{}': more than two tetrahedra share the face of points {}, {} and {}; the mesh does not conform",
          _path, _faces[i].key[0], _faces[i].key[1], _faces[i].key[2]));
    }
  }

  void cut();
  void cut_region(const std::vector<LocalIndex>& tets);
  void name_faces(mesh::DistributedMesh& mesh);
  void build_pieces(mesh::DistributedMesh& mesh);
  std::vector<char> vertices_in_several_pieces() const;

  io::TetrahedraFile _file;
  std::string _path;
  std::int64_t _piece_tets;
  std::vector<mesh::TetFace> _faces;
  std::vector<PieceId> _piece_of;  // per tetrahedron
  PieceId _pieces = 0;
  struct Triangle {
    std::array<LocalIndex, 3> vertices;
    std::int32_t tet, face;
  };
  std::vector<Triangle> _triangles;
};

void ForeignMesh::cut() {
  _piece_of.assign(_file.tets.size(), 0);
  for (std::size_t r = 0; r < _file.region_names.size(); ++r) {
    std::vector<LocalIndex> tets;
    for (std::size_t t = 0; t < _file.tets.size(); ++t) {
      if (_file.region[t] == static_cast<RegionId>(r)) tets.push_back(static_cast<LocalIndex>(t));
    }
    cut_region(tets);
  }
}

void ForeignMesh::cut_region(const std::vector<LocalIndex>& tets) {
  const auto count = static_cast<std::int64_t>(tets.size());
  const auto parts = static_cast<std::int32_t>((count + _piece_tets / 2) / _piece_tets);
  if (2 * count <= 3 * _piece_tets || parts < 2) {
    for (const LocalIndex t : tets) _piece_of[t] = _pieces;
    ++_pieces;
    return;
  }
  std::vector<LocalIndex> node(_file.tets.size(), -1);
  for (std::size_t i = 0; i < tets.size(); ++i) node[tets[i]] = static_cast<LocalIndex>(i);
  partition::WeightedGraph graph;
  graph.first.assign(tets.size() + 1, 0);
  std::vector<std::array<std::int32_t, 2>> pairs;
  mesh::for_each_face(
      _faces,
      [&](std::int32_t a, std::int32_t b) {
        if (node[a] < 0 || node[b] < 0) return;
        pairs.push_back({node[a], node[b]});
        ++graph.first[node[a] + 1];
        ++graph.first[node[b] + 1];
      },
      [](const mesh::TetFace&) {});
  std::partial_sum(graph.first.begin(), graph.first.end(), graph.first.begin());
  graph.neighbours.resize(2 * pairs.size());
  std::vector<std::int32_t> next(graph.first.begin(), graph.first.end() - 1);
  for (const auto& [a, b] : pairs) {
    graph.neighbours[next[a]++] = b;
    graph.neighbours[next[b]++] = a;
  }
  graph.arc_weights.assign(graph.neighbours.size(), 1);
  graph.node_weights.assign(tets.size(), 1);
  const std::vector<std::int32_t> part = partition::partition_graph(graph, parts);
  // Parts that METIS left empty get no number.
  std::vector<PieceId> number(parts, -1);
  for (std::size_t i = 0; i < tets.size(); ++i) {
    PieceId& piece = number[part[i]];
    if (piece < 0) piece = _pieces++;
    _piece_of[tets[i]] = piece;
  }
}

void ForeignMesh::name_faces(mesh::DistributedMesh& mesh) {
  std::map<std::array<RegionId, 2>, std::int32_t> known;
  const auto face_between = [&](RegionId front, RegionId back) {
    const auto [entry, is_new] =
        known.try_emplace({front, back}, static_cast<std::int32_t>(mesh.faces.size()));
    if (is_new) {
      const std::string& name = mesh.regions[front];
      mesh.faces.push_back(back == mesh::no_region ? "boundary_of_" + name
                                                   : name + "_to_" + mesh.regions[back]);
      mesh.sides.push_back({front, back});
    }
    return entry->second;
  };
  mesh::for_each_face(
      _faces,
      [&](std::int32_t a, std::int32_t b) {
        if (_file.region[a] == _file.region[b]) return;
        const std::int32_t front = _file.region[a] < _file.region[b] ? a : b, back = a + b - front;
        const auto& c = _file.tets[front];
        for (const auto& f : mesh::tetrahedron_faces) {
          const std::array<LocalIndex, 3> corners{c[f[0]], c[f[1]], c[f[2]]};
          const auto in_back = [&](LocalIndex v) {
            return std::find(_file.tets[back].begin(), _file.tets[back].end(), v) != _file.tets[back].end();
          };
          if (std::all_of(corners.begin(), corners.end(), in_back))
            _triangles.push_back({corners, front, face_between(_file.region[front], _file.region[back])});
        }
      },
      [&](const mesh::TetFace& face) {
        _triangles.push_back(
            {face.vertices, face.tet, face_between(_file.region[face.tet], mesh::no_region)});
      });
  mesh.patches = mesh.faces;
}

std::vector<char> ForeignMesh::vertices_in_several_pieces() const {
  const std::size_t count = _file.coordinates.size() / 3;
  std::vector<PieceId> first(count, -1);
  std::vector<char> several(count, 0);
  for (std::size_t t = 0; t < _file.tets.size(); ++t) {
    for (const LocalIndex v : _file.tets[t]) {
      if (first[v] < 0) first[v] = _piece_of[t];
      several[v] = several[v] || first[v] != _piece_of[t];
    }
  }
  return several;
}

void ForeignMesh::build_pieces(mesh::DistributedMesh& mesh) {
  const std::vector<char> several = vertices_in_several_pieces();
  const std::size_t vertices = several.size();
  std::vector<std::int32_t> face_of(vertices, -1);
  for (const Triangle& triangle : _triangles) {
    for (const LocalIndex v : triangle.vertices) face_of[v] = std::max(face_of[v], triangle.face);
  }
  std::vector<std::vector<LocalIndex>> tets(_pieces), triangles(_pieces);
  for (std::size_t t = 0; t < _piece_of.size(); ++t) tets[_piece_of[t]].push_back(static_cast<LocalIndex>(t));
  for (std::size_t i = 0; i < _triangles.size(); ++i)
    triangles[_piece_of[_triangles[i].tet]].push_back(static_cast<LocalIndex>(i));
  std::vector<LocalIndex> local(vertices, -1);
  for (PieceId id = 0; id < _pieces; ++id) {
    Piece& piece = mesh.pieces.emplace_back();
    piece.id = id;
    piece.region = _file.region[tets[id].front()];
    std::vector<LocalIndex> used;
    for (const LocalIndex t : tets[id]) used.insert(used.end(), _file.tets[t].begin(), _file.tets[t].end());
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::size_t i = 0; i < used.size(); ++i) {
      const LocalIndex v = used[i];
      local[v] = static_cast<LocalIndex>(i);
      const double* p = _file.coordinates.data() + 3 * static_cast<std::size_t>(v);
      piece.coordinates.insert(piece.coordinates.end(), p, p + 3);
      piece.vertex_dimension.push_back(face_of[v] < 0 ? 3 : 2);
      piece.vertex_entity.push_back(face_of[v] < 0 ? piece.region : face_of[v]);
      if (!several[v]) continue;
      piece.shared_vertices.push_back(static_cast<LocalIndex>(i));
      piece.shared_tokens.push_back(mesh::running_token(v));
    }
    for (const LocalIndex t : tets[id]) {
      for (const LocalIndex v : _file.tets[t]) piece.cells.push_back(local[v]);
    }
    for (const LocalIndex i : triangles[id]) {
      for (const LocalIndex v : _triangles[i].vertices) piece.boundary.push_back(local[v]);
      piece.triangle_face.push_back(_triangles[i].face);
      piece.triangle_patch.push_back(_triangles[i].face);
    }
  }
}

void broadcast_names(const parallel::Communicator& communicator, std::vector<std::string>& names) {
  std::vector<char> text;
  for (const std::string& name : names) {
    text.insert(text.end(), name.begin(), name.end());
    text.push_back('\0');
  }
  communicator.broadcast_items(text);
  names.clear();
  for (auto begin = text.begin(); begin != text.end();) {
    const auto end = std::find(begin, text.end(), '\0');
    names.emplace_back(begin, end);
    begin = end + 1;
  }
}

}  // namespace

mesh::DistributedMesh load_foreign_mesh(const parallel::Communicator& communicator, const std::string& path,
                                        std::optional<std::int64_t> piece_tets) {
  mesh::DistributedMesh mesh;
  std::vector<std::int64_t> sizes;
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    io::TetrahedraFile file = io::read_tetrahedra(path);
    parallel::log_info(fmt::format(
        "input: {} tetrahedra, {} points, {} region(s); {} turned over, {} cells of lower dimension left out",
        file.tets.size(), file.coordinates.size() / 3, file.region_names.size(), file.turned, file.ignored));
    mesh = ForeignMesh(std::move(file), path, piece_tets).build();
    for (const Piece& piece : mesh.pieces) sizes.push_back(piece.cell_count());
  });
  communicator.broadcast_items(sizes);
  mesh.kind = mesh::CellKind::tetrahedron;
  mesh.piece_count = static_cast<PieceId>(sizes.size());
  for (std::vector<std::string>* names : {&mesh.patches, &mesh.faces, &mesh.regions})
    broadcast_names(communicator, *names);
  communicator.broadcast_items(mesh.sides);
  const std::int64_t total = std::accumulate(sizes.begin(), sizes.end(), std::int64_t{0});
  std::vector<parallel::Rank> owner;
  std::int64_t before = 0;
  for (const std::int64_t size : sizes) {
    owner.push_back(static_cast<parallel::Rank>((before + size / 2) * communicator.size() / total));
    before += size;
  }
  mesh::migrate(communicator, mesh, owner);
  return mesh;
}

}  // namespace aeroloom::foreign
