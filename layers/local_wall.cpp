#include "layers/local_wall.hpp"

#include "layers/end_planes.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <string>

namespace aeroloom::layers {
namespace {

using parallel::CollectiveError;
using parallel::FailureKind;

/// The same on every rank, so all of them throw.
void require_fitting(const mesh::DistributedMesh& mesh, const LayerOptions& options) {
  const auto require = [](bool fulfilled, const std::string& what) {
    if (!fulfilled) throw CollectiveError(FailureKind::input, "layers: " + what);
  };
  if (mesh.kind != mesh::CellKind::triangle)
    throw CollectiveError(FailureKind::bug, "layers: the mesh is no surface");
  require(options.patches.size() <= mesh.patches.size(), "more patches than the mesh has");
  for (std::size_t p = 0; p < options.patches.size(); ++p) {
    const WallLayers& wanted = options.patches[p];
    const std::string of_patch = " of patch '" + mesh.patches[p] + "'";
    require(wanted.first >= 0 && wanted.total >= 0 && wanted.count >= 0,
            "a negative height or count" + of_patch);
    require(wanted.constant >= 1, "constant" + of_patch + " is at least 1");
    require(wanted.growth >= 1, "growth" + of_patch + " is at least 1");
    require(wanted.growth > 1 || wanted.first == 0 || wanted.count > 0 || wanted.total > 0,
            "growth" + of_patch + " is 1, and neither count nor total ends the layers");
  }
}

std::vector<WallRole> roles_of_patches(const mesh::DistributedMesh& mesh, const LayerOptions& options) {
  std::vector<WallRole> roles(mesh.patches.size(), WallRole::other);
  for (std::size_t p = 0; p < options.patches.size(); ++p) {
    if (options.patches[p].first > 0) roles[p] = WallRole::layered;
  }
  return roles;
}

}  // namespace

LocalWall::LocalWall(const mesh::DistributedMesh& surface, const LayerOptions& options)
    : mesh((require_fitting(surface, options), surface)),
      edges(options.edges),
      end_planes(find_end_planes(surface, options)),
      ends(options.curved_ends),
      shared(surface) {
  curved_ends = find_curved_ends(surface, options, end_planes, shared);
  const std::vector<WallRole> of_patches = roles_of_patches(mesh, options);
  for (const mesh::Piece& piece : mesh.pieces) {
    const std::int32_t base = vertex_count();
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) points.push_back(piece.point(v));
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* cell = piece.cell(t);
      triangles.push_back({base + cell[0], base + cell[2], base + cell[1]});
      const std::int32_t patch = piece.triangle_patch[t], face = piece.triangle_face[t];
      patches.push_back(patch);
      faces.push_back(face);
      const auto has = [](const auto& table, std::int32_t i) {
        return i >= 0 && static_cast<std::size_t>(i) < table.size();
      };
      if (has(end_planes, face) && (!(end_planes[face] == geometry::Vec3{}) || is_curved_end(face))) {
        roles.push_back(WallRole::plane);
      } else {
        roles.push_back(has(of_patches, patch) && !mesh.sides_of(face).is_inner() ? of_patches[patch]
                                                                                  : WallRole::other);
      }
    }
    first_vertex.push_back(vertex_count());
    first_triangle.push_back(triangle_count());
  }
  first_around.assign(points.size() + 2, 0);
  for (const Corners& corners : triangles) {
    for (const std::int32_t v : corners) ++first_around[v + 2];
  }
  for (std::size_t v = 2; v < first_around.size(); ++v) first_around[v] += first_around[v - 1];
  around.resize(3 * triangles.size());
  for (std::int32_t t = 0; t < triangle_count(); ++t) {
    for (const std::int32_t v : triangles[t]) around[first_around[v + 1]++] = t;
  }
  owned.assign(points.size(), 1);
  vertex_of_copy.resize(shared.size());
  shared.for_each([&](std::size_t p, mesh::LocalIndex v, std::size_t copy) {
    vertex_of_copy[copy] = first_vertex[p] + v;
    if (!shared.is_owned(copy)) owned[vertex_of_copy[copy]] = 0;
  });
}

std::vector<mesh::VertexName> LocalWall::vertex_names() const {
  std::vector<mesh::VertexName> all;
  for (const mesh::Piece& piece : mesh.pieces) {
    const std::vector<mesh::VertexName> names = mesh::name_vertices(piece);
    all.insert(all.end(), names.begin(), names.end());
  }
  return all;
}

EdgeTurn LocalWall::turn_at(std::size_t position, mesh::LocalIndex vertex) const {
  const mesh::Piece& piece = mesh.pieces[position];
  if (piece.vertex_dimension[vertex] == mesh::CadDimension::vertex) return EdgeTurn::unknown;
  if (piece.vertex_dimension[vertex] != mesh::CadDimension::edge) return EdgeTurn::smooth;
  const auto edge = static_cast<std::size_t>(piece.vertex_entity[vertex]);
  return edge < edges.size() ? edges[edge] : EdgeTurn::unknown;
}

TrianglePlace LocalWall::place_of(std::int32_t triangle) const {
  const auto p =
      std::upper_bound(first_triangle.begin(), first_triangle.end(), triangle) - first_triangle.begin() - 1;
  return {mesh.pieces[p].id, triangle - first_triangle[p]};
}

}  // namespace aeroloom::layers
