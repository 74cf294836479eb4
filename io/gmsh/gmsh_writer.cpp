#include "io/gmsh/gmsh_writer.hpp"

#include "io/gmsh/msh_head.hpp"
#include "io/gmsh/msh_layout.hpp"
#include "io/local_file.hpp"
#include "io/streams/byte_order.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

using mesh::LocalIndex;

/// Items that are put into their binary form at a time.
constexpr std::size_t batch = std::size_t{1} << 16;

std::string nodes_begin(std::int64_t count, std::int64_t least, std::int64_t largest, std::int32_t entity) {
  std::string text = msh_nodes_begin;
  append_sizes(text, {1, count, least, largest});
  for (const std::int32_t value : {3, entity, 0}) append_bytes(text, value);
  append_bytes(text, count);
  return text;
}

std::string elements_begin(std::int64_t blocks, std::int64_t count, std::int64_t elements) {
  std::string text = msh_nodes_end;
  append_sizes(text, {blocks, count, 1, elements});
  return text;
}

std::string head_of(const MshBlock& block) {
  std::string text;
  for (const std::int32_t value : {block.dimension, block.entity, block.type}) append_bytes(text, value);
  append_bytes(text, block.count);
  return text;
}

/// Calls `write` with the records of a run, a chunk at a time; `first_tag` is the tag of its first element.
template <class Write>
void put_run(const MeshPart& part, const Block& block, const Run& run, std::int64_t first_tag,
             const Write& write) {
  std::vector<std::int64_t> records;
  records.reserve(batch + 8);
  for (LocalIndex i = run.begin; i < run.end; ++i) {
    records.push_back(first_tag + (i - run.begin));
    const LocalIndex* item = block.item(i);
    for (int k = 0; k < block.corners; ++k) records.push_back(part.numbers[item[k]] + 1);
    if (records.size() < batch && i + 1 < run.end) continue;
    write(std::span<const std::int64_t>(records));
    records.clear();
  }
}

/// Calls `visit(block of the part, run, block of the file)` for all runs of a part in the order of the file.
template <class Visit>
void for_runs(const MeshPart& part, const MshBlocks& blocks, const Visit& visit) {
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    for (const Run& run : part.faces[s].runs) visit(part.faces[s], run, blocks.faces[run.id][s]);
  }
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    for (const Run& run : part.cells[s].runs) visit(part.cells[s], run, blocks.cells[run.id][s]);
  }
}

void write_owned(parallel::SharedFile& file, const MeshPart& part, const MshLayout& layout) {
  std::vector<std::int64_t> tags;
  std::vector<double> points;
  tags.reserve(batch);
  points.reserve(3 * batch);
  std::int64_t next = part.first_owned;
  const auto flush = [&] {
    file.write_items(layout.tags + 8 * next, std::span<const std::int64_t>(tags));
    file.write_items(layout.points + 24 * next, std::span<const double>(points));
    next += static_cast<std::int64_t>(tags.size());
    tags.clear();
    points.clear();
  };
  for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
    if (part.owned[v] == 0) continue;
    tags.push_back(part.numbers[v] + 1);
    const double* p = part.coordinates.data() + 3 * static_cast<std::size_t>(v);
    points.insert(points.end(), p, p + 3);
    if (tags.size() == batch) flush();
  }
  flush();
}

void write_part(parallel::SharedFile& file, const MeshPart& part, const MshBlocks& blocks,
                const MshLayout& layout) {
  write_owned(file, part, layout);
  for_runs(part, blocks, [&](const Block& block, const Run& run, const MshBlock& of_file) {
    std::int64_t offset = layout.blocks + of_file.record(run.before);
    put_run(part, block, run, of_file.first_tag + run.before, [&](std::span<const std::int64_t> records) {
      file.write_items(offset, records);
      offset += static_cast<std::int64_t>(records.size_bytes());
    });
  });
}

void write_frame(parallel::SharedFile& file, const std::string& head, std::int64_t vertices,
                 const MshBlocks& blocks, const MshLayout& layout) {
  const auto put = [&](std::int64_t offset, const std::string& text) {
    file.write(offset, std::as_bytes(std::span(text)));
  };
  put(0, head);
  put(layout.nodes, nodes_begin(vertices, 1, vertices, 1));
  put(layout.elements, elements_begin(blocks.written, blocks.elements, blocks.elements));
  const auto put_heads = [&](const auto& of_entities) {
    for (const auto& shapes : of_entities) {
      for (const MshBlock& block : shapes) {
        if (block.count > 0) put(layout.blocks + block.offset, head_of(block));
      }
    }
  };
  put_heads(blocks.faces);
  put_heads(blocks.cells);
  put(layout.end, msh_elements_end);
}

struct PartNames {
  fs::path folder;
  std::string stem;

  std::string path(std::int32_t part) const {
    return (folder / fmt::format("{}_{}.msh", stem, part + 1)).string();
  }
  std::string unfinished(std::int32_t part) const { return path(part) + ".unfinished"; }
};

void write_part_file(const FileMesh& mesh, const MeshPart& part, const MshBlocks& blocks,
                     const std::vector<geometry::Box>& boxes, const std::string& path) {
  std::set<std::int32_t> patches, regions;
  std::int64_t written = 0, elements = 0;
  for_runs(part, blocks, [&](const Block&, const Run& run, const MshBlock& of_file) {
    (of_file.dimension == 2 ? patches : regions).insert(run.id);
    ++written;
    elements += run.end - run.begin;
  });
  const MshPartition partition{
      part.id + 1, {patches.begin(), patches.end()}, {regions.begin(), regions.end()}};
  LocalFile file(path);
  file.text(msh_head(mesh, boxes, &partition));
  const auto entity =
      static_cast<std::int32_t>(partitioned_tag(static_cast<std::int64_t>(mesh.regions.size()),
                                                partition.part, regions.empty() ? 0 : *regions.begin()));
  const auto [least, largest] = std::minmax_element(part.numbers.begin(), part.numbers.end());
  if (part.vertex_count() == 0) {
    file.text(nodes_begin(0, 0, 0, entity));
  } else {
    file.text(nodes_begin(part.vertex_count(), *least + 1, *largest + 1, entity));
  }
  for (const mesh::GlobalIndex number : part.numbers) file.item(std::int64_t{number + 1});
  file.items(part.coordinates);
  file.text(elements_begin(written, elements, blocks.elements));
  for_runs(part, blocks, [&](const Block& block, const Run& run, const MshBlock& of_file) {
    MshBlock here = of_file;
    here.count = run.end - run.begin;
    const std::size_t entities = here.dimension == 2 ? mesh.patches.size() : mesh.regions.size();
    here.entity = static_cast<std::int32_t>(
        partitioned_tag(static_cast<std::int64_t>(entities), partition.part, run.id));
    file.text(head_of(here));
    put_run(part, block, run, of_file.first_tag + run.before,
            [&](std::span<const std::int64_t> records) { file.items(records); });
  });
  file.text(msh_elements_end);
  file.finish();
}

/// Tags of entities are 32-bit.
void require_small_tags(const FileMesh& mesh) {
  const auto most = static_cast<std::int64_t>(std::max(mesh.patches.size(), mesh.regions.size()));
  if (partitioned_tag(most, mesh.part_count, most) > std::numeric_limits<std::int32_t>::max()) {
    throw std::runtime_error(fmt::format(
        "{} parts with {} patches or regions are more entities than an MSH file can number: make fewer parts",
        mesh.part_count, most));
  }
}

}  // namespace

void write_msh(const FileMesh& mesh, const std::string& path) {
  const std::string head = msh_head(mesh, boxes_of_entities(mesh), nullptr);
  const MshBlocks blocks = lay_out_elements(mesh.patch_faces, mesh.region_cells);
  const MshLayout layout = lay_out_file(static_cast<std::int64_t>(head.size()), mesh.vertex_count, blocks);
  parallel::write_shared_file(mesh.communicator(), path, [&](parallel::SharedFile& file) {
    if (mesh.communicator().is_root()) write_frame(file, head, mesh.vertex_count, blocks, layout);
    for (const MeshPart& part : mesh.parts) write_part(file, part, blocks, layout);
  });
}

void write_msh_parts(const FileMesh& mesh, const std::string& path) {
  const parallel::Communicator& communicator = mesh.communicator();
  const PartNames names{fs::path(path).parent_path(), fs::path(path).stem().string()};
  const std::vector<geometry::Box> boxes = boxes_of_entities(mesh);
  const MshBlocks blocks = lay_out_elements(mesh.patch_faces, mesh.region_cells);
  parallel::agree(communicator, [&] {
    require_small_tags(mesh);
    if (communicator.is_root() && !names.folder.empty()) fs::create_directories(names.folder);
  });
  try {
    parallel::agree(communicator, [&] {
      for (const MeshPart& part : mesh.parts)
        write_part_file(mesh, part, blocks, boxes, names.unfinished(part.id));
    });
  } catch (const parallel::CollectiveError&) {
    std::error_code ignored;
    for (const MeshPart& part : mesh.parts) fs::remove(names.unfinished(part.id), ignored);
    throw;
  }
  parallel::agree(communicator, [&] {
    for (const MeshPart& part : mesh.parts) fs::rename(names.unfinished(part.id), names.path(part.id));
  });
  remove_later_msh_parts({communicator, path}, mesh.part_count);
}

void remove_later_msh_parts(const SharedPath& file, std::int32_t parts) {
  const fs::path path = file.path;
  const PartNames names{path.parent_path(), path.stem().string()};
  parallel::on_root(file.communicator, [&] {
    for (std::int32_t part = parts; fs::remove(names.path(part));) ++part;
  });
}

}  // namespace aeroloom::io
