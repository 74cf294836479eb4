#include "pipeline/volume_piece.hpp"

#include "io/vtk_writer.hpp"
#include "parallel/collective_error.hpp"

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

struct BoundaryVertex {
  GlobalIndex number;
  geometry::Vec3 point;
  std::int32_t entity;
  std::int32_t dimension;
};

struct BoundaryTriangle {
  GlobalIndex number;
  GlobalIndex vertices[3];
  std::int32_t face, patch;
};

std::vector<BoundaryVertex> owned_vertices(const mesh::DistributedMesh& surface,
                                           const mesh::Numbering& numbering) {
  std::vector<BoundaryVertex> vertices;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (!numbering.owned[p][v]) continue;
      vertices.push_back(
          {numbering.vertices[p][v], piece.point(v), piece.vertex_entity[v], piece.vertex_dimension[v]});
    }
  }
  return vertices;
}

std::vector<BoundaryTriangle> triangles_of(const mesh::DistributedMesh& surface,
                                           const mesh::Numbering& numbering) {
  std::vector<BoundaryTriangle> triangles;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    const auto& number = numbering.vertices[p];
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* corner = piece.cell(t);
      triangles.push_back({numbering.first_cell[p] + t,
                           {number[corner[0]], number[corner[1]], number[corner[2]]},
                           piece.triangle_face[t],
                           piece.triangle_patch[t]});
    }
  }
  return triangles;
}

/// The tetrahedral piece: the boundary's vertices come first, so its triangles keep their numbers.
Piece piece_of(const PieceBoundary& boundary, volume::FilledVolume&& filled) {
  Piece piece;
  piece.id = 0;
  piece.coordinates = std::move(filled.coordinates);
  piece.cells = std::move(filled.tetrahedra);
  piece.vertex_dimension = boundary.vertex_dimension;
  piece.vertex_entity = boundary.vertex_entity;
  piece.vertex_dimension.resize(piece.vertex_count(), 3);
  piece.vertex_entity.resize(piece.vertex_count(), 0);
  piece.boundary.reserve(3 * boundary.surface.triangles.size());
  for (const auto& t : boundary.surface.triangles)
    piece.boundary.insert(piece.boundary.end(), t.begin(), t.end());
  piece.triangle_face = boundary.triangle_face;
  piece.triangle_patch = boundary.triangle_patch;
  return piece;
}

/// The triangles a failure names, with their CAD faces, and a file to look at them.
std::string explain(const volume::VolumeError& error, const PieceBoundary& boundary,
                    const std::vector<std::string>& face_names, const std::string& offenders_file) {
  std::string text = error.what();
  if (error.triangles().empty()) return text;
  std::vector<std::array<LocalIndex, 3>> offenders;
  std::vector<std::int32_t> faces;
  for (const std::int32_t t : error.triangles()) {
    offenders.push_back(boundary.surface.triangles[t]);
    faces.push_back(boundary.triangle_face[t]);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  text += "; CAD faces:";
  for (std::size_t i = 0; i < std::min<std::size_t>(faces.size(), 8); ++i)
    text += " '" + face_names[faces[i]] + "'";
  io::write_triangles(boundary.surface.points, offenders, offenders_file);
  return text + "; the triangles are in " + offenders_file;
}

}  // namespace

PieceBoundary gather_boundary(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              parallel::Rank owner) {
  const auto vertices = communicator.gather_items<BoundaryVertex>(owned_vertices(surface, numbering), owner);
  const auto triangles = communicator.gather_items<BoundaryTriangle>(triangles_of(surface, numbering), owner);
  PieceBoundary boundary;
  boundary.surface.points.resize(vertices.size());
  boundary.vertex_dimension.resize(vertices.size());
  boundary.vertex_entity.resize(vertices.size());
  for (const BoundaryVertex& v : vertices) {
    boundary.surface.points[v.number] = v.point;
    boundary.vertex_dimension[v.number] = static_cast<std::int8_t>(v.dimension);
    boundary.vertex_entity[v.number] = v.entity;
  }
  boundary.surface.triangles.resize(triangles.size());
  boundary.triangle_face.resize(triangles.size());
  boundary.triangle_patch.resize(triangles.size());
  for (const BoundaryTriangle& t : triangles) {
    for (int k = 0; k < 3; ++k)
      boundary.surface.triangles[t.number][k] = static_cast<LocalIndex>(t.vertices[k]);
    boundary.triangle_face[t.number] = t.face;
    boundary.triangle_patch[t.number] = t.patch;
  }
  return boundary;
}

mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator,
                                  const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                                  const sizing::SizeField& field, const volume::VolumeOptions& options,
                                  const std::string& offenders_file, parallel::StageClock& clock,
                                  VolumeReport& report) {
  constexpr parallel::Rank owner = 0;
  const PieceBoundary boundary = gather_boundary(communicator, surface, numbering, owner);
  mesh::DistributedMesh mesh;
  mesh.piece_count = 1;
  mesh.patches = surface.patches;
  mesh.faces = surface.faces;
  parallel::agree(communicator, [&] {
    if (communicator.rank() != owner) return;
    try {
      volume::FilledVolume filled = volume::fill_volume(boundary.surface, field, options);
      report = {filled.steiner_points, filled.attempts};
      clock.add_task_cpu(filled.cpu_seconds);
      clock.note_child_memory(filled.child_peak_bytes);
      clock.add_pieces(1);
      mesh.pieces.push_back(piece_of(boundary, std::move(filled)));
    } catch (const volume::VolumeError& error) {
      throw std::runtime_error(explain(error, boundary, surface.faces, offenders_file));
    }
  });
  std::vector<VolumeReport> shared{report};
  communicator.broadcast_items(shared, owner);
  report = shared.front();
  return mesh;
}

}  // namespace aeroloom::pipeline
