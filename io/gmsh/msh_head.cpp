#include "io/gmsh/msh_head.hpp"

#include "io/distinct_names.hpp"
#include "io/streams/byte_order.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

constexpr std::size_t longest_name = 127;

/// On one line and between double quotes.
std::string quotable(const std::string& name) {
  std::string result = name.empty() ? "unnamed" : name;
  for (char& letter : result) {
    if (letter == '"') letter = '\'';
    if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
  }
  return result;
}

std::vector<std::string> patch_names(const FileMesh& mesh) {
  std::vector<std::string> names;
  for (const mesh::Patch& patch : mesh.patches) names.push_back(patch.name);
  return names;
}

/// A name on a line of its own section: line breaks and backslashes escaped.
std::string escaped_word(const std::string& name) {
  std::string result;
  for (const char letter : name) {
    if (letter == '\\' || letter == '\n' || letter == '\r') result += '\\';
    result += letter == '\n' ? 'n' : letter == '\r' ? 'r' : letter;
  }
  return result;
}

void append_box(std::string& text, const geometry::Box& box) {
  // Plus zero: which sign a zero of several parts has depends on who came first.
  for (const geometry::Vec3 p : {box.low, box.high})
    for (const double x : {p.x, p.y, p.z}) append_bytes(text, box.empty() ? 0.0 : x + 0.0);
}

void add_entities(std::string& text, const FileMesh& mesh, const std::vector<geometry::Box>& boxes) {
  const std::size_t patches = mesh.patches.size(), regions = mesh.regions.size();
  text += "$Entities\n";
  append_sizes(text, {0, 0, static_cast<std::int64_t>(patches), static_cast<std::int64_t>(regions)});
  for (std::size_t i = 0; i < patches + regions; ++i) {
    const auto tag = static_cast<std::int32_t>((i < patches ? i : i - patches) + 1);
    append_bytes(text, tag);
    append_box(text, boxes[i]);
    append_bytes(text, std::int64_t{1});
    append_bytes(text, tag);
    append_bytes(text, std::int64_t{0});  // bounding entities
  }
  text += "\n$EndEntities\n";
}

void add_partition(std::string& text, const FileMesh& mesh, const std::vector<geometry::Box>& boxes,
                   const MshPartition& partition) {
  text += "$PartitionedEntities\n";
  append_sizes(text, {mesh.part_count, 0, 0, 0, static_cast<std::int64_t>(partition.patches.size()),
                      static_cast<std::int64_t>(partition.regions.size())});
  const auto add = [&](std::int32_t dimension, std::size_t entities, std::int32_t id,
                       const geometry::Box& box) {
    append_bytes(text, static_cast<std::int32_t>(
                           partitioned_tag(static_cast<std::int64_t>(entities), partition.part, id)));
    append_bytes(text, dimension);
    append_bytes(text, id + 1);
    append_bytes(text, std::int64_t{1});
    append_bytes(text, partition.part);
    append_box(text, box);
    append_bytes(text, std::int64_t{1});
    append_bytes(text, id + 1);
    append_bytes(text, std::int64_t{0});
  };
  for (const std::int32_t patch : partition.patches)
    add(2, mesh.patches.size(), patch, boxes[static_cast<std::size_t>(patch)]);
  for (const std::int32_t region : partition.regions)
    add(3, mesh.regions.size(), region, boxes[mesh.patches.size() + static_cast<std::size_t>(region)]);
  text += "\n$EndPartitionedEntities\n";
}

/// Grows the boxes of the entities of a block.
void grow(std::vector<geometry::Box>& boxes, std::size_t first, const MeshPart& part, const Block& block) {
  for (const Run& run : block.runs) {
    geometry::Box& box = boxes[first + static_cast<std::size_t>(run.id)];
    for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
      for (int corner = 0; corner < block.corners; ++corner) box.add(part.point(block.item(i)[corner]));
    }
  }
}

}  // namespace

std::vector<std::string> physical_names(const std::vector<std::string>& names) {
  return distinct_names(names, longest_name, quotable);
}

std::vector<geometry::Box> boxes_of_entities(const FileMesh& mesh) {
  std::vector<geometry::Box> boxes(mesh.patches.size() + mesh.regions.size());
  for (const MeshPart& part : mesh.parts) {
    for (const Block& block : part.faces) grow(boxes, 0, part, block);
    for (const Block& block : part.cells) grow(boxes, mesh.patches.size(), part, block);
  }
  struct EntityBox {
    std::int64_t entity;
    geometry::Box box;
  };
  std::vector<EntityBox> found;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].empty()) found.push_back({static_cast<std::int64_t>(i), boxes[i]});
  }
  const auto merge = [&](const std::vector<EntityBox>& items) {
    for (const EntityBox& item : items) boxes[static_cast<std::size_t>(item.entity)].add(item.box);
  };
  // Each entity meets on one rank, so that nobody gathers a box of every rank.
  const std::vector<EntityBox> met =
      mesh::meet_by_key(mesh.communicator(), std::move(found), &EntityBox::entity, &EntityBox::entity);
  merge(met);
  found.clear();
  mesh::for_each_key(met, &EntityBox::entity, [&](std::span<const EntityBox> group) {
    const std::int64_t entity = group.front().entity;
    found.push_back({entity, boxes[static_cast<std::size_t>(entity)]});
  });
  merge(mesh.communicator().all_gather_items(std::span<const EntityBox>(found)));
  return boxes;
}

std::string msh_head(const FileMesh& mesh, const std::vector<geometry::Box>& boxes,
                     const MshPartition* partition) {
  std::string text = "$MeshFormat\n4.1 1 8\n";
  append_bytes(text, std::int32_t{1});
  text += "\n$EndMeshFormat\n$Comments\nAeroloom\n";
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    const mesh::Patch& patch = mesh.patches[i];
    text += fmt::format("patch {} {} {}\n", i + 1, mesh::name_of(patch.type), escaped_word(patch.name));
  }
  for (std::size_t i = 0; i < mesh.regions.size(); ++i)
    text += fmt::format("region {} {}\n", i + 1, escaped_word(mesh.regions[i]));
  text += fmt::format("$EndComments\n$PhysicalNames\n{}\n", mesh.patches.size() + mesh.regions.size());
  const auto add_names = [&](int dimension, const std::vector<std::string>& names) {
    const std::vector<std::string> held = physical_names(names);
    for (std::size_t i = 0; i < held.size(); ++i)
      text += fmt::format("{} {} \"{}\"\n", dimension, i + 1, held[i]);
  };
  add_names(2, patch_names(mesh));
  add_names(3, mesh.regions);
  text += "$EndPhysicalNames\n";
  add_entities(text, mesh, boxes);
  if (partition != nullptr) add_partition(text, mesh, boxes, *partition);
  return text;
}

}  // namespace aeroloom::io
