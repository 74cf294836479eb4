#include "io/file_mesh.hpp"

#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

constexpr int kind_count = cell_shape_count + face_shape_count;

/// A block of a part: cells by shape, then faces by shape.
Block& block_of(MeshPart& part, int kind) {
  return kind < cell_shape_count ? part.cells[kind] : part.faces[kind - cell_shape_count];
}

/// How many a part has of a kind and id; kind -1: vertices that it owns.
struct CountRow {
  std::int32_t part, kind, id;
  GlobalIndex count;
};

std::vector<CountRow> count_rows(FileMesh& mesh) {
  std::vector<CountRow> rows;
  for (MeshPart& part : mesh.parts) {
    rows.push_back({part.id, -1, 0, part.owned_count});
    for (int kind = 0; kind < kind_count; ++kind) {
      for (const Run& run : block_of(part, kind).runs)
        rows.push_back({part.id, kind, run.id, run.end - run.begin});
    }
  }
  return rows;
}

MeshPart* find_part(FileMesh& mesh, std::int32_t id) {
  const auto found =
      std::lower_bound(mesh.parts.begin(), mesh.parts.end(), id,
                       [](const MeshPart& part, std::int32_t wanted) { return part.id < wanted; });
  return found != mesh.parts.end() && found->id == id ? &*found : nullptr;
}

/// Adds up the rows of all parts in their order, and sets the counts before each part on this rank.
void place_parts(FileMesh& mesh, std::vector<CountRow> rows) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const CountRow& a, const CountRow& b) { return a.part < b.part; });
  mesh.region_cells.assign(mesh.regions.size(), {});
  mesh.patch_faces.assign(mesh.patches.size(), {});
  std::array<GlobalIndex, kind_count> of_kind{}, before_part{};
  std::int32_t at = -1;
  std::vector<int> parts_seen(mesh.part_count, 0);
  for (const CountRow& row : rows) {
    if (row.part != at) before_part = of_kind, at = row.part;
    MeshPart* const part = find_part(mesh, row.part);
    if (row.kind < 0) {
      ++parts_seen.at(row.part);
      if (part != nullptr) part->first_owned = mesh.vertex_count;
      mesh.vertex_count += row.count;
      if (part == nullptr) continue;
      for (int kind = 0; kind < kind_count; ++kind) block_of(*part, kind).before = before_part[kind];
      continue;
    }
    GlobalIndex& total = row.kind < cell_shape_count
                             ? mesh.region_cells.at(row.id)[row.kind]
                             : mesh.patch_faces.at(row.id)[row.kind - cell_shape_count];
    if (part != nullptr) {
      for (Run& run : block_of(*part, row.kind).runs) {
        if (run.id == row.id) run.before = total;
      }
    }
    total += row.count;
    of_kind[row.kind] += row.count;
  }
  if (std::any_of(parts_seen.begin(), parts_seen.end(), [](int seen) { return seen != 1; }))
    throw std::logic_error("the ranks do not hold each part exactly once");
}

/// Counts, offsets and totals of a mesh whose parts are set. Collective.
void finish(FileMesh& mesh) {
  const std::vector<CountRow> mine = count_rows(mesh);
  const std::vector<CountRow> all = mesh.communicator().all_gather_items(std::span<const CountRow>(mine));
  parallel::agree(mesh.communicator(), [&] { place_parts(mesh, all); });
}

/// A patch whose faces lie between regions as well as outside is distinguished by ids after those of all.
std::int32_t patch_with_side(const mesh::DistributedMesh& mesh, std::int32_t patch, std::int32_t face) {
  const bool inner = mesh.sides_of(face).is_inner();
  return patch + (inner ? static_cast<std::int32_t>(mesh.patches.size()) : 0);
}

/// The patches as files have them, and where each one goes: first those outside, then those between regions.
struct SplitPatches {
  std::vector<mesh::Patch> patches;
  std::vector<std::int32_t> target;
};

SplitPatches split_patches(const mesh::DistributedMesh& mesh) {
  const std::size_t count = mesh.patches.size();
  std::vector<std::uint8_t> used(2 * count, 0);
  for (const mesh::Piece& piece : mesh.pieces) {
    for (const FaceShape shape : face_shapes) {
      const auto faces = mesh::cad_faces_of(piece, shape), patches = mesh::patches_of(piece, shape);
      for (std::size_t f = 0; f < faces.size(); ++f) used.at(patch_with_side(mesh, patches[f], faces[f])) = 1;
    }
  }
  const std::vector<std::uint8_t> all =
      mesh.communicator.all_gather_items(std::span<const std::uint8_t>(used));
  for (std::size_t i = 0; i < all.size(); ++i) used[i % used.size()] |= all[i];
  SplitPatches split;
  split.target.resize(2 * count);
  for (std::size_t p = 0; p < count; ++p) {
    const bool inner_alone = used[count + p] && !used[p];
    const auto type = mesh.type_of_patch(static_cast<std::int32_t>(p));
    split.patches.push_back({mesh.patches[p], inner_alone ? mesh::PatchType::interior : type});
    split.target[p] = split.target[count + p] = static_cast<std::int32_t>(p);
  }
  for (std::size_t p = 0; p < count; ++p) {
    if (!used[p] || !used[count + p]) continue;
    split.target[count + p] = static_cast<std::int32_t>(split.patches.size());
    std::string name = mesh.patches[p] + "_interior";
    while (std::any_of(split.patches.begin(), split.patches.end(),
                       [&](const mesh::Patch& patch) { return patch.name == name; }))
      name += "_";
    split.patches.push_back({name, mesh::PatchType::interior});
  }
  return split;
}

Block cells_of(const mesh::Piece& piece, CellShape shape) {
  Block block{corners_of(shape), mesh::connectivity_of(piece, shape), {}, 0, {}};
  mesh::for_each_region_run(piece, shape, [&](mesh::RegionId region, LocalIndex begin, LocalIndex end) {
    block.runs.push_back({region, begin, end, 0});
  });
  return block;
}

/// The boundary faces of a piece in the order of patches.
Block faces_of_piece(const mesh::DistributedMesh& mesh, const mesh::Piece& piece, FaceShape shape,
                     const SplitPatches& split) {
  Block block{corners_of(shape), mesh::connectivity_of(piece, shape), {}, 0, {}};
  const auto faces = mesh::cad_faces_of(piece, shape), patches = mesh::patches_of(piece, shape);
  const auto patch = [&](LocalIndex f) { return split.target[patch_with_side(mesh, patches[f], faces[f])]; };
  const auto less = [&](LocalIndex a, LocalIndex b) { return patch(a) < patch(b); };
  block.order.resize(faces.size());
  std::iota(block.order.begin(), block.order.end(), 0);
  const bool in_order = std::is_sorted(block.order.begin(), block.order.end(), less);
  if (!in_order) std::stable_sort(block.order.begin(), block.order.end(), less);
  for (std::size_t i = 0; i < block.order.size(); ++i) {
    const std::int32_t id = patch(block.order[i]);
    const auto at = static_cast<LocalIndex>(i);
    if (block.runs.empty() || block.runs.back().id != id) block.runs.push_back({id, at, at, 0});
    ++block.runs.back().end;
  }
  if (in_order) block.order = {};
  return block;
}

MeshPart part_of(const mesh::NumberedMesh& mesh, std::size_t i, const SplitPatches& split) {
  const mesh::Piece& piece = mesh.pieces[i];
  MeshPart part;
  part.id = piece.id;
  part.piece = &piece;
  part.coordinates = piece.coordinates;
  part.numbers = mesh.numbering.vertices[i];
  part.layers = piece.layers;
  part.owned = mesh.numbering.owned[i];
  part.owned_count = static_cast<LocalIndex>(std::count(part.owned.begin(), part.owned.end(), 1));
  for (const CellShape shape : cell_shapes)
    part.cells[static_cast<std::size_t>(shape)] = cells_of(piece, shape);
  for (const FaceShape shape : face_shapes)
    part.faces[static_cast<std::size_t>(shape)] = faces_of_piece(mesh, piece, shape, split);
  return part;
}

void require(bool condition, std::int32_t part, const char* what) {
  if (!condition) throw std::logic_error(fmt::format("part {}: {}", part, what));
}

void require_fitting(const mesh::NumberedMesh& mesh) {
  if (mesh.numbering.vertices.size() != mesh.pieces.size() ||
      mesh.numbering.owned.size() != mesh.pieces.size())
    throw std::logic_error("the numbering does not belong to the mesh");
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const mesh::Piece& piece = mesh.pieces[i];
    mesh::require_consistent_arrays(piece);
    const auto vertices = static_cast<std::size_t>(piece.vertex_count());
    require(mesh.numbering.vertices[i].size() == vertices && mesh.numbering.owned[i].size() == vertices,
            piece.id, "arrays of vertices differ in length");
    for (const FaceShape shape : face_shapes) {
      for (const std::int32_t patch : mesh::patches_of(piece, shape))
        require(patch >= 0 && static_cast<std::size_t>(patch) < mesh.patches.size(), piece.id,
                "a patch does not exist");
    }
    for (const CellShape shape : cell_shapes) {
      mesh::for_each_region_run(piece, shape, [&](mesh::RegionId region, LocalIndex, LocalIndex) {
        require(region >= 0 && region < mesh.region_count(), piece.id, "a region does not exist");
      });
    }
  }
}

void require_numbers(const FileMesh& mesh) {
  for (const MeshPart& part : mesh.parts) {
    GlobalIndex next = part.first_owned;
    for (std::size_t v = 0; v < part.numbers.size(); ++v) {
      if (part.owned[v])
        require(part.numbers[v] == next++, part.id, "its own vertices are not numbered in turn");
      require(part.numbers[v] >= 0 && part.numbers[v] < mesh.vertex_count, part.id, "a vertex has no number");
    }
  }
}

}  // namespace

GlobalIndex FileMesh::cell_count(CellShape shape) const {
  return counts(CountedFaces::all).cells[static_cast<std::size_t>(shape)];
}

GlobalIndex FileMesh::cell_count() const {
  const ShapeCounts all = counts(CountedFaces::all);
  return std::accumulate(all.cells.begin(), all.cells.end(), GlobalIndex{0});
}

GlobalIndex FileMesh::boundary_count(FaceShape shape) const {
  return counts(CountedFaces::boundary).faces[static_cast<std::size_t>(shape)];
}

ShapeCounts FileMesh::counts(CountedFaces faces) const {
  ShapeCounts counts{.vertices = vertex_count};
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (faces == CountedFaces::boundary && patches[p].type == mesh::PatchType::interior) continue;
    for (std::size_t s = 0; s < face_shape_count; ++s) counts.faces[s] += patch_faces[p][s];
  }
  for (const auto& of_region : region_cells) {
    for (std::size_t s = 0; s < cell_shape_count; ++s) counts.cells[s] += of_region[s];
  }
  return counts;
}

FileMesh file_mesh_of(const mesh::NumberedMesh& mesh) {
  const parallel::Communicator& communicator = mesh.communicator;
  parallel::agree(communicator, [&] { require_fitting(mesh); });
  FileMesh result;
  result.pieces = &mesh;
  result.part_count = mesh.piece_count;
  result.regions = mesh.regions.empty() ? std::vector<std::string>{"fluid"} : mesh.regions;
  SplitPatches split = split_patches(mesh);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) result.parts.push_back(part_of(mesh, i, split));
  result.patches = std::move(split.patches);
  const bool layers_here = std::any_of(mesh.pieces.begin(), mesh.pieces.end(),
                                       [](const mesh::Piece& piece) { return !piece.layers.empty(); });
  result.has_layers = communicator.maximum(std::int64_t{layers_here}) > 0;
  finish(result);
  parallel::agree(communicator, [&] { require_numbers(result); });
  return result;
}

FileMesh file_mesh_of(mesh::NumberedMesh&& mesh) {
  const auto held = std::make_shared<const mesh::NumberedMesh>(std::move(mesh));
  FileMesh result = file_mesh_of(*held);
  result.held = held;
  return result;
}

FileMesh repartition(const FileMesh& mesh, std::int32_t parts, mesh::PieceRegions regions) {
  FileMesh cut = file_mesh_of(mesh::repartition(*mesh.pieces, parts, regions));
  cut.flow = mesh.flow;
  return cut;
}

}  // namespace aeroloom::io
