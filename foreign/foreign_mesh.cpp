#include "foreign/foreign_mesh.hpp"

#include "io/face_links.hpp"
#include "io/read_mesh.hpp"
#include "mesh/delivery.hpp"
#include "mesh/distributed_table.hpp"
#include "mesh/tokens.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "partition/piece_size.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::foreign {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::RegionId;

/// A face of the model: a patch where it bounds one region, or lies between two.
struct Face {
  std::int32_t patch;
  RegionId front, back;

  static constexpr auto fields() { return std::tuple(&Face::patch, &Face::front, &Face::back); }
  friend auto operator<=>(const Face&, const Face&) = default;
};

/// The region of each part; empty parts have the first.
std::vector<RegionId> regions_of_parts(const parallel::Communicator& communicator, const io::FileMesh& mesh) {
  std::vector<std::array<std::int32_t, 2>> mine;
  for (const io::FilePart& part : mesh.parts)
    mine.push_back({part.id, part.cells[0].runs.empty() ? 0 : part.cells[0].runs.front().id});
  std::vector<RegionId> regions(mesh.part_count, 0);
  for (const auto& [part, region] :
       communicator.all_gather_items(std::span<const std::array<std::int32_t, 2>>(mine)))
    regions[part] = region;
  return regions;
}

/// The face that each boundary triangle of each part lies on.
std::vector<std::vector<Face>> faces_of_triangles(const parallel::Communicator& communicator,
                                                  const io::FileMesh& mesh) {
  const std::vector<RegionId> region = regions_of_parts(communicator, mesh);
  const io::FaceLinks links = io::link_faces(communicator, mesh);
  std::vector<std::vector<Face>> faces;
  for (std::size_t p = 0; p < mesh.parts.size(); ++p) {
    const io::FilePart& part = mesh.parts[p];
    auto& of_part = faces.emplace_back(part.faces[0].count());
    for (const io::Run& run : part.faces[0].runs) {
      for (LocalIndex t = run.begin; t < run.end; ++t)
        of_part[t] = {run.id, region[part.id], mesh::no_region};
    }
    for (std::size_t s = 0; s < links.parts[p].behind.size(); ++s) {
      const LocalIndex triangle = links.parts[p].boundary_face[s];
      const io::CellBehind& behind = links.parts[p].behind[s];
      if (triangle >= 0 && behind.exists()) of_part[triangle].back = region[behind.part];
    }
  }
  return faces;
}

/// All faces of the mesh, ascending. Collective.
std::vector<Face> all_faces(const parallel::Communicator& communicator,
                            const std::vector<std::vector<Face>>& of_triangles) {
  std::vector<Face> faces;
  const auto sort_unique = [&] {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  };
  for (const auto& some : of_triangles) faces.insert(faces.end(), some.begin(), some.end());
  sort_unique();
  faces = communicator.all_gather_items(std::span<const Face>(faces));
  sort_unique();
  return faces;
}

/// What a part knows of a vertex: the largest face around it, -1: none.
struct VertexNote {
  GlobalIndex number;
  std::int32_t face, part, place, rank;

  static constexpr auto fields() {
    return std::tuple(&VertexNote::number, &VertexNote::face, &VertexNote::part, &VertexNote::place,
                      &VertexNote::rank);
  }
};

/// Notes of all vertices that several parts know, each with the largest face that any of them knows.
std::vector<VertexNote> exchange_notes(const parallel::Communicator& communicator, const io::FileMesh& mesh,
                                       std::vector<VertexNote> notes) {
  const mesh::KeyRanges ranges = mesh::even_ranges(communicator.size(), mesh.vertex_count);
  std::vector<VertexNote> met = mesh::deliver(
      communicator, std::move(notes), [&](const VertexNote& note) { return ranges.rank_of(note.number); });
  std::sort(met.begin(), met.end(), [](const VertexNote& a, const VertexNote& b) {
    return std::tie(a.number, a.part) < std::tie(b.number, b.part);
  });
  std::vector<VertexNote> answers;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    std::int32_t face = -1;
    for (j = i; j < met.size() && met[j].number == met[i].number; ++j) face = std::max(face, met[j].face);
    if (j - i < 2) continue;
    for (std::size_t k = i; k < j; ++k) {
      met[k].face = face;
      answers.push_back(met[k]);
    }
  }
  std::vector<VertexNote> shared =
      mesh::deliver(communicator, std::move(answers),
                    [](const VertexNote& note) { return static_cast<parallel::Rank>(note.rank); });
  std::sort(shared.begin(), shared.end(), [](const VertexNote& a, const VertexNote& b) {
    return std::tie(a.part, a.place) < std::tie(b.part, b.place);
  });
  return shared;
}

/// One part as a piece, but for what others know of its vertices.
mesh::Piece piece_of(const io::FilePart& part, RegionId region, const std::vector<Face>& of_triangles,
                     const std::vector<Face>& faces) {
  mesh::Piece piece;
  piece.id = part.id;
  piece.region = region;
  piece.coordinates.assign(part.coordinates.begin(), part.coordinates.end());
  piece.cells.assign(part.cells[0].connectivity.begin(), part.cells[0].connectivity.end());
  piece.boundary.assign(part.faces[0].connectivity.begin(), part.faces[0].connectivity.end());
  piece.vertex_dimension.assign(part.vertex_count(), 3);
  piece.vertex_entity.assign(part.vertex_count(), -1);
  for (std::size_t t = 0; t < of_triangles.size(); ++t) {
    const auto face = static_cast<std::int32_t>(
        std::lower_bound(faces.begin(), faces.end(), of_triangles[t]) - faces.begin());
    piece.triangle_face.push_back(face);
    piece.triangle_patch.push_back(of_triangles[t].patch);
    for (std::size_t k = 0; k < 3; ++k) {
      std::int32_t& entity = piece.vertex_entity[piece.boundary[3 * t + k]];
      entity = std::max(entity, face);
    }
  }
  return piece;
}

/// What all parts know of the vertices: which lie on faces, and which are shared.
void settle_vertices(const parallel::Communicator& communicator, const io::FileMesh& mesh,
                     std::vector<mesh::Piece>& pieces) {
  std::vector<VertexNote> notes;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (LocalIndex v = 0; v < pieces[p].vertex_count(); ++v)
      notes.push_back(
          {mesh.parts[p].numbers[v], pieces[p].vertex_entity[v], pieces[p].id, v, communicator.rank()});
  }
  for (const VertexNote& note : exchange_notes(communicator, mesh, std::move(notes))) {
    const auto piece =
        std::lower_bound(pieces.begin(), pieces.end(), note.part,
                         [](const mesh::Piece& item, std::int32_t id) { return item.id < id; });
    piece->vertex_entity[note.place] = note.face;
    piece->shared_vertices.push_back(note.place);
    piece->shared_tokens.push_back(mesh::running_token(note.number));
  }
  for (mesh::Piece& piece : pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      piece.vertex_dimension[v] = piece.vertex_entity[v] < 0 ? 3 : 2;
      if (piece.vertex_entity[v] < 0) piece.vertex_entity[v] = piece.region;
    }
  }
}

/// Faces are called as their patch, and by their regions where a patch has several.
void name_faces(const io::FileMesh& mesh, const std::vector<Face>& faces, mesh::DistributedMesh& result) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Face& face = faces[f];
    const bool alone = (f == 0 || faces[f - 1].patch != face.patch) &&
                       (f + 1 == faces.size() || faces[f + 1].patch != face.patch);
    std::string name = mesh.patches[face.patch].name;
    if (!alone) name += "_" + mesh.regions[face.front];
    if (!alone && face.back != mesh::no_region) name += "_" + mesh.regions[face.back];
    result.faces.push_back(std::move(name));
    result.sides.push_back({face.front, face.back});
  }
  for (const mesh::Patch& patch : mesh.patches) {
    result.patches.push_back(patch.name);
    result.patch_types.push_back(patch.type);
  }
  result.regions = mesh.regions;
}

}  // namespace

mesh::DistributedMesh pieces_of(const parallel::Communicator& communicator, const io::FileMesh& mesh,
                                const std::string& path, std::optional<std::int64_t> piece_tets) {
  const GlobalIndex tets = mesh.cell_count(io::CellShape::tetrahedron), others = mesh.cell_count() - tets;
  if (others > 0) {
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format(
            "'{}' has {} pyramids and prisms beside {} tetrahedra. Remedy: give a mesh of tetrahedra alone; "
            "`aeroloom convert` and `aeroloom quality` take the others too",
            path, others, tets));
  }
  const std::int64_t size = piece_tets.value_or(partition::suitable_piece_tets(static_cast<double>(tets)));
  const bool one = 2 * tets <= 3 * size;
  const io::FileMesh cut = io::repartition(
      communicator, mesh, one ? 1 : static_cast<std::int32_t>((tets + size / 2) / size), true);
  mesh::DistributedMesh result;
  result.kind = mesh::CellKind::tetrahedron;
  result.piece_count = cut.part_count;
  const std::vector<std::vector<Face>> of_triangles = faces_of_triangles(communicator, cut);
  const std::vector<Face> faces = all_faces(communicator, of_triangles);
  const std::vector<RegionId> region = regions_of_parts(communicator, cut);
  for (std::size_t p = 0; p < cut.parts.size(); ++p)
    result.pieces.push_back(piece_of(cut.parts[p], region[cut.parts[p].id], of_triangles[p], faces));
  settle_vertices(communicator, cut, result.pieces);
  name_faces(cut, faces, result);
  return result;
}

mesh::DistributedMesh load_foreign_mesh(const parallel::Communicator& communicator, const std::string& path,
                                        std::optional<std::int64_t> piece_tets) {
  io::Assembled file = io::read_mesh(communicator, path, 0);
  if (communicator.is_root()) {
    parallel::log_info(fmt::format("input: {} tetrahedra, {} points, {} region(s), {} patch(es); {}",
                                   file.mesh.cell_count(), file.mesh.vertex_count, file.mesh.regions.size(),
                                   file.mesh.patches.size(), io::describe(file)));
  }
  return pieces_of(communicator, file.mesh, path, piece_tets);
}

}  // namespace aeroloom::foreign
