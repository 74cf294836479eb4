#include "io/doubled_nodes.hpp"

#include "geometry/place_text.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using PlaceBits = std::array<std::uint64_t, 3>;

/// Equal for equal coordinates: -0 becomes 0.
PlaceBits bits_of(geometry::Vec3 p) {
  return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0),
          std::bit_cast<std::uint64_t>(p.z + 0.0)};
}
geometry::Vec3 place_of(const PlaceBits& bits) {
  return {std::bit_cast<double>(bits[0]), std::bit_cast<double>(bits[1]), std::bit_cast<double>(bits[2])};
}

/// A node of a face, as the cells of a region use it.
struct PlacedNode {
  PlaceBits place{};
  GlobalIndex number = 0;
  std::int32_t region = 0;
};

/// A face by the places of its corners, ascending; a triangle has the first twice.
struct PlacedFace {
  std::array<PlaceBits, 4> corners{};
  std::array<GlobalIndex, 4> numbers{};
  std::int32_t patch = 0;
};

std::vector<PlacedNode> nodes_of_faces(const MeshPart& part) {
  std::vector<char> on_face(static_cast<std::size_t>(part.vertex_count()), 0);
  for (const Block& block : part.faces) {
    for (const LocalIndex v : block.connectivity) on_face[static_cast<std::size_t>(v)] = 1;
  }
  std::vector<std::pair<LocalIndex, std::int32_t>> used;  // by regions
  for (const Block& block : part.cells) {
    for (const Run& run : block.runs) {
      for (LocalIndex c = run.begin; c < run.end; ++c) {
        for (int i = 0; i < block.corners; ++i) {
          const LocalIndex v = block.item(c)[i];
          if (on_face[static_cast<std::size_t>(v)] != 0) used.emplace_back(v, run.id);
        }
      }
    }
  }
  geometry::sort_unique(used);
  std::vector<PlacedNode> nodes;
  nodes.reserve(used.size());
  for (const auto& [v, region] : used)
    nodes.push_back({bits_of(part.point(v)), part.numbers[static_cast<std::size_t>(v)], region});
  return nodes;
}

void add_faces(const MeshPart& part, std::vector<PlacedFace>& faces) {
  for (const Block& block : part.faces) {
    for (const Run& run : block.runs) {
      for (LocalIndex f = run.begin; f < run.end; ++f) {
        std::array<std::pair<PlaceBits, GlobalIndex>, 4> corners;
        for (int i = 0; i < block.corners; ++i) {
          const LocalIndex v = block.item(f)[i];
          corners[i] = {bits_of(part.point(v)), part.numbers[static_cast<std::size_t>(v)]};
        }
        std::sort(corners.begin(), corners.begin() + block.corners);
        if (block.corners == 3) corners[3] = corners[2];
        PlacedFace& face = faces.emplace_back();
        face.patch = run.id;
        for (int i = 0; i < 4; ++i) std::tie(face.corners[i], face.numbers[i]) = corners[i];
      }
    }
  }
}

/// Names whose counts over all ranks are positive. Collective.
std::vector<std::string> names_counted(const parallel::Communicator& communicator,
                                       std::vector<std::int64_t> counts,
                                       const std::vector<std::string>& names) {
  communicator.sum_each(counts);
  std::vector<std::string> counted;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) counted.push_back(names[i]);
  return counted;
}

/// Collective.
void count_nodes(const FileMesh& mesh, DoubledNodes& doubled) {
  const parallel::Communicator& communicator = mesh.communicator();
  std::vector<PlacedNode> mine;
  for (const MeshPart& part : mesh.parts) {
    const std::vector<PlacedNode> nodes = nodes_of_faces(part);
    mine.insert(mine.end(), nodes.begin(), nodes.end());
  }
  const std::vector<PlacedNode> met =
      mesh::meet_by_key(communicator, std::move(mine), &PlacedNode::place,
                        [](const PlacedNode& node) { return std::pair(node.number, node.region); });
  std::vector<std::int64_t> regions(mesh.regions.size(), 0);
  std::optional<geometry::Vec3> first;
  const auto less = [](geometry::Vec3 a, geometry::Vec3 b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  mesh::for_each_key(met, &PlacedNode::place, [&](std::span<const PlacedNode> group) {
    if (group.front().number == group.back().number) return;
    for (std::size_t i = 0; i < group.size(); ++i) {
      doubled.nodes += i > 0 && group[i].number != group[i - 1].number;
      ++regions[static_cast<std::size_t>(group[i].region)];
    }
    const geometry::Vec3 at = place_of(group.front().place);
    if (!first || less(at, *first)) first = at;
  });
  doubled.nodes = communicator.sum(doubled.nodes);
  doubled.regions = names_counted(communicator, std::move(regions), mesh.regions);
  std::vector<geometry::Vec3> own;
  if (first) own.push_back(*first);
  const std::vector<geometry::Vec3> all = communicator.all_gather_items(std::span<const geometry::Vec3>(own));
  if (!all.empty()) doubled.place = *std::ranges::min_element(all, less);
}

/// Collective.
void count_faces(const FileMesh& mesh, DoubledNodes& doubled) {
  const parallel::Communicator& communicator = mesh.communicator();
  std::vector<PlacedFace> mine;
  for (const MeshPart& part : mesh.parts) add_faces(part, mine);
  const std::vector<PlacedFace> met =
      mesh::meet_by_key(communicator, std::move(mine), &PlacedFace::corners,
                        [](const PlacedFace& face) { return std::pair(face.numbers, face.patch); });
  std::vector<std::int64_t> patches(mesh.patches.size(), 0);
  mesh::for_each_key(met, &PlacedFace::corners, [&](std::span<const PlacedFace> group) {
    if (group.front().numbers == group.back().numbers) return;
    doubled.faces += static_cast<std::int64_t>(group.size());
    for (const PlacedFace& face : group) ++patches[static_cast<std::size_t>(face.patch)];
  });
  doubled.faces = communicator.sum(doubled.faces);
  std::vector<std::string> names;
  for (const mesh::Patch& patch : mesh.patches) names.push_back(patch.name);
  doubled.patches = names_counted(communicator, std::move(patches), names);
}

std::string quoted_list(const std::vector<std::string>& names) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : i + 1 == names.size() ? " and " : ", ", names[i]);
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

}  // namespace

DoubledNodes find_doubled_nodes(const FileMesh& mesh) {
  DoubledNodes doubled;
  count_nodes(mesh, doubled);
  if (doubled.nodes > 0) count_faces(mesh, doubled);
  return doubled;
}

std::string describe(const DoubledNodes& doubled) {
  const bool between = doubled.regions.size() > 1;
  std::string text = fmt::format("{} nodes lie at the places of others, the first at {}, {} {}",
                                 doubled.nodes, geometry::place_text(doubled.place),
                                 between ? "on an interface between the regions" : "within the region",
                                 quoted_list(doubled.regions));
  if (doubled.faces > 0)
    text += fmt::format(" ({} faces that lie on one another, of patches {})", doubled.faces,
                        quoted_list(doubled.patches));
  return text +
         (between ? ": the regions are not connected there, each has nodes and a boundary of its own. "
                  : ": the cells on both sides are not connected there, as at a slit. ") +
         "Remedy, if a solver is to pass through: make equal nodes one in the program that wrote the mesh";
}

}  // namespace aeroloom::io
