#include "io/file_mesh.hpp"

#include "parallel/collective_error.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

constexpr int kind_count = cell_shape_count + face_shape_count;
constexpr std::array<CellFace, 4> tetrahedron_faces = {
    {{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
constexpr std::array<CellFace, 5> pyramid_faces = {
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
constexpr std::array<CellFace, 5> prism_faces = {
    {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};

/// A block of a part: cells by shape, then faces by shape.
Block& block_of(FilePart& part, int kind) {
  return kind < cell_shape_count ? part.cells[kind] : part.faces[kind - cell_shape_count];
}

void set_corners(FilePart& part) {
  for (const CellShape shape : cell_shapes) part.cells[static_cast<int>(shape)].corners = corners_of(shape);
  for (const FaceShape shape : face_shapes) part.faces[static_cast<int>(shape)].corners = corners_of(shape);
}

/// The runs of ascending ids.
std::vector<Run> runs_of(std::span<const std::int32_t> ids) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (runs.empty() || runs.back().id != ids[i])
      runs.push_back({ids[i], static_cast<LocalIndex>(i), static_cast<LocalIndex>(i), 0});
    ++runs.back().end;
  }
  return runs;
}

/// How many a part has of a kind and id; kind -1: vertices that it owns.
struct CountRow {
  std::int32_t part, kind, id;
  GlobalIndex count;

  static constexpr auto fields() {
    return std::tuple(&CountRow::part, &CountRow::kind, &CountRow::id, &CountRow::count);
  }
};

std::vector<CountRow> count_rows(FileMesh& mesh) {
  std::vector<CountRow> rows;
  for (FilePart& part : mesh.parts) {
    rows.push_back({part.id, -1, 0, part.owned_count});
    for (int kind = 0; kind < kind_count; ++kind) {
      for (const Run& run : block_of(part, kind).runs)
        rows.push_back({part.id, kind, run.id, run.end - run.begin});
    }
  }
  return rows;
}

FilePart* find_part(FileMesh& mesh, std::int32_t id) {
  const auto found =
      std::lower_bound(mesh.parts.begin(), mesh.parts.end(), id,
                       [](const FilePart& part, std::int32_t wanted) { return part.id < wanted; });
  return found != mesh.parts.end() && found->id == id ? &*found : nullptr;
}

/// Adds up the rows of all parts in their order, and tells the parts that are here what came before them.
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
    FilePart* const part = find_part(mesh, row.part);
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
void finish(const parallel::Communicator& communicator, FileMesh& mesh) {
  const std::vector<CountRow> mine = count_rows(mesh);
  const std::vector<CountRow> all = communicator.all_gather_items(std::span<const CountRow>(mine));
  parallel::agree(communicator, [&] { place_parts(mesh, all); });
}

/// A patch whose triangles lie between regions as well as outside is told apart by ids from `inner_ids` on.
std::int32_t patch_with_side(const mesh::DistributedMesh& mesh, const mesh::Piece& piece,
                             std::size_t triangle) {
  const bool inner = mesh.sides_of(piece.triangle_face[triangle]).is_inner();
  return piece.triangle_patch[triangle] + (inner ? static_cast<std::int32_t>(mesh.patches.size()) : 0);
}

/// The patches as files have them, and where each one goes: first those outside, then those between regions.
struct SplitPatches {
  std::vector<mesh::Patch> patches;
  std::vector<std::int32_t> target;
};

SplitPatches split_patches(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh) {
  const std::size_t count = mesh.patches.size();
  std::vector<std::uint8_t> used(2 * count, 0);
  for (const mesh::Piece& piece : mesh.pieces) {
    for (std::size_t t = 0; t < piece.triangle_patch.size(); ++t)
      used.at(patch_with_side(mesh, piece, t)) = 1;
  }
  const std::vector<std::uint8_t> all = communicator.all_gather_items(std::span<const std::uint8_t>(used));
  for (std::size_t i = 0; i < all.size(); ++i) used[i % used.size()] |= all[i];
  SplitPatches split;
  split.target.resize(2 * count);
  for (std::size_t p = 0; p < count; ++p) {
    const bool inner_alone = used[count + p] && !used[p];
    const auto type = p < mesh.patch_types.size() ? mesh.patch_types[p] : mesh::PatchType::wall;
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

/// The boundary of a piece in the order of patches.
void sort_boundary(const mesh::DistributedMesh& mesh, const mesh::Piece& piece, const SplitPatches& split,
                   PartArrays& arrays) {
  const auto patch = [&](LocalIndex t) { return split.target[patch_with_side(mesh, piece, t)]; };
  std::vector<LocalIndex> order(piece.boundary_count());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](LocalIndex a, LocalIndex b) { return patch(a) < patch(b); });
  for (const LocalIndex t : order) {
    const LocalIndex* v = piece.boundary_triangle(t);
    arrays.faces[0].insert(arrays.faces[0].end(), v, v + 3);
    arrays.face_patches[0].push_back(patch(t));
  }
}

void require(bool condition, std::int32_t part, const char* what) {
  if (!condition) throw std::logic_error(fmt::format("part {}: {}", part, what));
}

void require_items(const std::vector<LocalIndex>& connectivity, const std::vector<std::int32_t>& ids,
                   int corners, std::size_t vertices, std::size_t names, std::int32_t part) {
  require(connectivity.size() == ids.size() * static_cast<std::size_t>(corners), part,
          "arrays differ in length");
  require(std::is_sorted(ids.begin(), ids.end()), part, "cells or faces are not in the order of ids");
  require(ids.empty() || (ids.front() >= 0 && static_cast<std::size_t>(ids.back()) < names), part,
          "a region or patch does not exist");
  require(std::all_of(connectivity.begin(), connectivity.end(),
                      [&](LocalIndex v) { return v >= 0 && static_cast<std::size_t>(v) < vertices; }),
          part, "a vertex does not exist");
}

void require_consistent(const PartArrays& arrays, const FileMesh& mesh, std::int32_t part) {
  const std::size_t vertices = arrays.numbers.size();
  require(arrays.coordinates.size() == 3 * vertices && arrays.owned.size() == vertices, part,
          "arrays of vertices differ in length");
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    require_items(arrays.cells[s], arrays.cell_regions[s], corners_of(shape), vertices, mesh.regions.size(),
                  part);
  }
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    require_items(arrays.faces[s], arrays.face_patches[s], corners_of(shape), vertices, mesh.patches.size(),
                  part);
  }
}

FilePart view_of(const PartArrays& arrays, std::int32_t id) {
  FilePart part;
  part.id = id;
  part.coordinates = arrays.coordinates;
  part.numbers = arrays.numbers;
  part.owned = arrays.owned;
  part.owned_count = static_cast<LocalIndex>(std::count(arrays.owned.begin(), arrays.owned.end(), 1));
  set_corners(part);
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    part.cells[s].connectivity = arrays.cells[s];
    part.cells[s].runs = runs_of(arrays.cell_regions[s]);
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    part.faces[s].connectivity = arrays.faces[s];
    part.faces[s].runs = runs_of(arrays.face_patches[s]);
  }
  return part;
}

void require_numbers(const FileMesh& mesh) {
  for (const FilePart& part : mesh.parts) {
    GlobalIndex next = part.first_owned;
    for (std::size_t v = 0; v < part.numbers.size(); ++v) {
      if (part.owned[v])
        require(part.numbers[v] == next++, part.id, "its own vertices are not numbered in turn");
      require(part.numbers[v] >= 0 && part.numbers[v] < mesh.vertex_count, part.id, "a vertex has no number");
    }
  }
}

}  // namespace

std::span<const CellFace> faces_of(CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return tetrahedron_faces;
    case CellShape::pyramid:
      return pyramid_faces;
    case CellShape::prism:
      return prism_faces;
  }
  throw std::logic_error("no such shape of a cell");
}

GlobalIndex FileMesh::cell_count(CellShape shape) const {
  GlobalIndex count = 0;
  for (const auto& of_region : region_cells) count += of_region[static_cast<std::size_t>(shape)];
  return count;
}

GlobalIndex FileMesh::cell_count() const {
  GlobalIndex count = 0;
  for (const CellShape shape : cell_shapes) count += cell_count(shape);
  return count;
}

GlobalIndex FileMesh::boundary_count(FaceShape shape) const {
  GlobalIndex count = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    if (patches[p].type != mesh::PatchType::interior)
      count += patch_faces[p][static_cast<std::size_t>(shape)];
  }
  return count;
}

GlobalIndex FileMesh::face_count(FaceShape shape) const {
  GlobalIndex count = 0;
  for (const auto& of_patch : patch_faces) count += of_patch[static_cast<std::size_t>(shape)];
  return count;
}

FileMesh file_mesh_of(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                      const mesh::Numbering& numbering) {
  FileMesh result;
  result.part_count = mesh.piece_count;
  result.regions = mesh.regions.empty() ? std::vector<std::string>{"fluid"} : mesh.regions;
  SplitPatches split = split_patches(communicator, mesh);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const mesh::Piece& piece = mesh.pieces[i];
    PartArrays& arrays = *result.storage.emplace_back(std::make_unique<PartArrays>());
    sort_boundary(mesh, piece, split, arrays);
    FilePart& part = result.parts.emplace_back(view_of(arrays, piece.id));
    part.coordinates = piece.coordinates;
    part.numbers = numbering.vertices[i];
    part.owned = numbering.owned[i];
    part.owned_count = static_cast<LocalIndex>(std::count(part.owned.begin(), part.owned.end(), 1));
    part.cells[0].connectivity = piece.cells;
    if (piece.cell_count() > 0) part.cells[0].runs = {{piece.region, 0, piece.cell_count(), 0}};
  }
  result.patches = std::move(split.patches);
  finish(communicator, result);
  return result;
}

FileMesh make_file_mesh(const parallel::Communicator& communicator, std::int32_t part_count,
                        std::vector<OwnedPart> parts, std::vector<mesh::Patch> patches,
                        std::vector<std::string> regions) {
  FileMesh result;
  result.part_count = part_count;
  result.patches = std::move(patches);
  result.regions = std::move(regions);
  parallel::agree(communicator, [&] {
    for (OwnedPart& part : parts) {
      require(result.parts.empty() || result.parts.back().id < part.id, part.id, "ids do not ascend");
      require(part.id >= 0 && part.id < part_count, part.id, "the id is out of range");
      require_consistent(*part.arrays, result, part.id);
      result.parts.push_back(view_of(*part.arrays, part.id));
      result.storage.push_back(std::move(part.arrays));
    }
  });
  finish(communicator, result);
  parallel::agree(communicator, [&] { require_numbers(result); });
  return result;
}

}  // namespace aeroloom::io
