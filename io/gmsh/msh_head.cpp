#include "io/gmsh/msh_head.hpp"

#include "io/distinct_names.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <limits>
#include <tuple>
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

/// Binary values one after another.
class Binary {
public:
  explicit Binary(std::string& text) : _text(text) {}
  template <class T>
  void put(T value) {
    _text.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void sizes(std::initializer_list<std::int64_t> values) {
    for (const std::int64_t value : values) put(value);
  }
  void box(const MshBox& box) {
    const bool empty = box.least[0] > box.largest[0];
    // Plus zero: which sign a zero of several parts has depends on who came first.
    for (const double x : box.least) put(empty ? 0.0 : x + 0.0);
    for (const double x : box.largest) put(empty ? 0.0 : x + 0.0);
  }

private:
  std::string& _text;
};

void add_entities(std::string& text, const FileMesh& mesh, const std::vector<MshBox>& boxes) {
  const std::size_t patches = mesh.patches.size(), regions = mesh.regions.size();
  text += "$Entities\n";
  Binary binary(text);
  binary.sizes({0, 0, static_cast<std::int64_t>(patches), static_cast<std::int64_t>(regions)});
  for (std::size_t i = 0; i < patches + regions; ++i) {
    const auto tag = static_cast<std::int32_t>((i < patches ? i : i - patches) + 1);
    binary.put(tag);
    binary.box(boxes[i]);
    binary.put(std::int64_t{1});
    binary.put(tag);
    binary.put(std::int64_t{0});  // bounding entities
  }
  text += "\n$EndEntities\n";
}

void add_partition(std::string& text, const FileMesh& mesh, const std::vector<MshBox>& boxes,
                   const MshPartition& partition) {
  text += "$PartitionedEntities\n";
  Binary binary(text);
  binary.sizes({mesh.part_count, 0, 0, 0, static_cast<std::int64_t>(partition.patches.size()),
                static_cast<std::int64_t>(partition.regions.size())});
  const auto add = [&](std::int32_t dimension, std::size_t entities, std::int32_t id, const MshBox& box) {
    binary.put(
        static_cast<std::int32_t>(partitioned_tag(static_cast<std::int64_t>(entities), partition.part, id)));
    binary.put(dimension);
    binary.put(id + 1);
    binary.put(std::int64_t{1});
    binary.put(partition.part);
    binary.box(box);
    binary.put(std::int64_t{1});
    binary.put(id + 1);
    binary.put(std::int64_t{0});
  };
  for (const std::int32_t patch : partition.patches)
    add(2, mesh.patches.size(), patch, boxes[static_cast<std::size_t>(patch)]);
  for (const std::int32_t region : partition.regions)
    add(3, mesh.regions.size(), region, boxes[mesh.patches.size() + static_cast<std::size_t>(region)]);
  text += "\n$EndPartitionedEntities\n";
}

/// Grows the boxes of the entities of a block.
void grow(std::vector<MshBox>& boxes, std::size_t first, const FilePart& part, const Block& block) {
  for (const Run& run : block.runs) {
    MshBox& box = boxes[first + static_cast<std::size_t>(run.id)];
    for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
      for (int corner = 0; corner < block.corners; ++corner) {
        const double* p = part.coordinates.data() + 3 * static_cast<std::size_t>(block.item(i)[corner]);
        for (std::size_t k = 0; k < 3; ++k) {
          box.least[k] = std::min(box.least[k], p[k]);
          box.largest[k] = std::max(box.largest[k], p[k]);
        }
      }
    }
  }
}

}  // namespace

std::vector<MshBox> boxes_of_entities(const FileMesh& mesh) {
  const parallel::Communicator& communicator = mesh.pieces->communicator;
  constexpr double far = std::numeric_limits<double>::infinity();
  std::vector<MshBox> boxes(mesh.patches.size() + mesh.regions.size(), {{far, far, far}, {-far, -far, -far}});
  for (const FilePart& part : mesh.parts) {
    for (const Block& block : part.faces) grow(boxes, 0, part, block);
    for (const Block& block : part.cells) grow(boxes, mesh.patches.size(), part, block);
  }
  struct EntityBox {
    std::int64_t entity;
    MshBox box;

    static constexpr auto fields() { return std::tuple(&EntityBox::entity, &EntityBox::box); }
  };
  std::vector<EntityBox> found;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].least[0] <= boxes[i].largest[0]) found.push_back({static_cast<std::int64_t>(i), boxes[i]});
  }
  const auto merge = [&](const std::vector<EntityBox>& items) {
    for (const EntityBox& item : items) {
      MshBox& box = boxes[static_cast<std::size_t>(item.entity)];
      for (std::size_t k = 0; k < 3; ++k) {
        box.least[k] = std::min(box.least[k], item.box.least[k]);
        box.largest[k] = std::max(box.largest[k], item.box.largest[k]);
      }
    }
  };
  // Each entity meets on one rank, so that nobody gathers a box of every rank.
  const std::vector<EntityBox> met =
      mesh::meet_by_key(communicator, std::move(found), &EntityBox::entity, &EntityBox::entity);
  merge(met);
  found.clear();
  mesh::for_each_key(met, &EntityBox::entity, [&](std::span<const EntityBox> group) {
    const std::int64_t entity = group.front().entity;
    found.push_back({entity, boxes[static_cast<std::size_t>(entity)]});
  });
  merge(communicator.all_gather_items(std::span<const EntityBox>(found)));
  return boxes;
}

std::string msh_head(const FileMesh& mesh, const std::vector<MshBox>& boxes, const MshPartition* partition) {
  std::string text = "$MeshFormat\n4.1 1 8\n";
  Binary(text).put(std::int32_t{1});
  text += "\n$EndMeshFormat\n$Comments\nAeroloom\n";
  for (std::size_t i = 0; i < mesh.patches.size(); ++i) {
    const mesh::Patch& patch = mesh.patches[i];
    text += fmt::format("patch {} {} {}\n", i + 1, mesh::name_of(patch.type), escaped_word(patch.name));
  }
  for (std::size_t i = 0; i < mesh.regions.size(); ++i)
    text += fmt::format("region {} {}\n", i + 1, escaped_word(mesh.regions[i]));
  text += fmt::format("$EndComments\n$PhysicalNames\n{}\n", mesh.patches.size() + mesh.regions.size());
  const auto add_names = [&](int dimension, const std::vector<std::string>& names) {
    const std::vector<std::string> held = distinct_names(names, longest_name, quotable);
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
