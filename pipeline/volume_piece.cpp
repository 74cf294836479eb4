#include "pipeline/volume_piece.hpp"

#include "io/vtk_writer.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/schedule.hpp"

#include <algorithm>

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

bool bounds(mesh::FaceSides sides, geometry::RegionId region) {
  return sides.front == region || sides.back == region;
}

/// The vertices of this rank's triangles around a region; those that faces share come once per face.
std::vector<BoundaryVertex> vertices_around(const mesh::DistributedMesh& surface,
                                            const mesh::Numbering& numbering, geometry::RegionId region) {
  std::vector<BoundaryVertex> vertices;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    if (!bounds(surface.sides_of(piece.common_face()), region)) continue;
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      vertices.push_back(
          {numbering.vertices[p][v], piece.point(v), piece.vertex_entity[v], piece.vertex_dimension[v]});
    }
  }
  return vertices;
}

std::vector<BoundaryTriangle> triangles_around(const mesh::DistributedMesh& surface,
                                               const mesh::Numbering& numbering, geometry::RegionId region) {
  std::vector<BoundaryTriangle> triangles;
  for (std::size_t p = 0; p < surface.pieces.size(); ++p) {
    const Piece& piece = surface.pieces[p];
    const mesh::FaceSides sides = surface.sides_of(piece.common_face());
    if (!bounds(sides, region)) continue;
    const int second = sides.front == region ? 1 : 2;
    const auto& number = numbering.vertices[p];
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* corner = piece.cell(t);
      triangles.push_back({numbering.first_cell[p] + t,
                           {number[corner[0]], number[corner[second]], number[corner[3 - second]]},
                           piece.triangle_face[t],
                           piece.triangle_patch[t]});
    }
  }
  return triangles;
}

/// Which CAD entities touch more than one region: vertices there are shared by volume pieces.
class RegionContacts {
public:
  explicit RegionContacts(const geometry::Model& model)
      : _vertices(model.vertex_count()), _edges(model.edge_count()), _faces(model.face_count(), 0) {
    for (geometry::FaceId f = 0; f < model.face_count(); ++f) {
      const geometry::Face& face = model.face(f);
      _faces[f] = face.back != geometry::no_entity;
      for (const auto& loop : face.loops) {
        for (const geometry::EdgeUse& use : loop) {
          for (const geometry::RegionId region : {face.front, face.back}) {
            touch(_edges[use.edge], region);
            touch(_vertices[model.edge(use.edge).first], region);
            touch(_vertices[model.edge(use.edge).last], region);
          }
        }
      }
    }
  }

  bool shared(std::int8_t dimension, std::int32_t entity) const {
    if (dimension == 0) return _vertices[entity].several;
    if (dimension == 1) return _edges[entity].several;
    return dimension == 2 && _faces[entity];
  }

private:
  struct Contact {
    geometry::RegionId first = geometry::no_entity;
    bool several = false;
  };

  static void touch(Contact& contact, geometry::RegionId region) {
    if (region == geometry::no_entity) return;
    if (contact.first == geometry::no_entity) contact.first = region;
    contact.several = contact.several || contact.first != region;
  }

  std::vector<Contact> _vertices, _edges;
  std::vector<char> _faces;
};

/// The tetrahedral piece: the boundary's vertices come first, so its triangles keep their numbers.
Piece piece_of(const mesh::DistributedMesh& surface, const RegionContacts& contacts,
               const PieceBoundary& boundary, geometry::RegionId region, volume::FilledVolume&& filled) {
  Piece piece;
  piece.id = piece.region = region;
  piece.coordinates = std::move(filled.coordinates);
  piece.cells = std::move(filled.tetrahedra);
  piece.vertex_dimension = boundary.vertex_dimension;
  piece.vertex_entity = boundary.vertex_entity;
  piece.vertex_dimension.resize(piece.vertex_count(), 3);
  piece.vertex_entity.resize(piece.vertex_count(), region);
  for (std::size_t t = 0; t < boundary.surface.triangles.size(); ++t) {
    if (surface.sides_of(boundary.triangle_face[t]).front != region) continue;
    const auto& corners = boundary.surface.triangles[t];
    piece.boundary.insert(piece.boundary.end(), corners.begin(), corners.end());
    piece.triangle_face.push_back(boundary.triangle_face[t]);
    piece.triangle_patch.push_back(boundary.triangle_patch[t]);
  }
  for (std::size_t v = 0; v < boundary.vertex_number.size(); ++v) {
    if (!contacts.shared(boundary.vertex_dimension[v], boundary.vertex_entity[v])) continue;
    piece.shared_vertices.push_back(static_cast<LocalIndex>(v));
    piece.shared_tokens.push_back(static_cast<mesh::SharedToken>(boundary.vertex_number[v]));
  }
  return piece;
}

/// Boundary triangles of every region: what filling it costs, about.
std::vector<double> region_loads(const parallel::Communicator& communicator,
                                 const mesh::DistributedMesh& surface) {
  struct FaceCount {
    geometry::FaceId face;
    LocalIndex triangles;
  };
  std::vector<FaceCount> mine;
  for (const Piece& piece : surface.pieces) mine.push_back({piece.common_face(), piece.cell_count()});
  std::vector<double> loads(surface.region_count(), 0);
  for (const FaceCount& count : communicator.all_gather_items<FaceCount>(mine)) {
    const mesh::FaceSides sides = surface.sides_of(count.face);
    loads[sides.front] += count.triangles;
    if (sides.is_inner()) loads[sides.back] += count.triangles;
  }
  return loads;
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

mesh::DistributedMesh part_of_surface(const mesh::DistributedMesh& surface, bool inner) {
  mesh::DistributedMesh part = surface;
  for (Piece& piece : part.pieces) {
    if (surface.sides_of(piece.common_face()).is_inner() == inner) continue;
    Piece empty;
    empty.id = piece.id;
    empty.kind = piece.kind;
    piece = std::move(empty);
  }
  return part;
}

PieceBoundary gather_boundary(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              geometry::RegionId region, parallel::Rank owner) {
  auto vertices =
      communicator.gather_items<BoundaryVertex>(vertices_around(surface, numbering, region), owner);
  auto triangles =
      communicator.gather_items<BoundaryTriangle>(triangles_around(surface, numbering, region), owner);
  const auto by_number = [](const auto& a, const auto& b) { return a.number < b.number; };
  std::sort(vertices.begin(), vertices.end(), by_number);
  std::sort(triangles.begin(), triangles.end(), by_number);
  PieceBoundary boundary;
  for (const BoundaryVertex& v : vertices) {
    if (!boundary.vertex_number.empty() && boundary.vertex_number.back() == v.number) continue;
    boundary.vertex_number.push_back(v.number);
    boundary.surface.points.push_back(v.point);
    boundary.vertex_dimension.push_back(static_cast<std::int8_t>(v.dimension));
    boundary.vertex_entity.push_back(v.entity);
  }
  const auto local = [&](GlobalIndex number) {
    const auto& numbers = boundary.vertex_number;
    return static_cast<LocalIndex>(std::lower_bound(numbers.begin(), numbers.end(), number) -
                                   numbers.begin());
  };
  for (const BoundaryTriangle& t : triangles) {
    boundary.surface.triangles.push_back({local(t.vertices[0]), local(t.vertices[1]), local(t.vertices[2])});
    boundary.triangle_face.push_back(t.face);
    boundary.triangle_patch.push_back(t.patch);
  }
  return boundary;
}

mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator, const geometry::Model& model,
                                  const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                                  const sizing::SizeField& field, const volume::VolumeOptions& options,
                                  const std::string& offenders_file, parallel::StageClock& clock,
                                  VolumeReport& report) {
  const std::vector<double> loads = region_loads(communicator, surface);
  const std::vector<parallel::Rank> owners = parallel::assign_largest_first(loads, communicator.size());
  const auto regions = static_cast<std::int32_t>(loads.size());
  std::vector<PieceBoundary> boundaries(regions);  // filled for the regions of this rank
  for (geometry::RegionId region = 0; region < regions; ++region) {
    PieceBoundary gathered = gather_boundary(communicator, surface, numbering, region, owners[region]);
    if (owners[region] == communicator.rank()) boundaries[region] = std::move(gathered);
  }
  mesh::DistributedMesh mesh;
  mesh.piece_count = regions;
  mesh.patches = surface.patches;
  mesh.faces = surface.faces;
  mesh.regions = surface.regions;
  mesh.sides = surface.sides;
  const RegionContacts contacts(model);
  parallel::agree(communicator, [&] {
    for (const int region : parallel::tasks_of_rank(owners, loads, communicator.rank())) {
      PieceBoundary& boundary = boundaries[region];
      try {
        volume::FilledVolume filled = volume::fill_volume(boundary.surface, field, options);
        report.steiner_points += filled.steiner_points;
        report.attempts = std::max(report.attempts, filled.attempts);
        clock.add_task_cpu(filled.cpu_seconds);
        clock.note_child_memory(filled.child_peak_bytes);
        clock.add_pieces(1);
        mesh.pieces.push_back(piece_of(surface, contacts, boundary, region, std::move(filled)));
        boundary = {};
      } catch (const volume::VolumeError& error) {
        const std::string where =
            regions > 1 ? fmt::format("region '{}': ", model.region_name(region)) : std::string();
        throw std::runtime_error(where + explain(error, boundary, surface.faces, offenders_file));
      }
    }
  });
  std::sort(mesh.pieces.begin(), mesh.pieces.end(),
            [](const Piece& a, const Piece& b) { return a.id < b.id; });
  report.steiner_points = communicator.sum(report.steiner_points);
  report.attempts = static_cast<int>(communicator.maximum(std::int64_t{report.attempts}));
  return mesh;
}

}  // namespace aeroloom::pipeline
