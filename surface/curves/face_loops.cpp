#include "surface/curves/face_loops.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/exchange/rendezvous.hpp"
#include "parallel/communication/schedule.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::surface {
namespace {

/// A triangle's edge between two vertices of curves.
struct EdgeRow {
  std::array<mesh::SharedVertexKey, 2> keys;  // as the triangle runs
  std::array<geometry::Vec3, 2> points;
  cad::FaceId face;
  std::array<mesh::SharedVertexKey, 2> sorted() const {
    return {std::min(keys[0], keys[1]), std::max(keys[0], keys[1])};
  }
  auto place() const { return std::tuple(face, keys[0]); }
};

void list_edges(const mesh::Piece& piece, std::vector<EdgeRow>& rows) {
  std::vector<std::int32_t> named(piece.vertex_count(), -1);
  for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
    if (!mesh::is_cut_vertex_key(piece.shared_keys[s]))
      named[piece.shared_vertices[s]] = static_cast<std::int32_t>(s);
  }
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const mesh::LocalIndex from = piece.cell(t)[i], to = piece.cell(t)[(i + 1) % 3];
      if (named[from] < 0 || named[to] < 0) continue;
      rows.push_back({{piece.shared_keys[named[from]], piece.shared_keys[named[to]]},
                      {piece.point(from), piece.point(to)},
                      piece.common_face()});
    }
  }
}

/// Of rows with the same ends, by face: whether a curve runs there. Two triangles of a face alone meet inside
/// it, at a cut perhaps.
bool is_on_curve(std::span<const EdgeRow> rows) {
  bool odd = false;
  geometry::for_each_run(
      rows, [](const EdgeRow& a, const EdgeRow& b) { return a.face == b.face; },
      [&](std::size_t first, std::size_t last) { odd = odd || (last - first) % 2 == 1; });
  return odd;
}

FaceLoops make_loops(std::span<const EdgeRow> rows) {
  FaceLoops loops;
  for (const EdgeRow& row : rows)
    loops.vertex_keys.insert(loops.vertex_keys.end(), {row.keys[0], row.keys[1]});
  geometry::sort_unique(loops.vertex_keys);
  loops.points.resize(loops.vertex_keys.size());
  for (const EdgeRow& row : rows) {
    const std::array<std::int32_t, 2> edge{loops.find(row.keys[0]), loops.find(row.keys[1])};
    for (const int end : {0, 1}) loops.points[edge[end]] = row.points[end];
    loops.edges.push_back(edge);
  }
  return loops;
}

/// The rank of each face's loops.
std::vector<parallel::Rank> assign_faces(const mesh::DistributedMesh& surface,
                                         const std::vector<EdgeRow>& rows,
                                         std::span<const cad::FaceId> faces) {
  std::vector<std::int64_t> counts(faces.size(), 0);
  for (const EdgeRow& row : rows) {
    const auto at = std::lower_bound(faces.begin(), faces.end(), row.face);
    if (at != faces.end() && *at == row.face) ++counts[at - faces.begin()];
  }
  surface.communicator.sum_each(counts);
  const std::vector<double> loads(counts.begin(), counts.end());
  return parallel::assign_largest_first(loads, surface.communicator.size());
}

}  // namespace

std::int32_t FaceLoops::find(mesh::SharedVertexKey vertex_key) const {
  return static_cast<std::int32_t>(std::lower_bound(vertex_keys.begin(), vertex_keys.end(), vertex_key) -
                                   vertex_keys.begin());
}

std::map<cad::FaceId, FaceLoops> gather_loops(const mesh::DistributedMesh& surface,
                                              std::span<const cad::FaceId> faces) {
  const parallel::Communicator& communicator = surface.communicator;
  std::vector<EdgeRow> rows;
  for (const mesh::Piece& piece : surface.pieces) list_edges(piece, rows);
  const std::vector<parallel::Rank> owners = assign_faces(surface, rows, faces);
  const std::vector<EdgeRow> met =
      mesh::meet_by_key(communicator, std::move(rows), &EdgeRow::sorted, &EdgeRow::place);
  std::vector<EdgeRow> on_loops;
  mesh::for_each_key(met, &EdgeRow::sorted, [&](std::span<const EdgeRow> group) {
    if (!is_on_curve(group)) return;
    for (const EdgeRow& row : group) {
      if (std::binary_search(faces.begin(), faces.end(), row.face)) on_loops.push_back(row);
    }
  });
  on_loops = mesh::deliver(communicator, std::move(on_loops), [&](const EdgeRow& row) {
    return owners[std::lower_bound(faces.begin(), faces.end(), row.face) - faces.begin()];
  });
  std::sort(on_loops.begin(), on_loops.end(), [](const EdgeRow& a, const EdgeRow& b) {
    return std::tie(a.face, a.keys) < std::tie(b.face, b.keys);
  });
  std::map<cad::FaceId, FaceLoops> loops;
  const std::span<const EdgeRow> all(on_loops);
  geometry::for_each_run(
      all, [](const EdgeRow& a, const EdgeRow& b) { return a.face == b.face; },
      [&](std::size_t first, std::size_t last) {
        loops.emplace(all[first].face, make_loops(all.subspan(first, last - first)));
      });
  return loops;
}

}  // namespace aeroloom::surface
