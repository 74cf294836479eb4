#include "io/gmsh/gmsh_reader.hpp"

#include "io/distinct_names.hpp"
#include "io/gmsh/msh_layout.hpp"
#include "io/gmsh/msh_tables.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

/// Values that are read at a time.
constexpr std::int64_t integers_at_once = std::int64_t{1} << 16;

/// What becomes a region (dimension 3) or a patch (2).
struct Group {
  std::int32_t dimension = 3;
  std::int32_t is_entity = 0;  ///< 0: a physical group
  std::int32_t tag = 0;
  auto operator<=>(const Group&) const = default;
};

/// A file that this rank reads, alone or as one of several readers.
struct Source {
  MshScanner scanner;
  MshTables tables;
  int reader = 0, readers = 1;
};

/// The items of a block that this reader reads. The block has `count` of `total` items; `before` of them lie
/// in front of it.
LocalRange range_of(const Source& source, std::int64_t before, std::int64_t count, std::int64_t total) {
  const LocalRange range = LocalRange::of(total, source.reader, source.readers);
  return {std::clamp(range.begin - before, std::int64_t{0}, count),
          std::clamp(range.end - before, std::int64_t{0}, count)};
}

std::string part_path(const std::string& stem, std::int64_t part) {
  return fmt::format("{}_{}.msh", stem, part);
}

/// The stem where `path` is STEM_1.msh or STEM_*.msh, else empty.
std::string stem_of(const std::string& path) {
  for (const std::string ending : {"_1.msh", "_*.msh"}) {
    if (path.ends_with(ending)) return path.substr(0, path.size() - ending.size());
  }
  return {};
}

/// How many files there are beside the first; 0: `path` stands for itself.
std::int64_t count_parts(const std::string& path) {
  const std::string stem = stem_of(path);
  if (stem.empty()) return 0;
  MshScanner scanner(part_path(stem, 1));
  const MshTables tables = read_msh_tables(scanner, 0, MshExtent::before_nodes);
  const std::int64_t parts = tables.partitions;
  const bool is_pattern = path.ends_with("_*.msh");
  if (parts < 1 && is_pattern) scanner.fail("the file has no partitions: give its own name");
  // A file of all partitions may be called like the first of several; such a one has its own volumes alone.
  const bool is_first = parts > 1 && tables.cell_partitions == std::set<std::int32_t>{1};
  if (parts < 1 || (!is_pattern && !is_first && !fs::exists(part_path(stem, 2)))) return is_pattern ? 1 : 0;
  for (std::int64_t part = 1; part <= parts; ++part) {
    if (!fs::exists(part_path(stem, part))) {
      throw fs::filesystem_error(fmt::format("the mesh has {} partitions, one of them is missing", parts),
                                 part_path(stem, part),
                                 std::make_error_code(std::errc::no_such_file_or_directory));
    }
  }
  return parts;
}

std::vector<Source> open_sources(const SharedPath& file, std::int64_t parts) {
  std::vector<Source> sources;
  const int rank = file.communicator.rank(), ranks = file.communicator.size();
  if (parts == 0) {
    Source source{MshScanner(file.path), {}, rank, ranks};
    source.tables = read_msh_tables(source.scanner, 0, MshExtent::before_nodes);
    if (!source.scanner.binary && rank > 0) return sources;
    if (!source.scanner.binary) source.reader = 0, source.readers = 1;
    source.scanner.seek(0);
    source.scanner.binary = false;
    source.tables = read_msh_tables(source.scanner, 0, MshExtent::all);
    sources.push_back(std::move(source));
    return sources;
  }
  for (std::int64_t part = parts * rank / ranks; part < parts * (rank + 1) / ranks; ++part) {
    Source source{MshScanner(part_path(stem_of(file.path), part + 1)), {}, 0, 1};
    source.tables = read_msh_tables(source.scanner, part + 1, MshExtent::all);
    sources.push_back(std::move(source));
  }
  return sources;
}

/// The group of a block's elements; of dimension 0 where they are not to be read.
Group group_of(const MshTables& tables, const MshElementBlock& block) {
  // Ghosts have the dimension of the cells.
  if (block.dimension == 3 && tables.ghost_entities.contains(block.entity)) return {0, 0, 0};
  const auto found = tables.entities.find({block.dimension, block.entity});
  if (found == tables.entities.end()) return {block.dimension, 1, block.entity};
  const MshEntity& entity = found->second;
  if (entity.partitioned && entity.parent_dimension != block.dimension) return {0, 0, 0};
  for (const std::int32_t tag : entity.physical) {
    const auto name = tables.physical_names.find({block.dimension, tag});
    // The name that Gmsh gives the subgroups of a group when it partitions a mesh.
    if (name != tables.physical_names.end() && name->second.starts_with("_part{")) continue;
    return {block.dimension, 0, tag};
  }
  return {block.dimension, 1, entity.partitioned ? entity.parent : block.entity};
}

struct NamedGroup {
  Group group;
  std::string name;
  mesh::PatchType type = mesh::PatchType::wall;
};

mesh::PatchType type_of(const std::string& comment, const std::string& name) {
  if (const auto type = mesh::patch_type_of(comment)) return *type;
  return mesh::patch_type_by_name(name).value_or(mesh::PatchType::wall);
}

NamedGroup name_group(const MshTables& tables, const Group& group) {
  NamedGroup named{group, fmt::format("{}_{}", group.dimension == 2 ? "surface" : "volume", group.tag)};
  if (group.is_entity != 0) return named;
  const MshTag tag{group.dimension, group.tag};
  if (const auto name = tables.physical_names.find(tag); name != tables.physical_names.end())
    named.name = name->second;
  MshComment comment;
  if (const auto found = tables.comments.find(tag); found != tables.comments.end()) comment = found->second;
  if (!comment.name.empty()) named.name = comment.name;
  named.type = type_of(comment.type, named.name);
  return named;
}

/// All groups of all files in order of dimension, kind and tag, on every rank.
std::vector<NamedGroup> agree_on_groups(const parallel::Communicator& communicator,
                                        const std::vector<Source>& sources) {
  std::map<Group, NamedGroup> mine;
  for (const Source& source : sources) {
    for (const MshElementBlock& block : source.tables.elements) {
      const Group group = group_of(source.tables, block);
      if (group.dimension > 0 && !mine.contains(group)) mine[group] = name_group(source.tables, group);
    }
  }
  std::map<Group, NamedGroup> all;
  for (std::map<Group, NamedGroup>& groups : communicator.all_gather_values(mine)) all.merge(groups);
  std::vector<NamedGroup> result;
  result.reserve(all.size());
  for (auto& [group, named] : all) result.push_back(std::move(named));
  return result;
}

/// Groups of one name stay distinct.
void make_names_distinct(RawMesh& raw) {
  constexpr std::size_t longest = std::size_t{1} << 16;
  const auto same = [](const std::string& name) { return name; };
  std::vector<std::string> names;
  names.reserve(raw.patches.size());
  for (const mesh::Patch& patch : raw.patches) names.push_back(patch.name);
  names = distinct_names(names, longest, same);
  for (std::size_t i = 0; i < names.size(); ++i) raw.patches[i].name = names[i];
  raw.regions = distinct_names(raw.regions, longest, same);
}

void require_tag(const MshScanner& scanner, std::int64_t tag) {
  if (tag < 0 || tag > largest_id) scanner.fail(fmt::format("{} is no tag of a node", tag));
}

void read_nodes(Source& source, RawMesh& raw) {
  std::int64_t total = 0, before = 0;
  for (const MshNodeBlock& block : source.tables.nodes) total += block.count;
  for (const MshNodeBlock& block : source.tables.nodes) {
    const auto [begin, end] = range_of(source, before, block.count, total);
    before += block.count;
    if (begin == end) continue;
    MshScanner& scanner = source.scanner;
    const std::size_t first = raw.point_ids.size();
    scanner.seek(block.tags + 8 * begin);
    raw.point_ids.resize(first + static_cast<std::size_t>(end - begin));
    scanner.int64s(raw.point_ids.data() + first, end - begin);
    for (std::size_t i = first; i < raw.point_ids.size(); ++i) require_tag(scanner, raw.point_ids[i]);
    scanner.seek(block.points + 8 * block.stride * begin);
    raw.coordinates.resize(3 * raw.point_ids.size());
    double* to = raw.coordinates.data() + 3 * first;
    if (block.stride == 3) {
      scanner.reals(to, 3 * (end - begin));
      continue;
    }
    for (std::int64_t i = begin; i < end; ++i, to += 3) {
      std::array<double, 6> values{};
      scanner.reals(values.data(), block.stride);
      std::copy_n(values.begin(), 3, to);
    }
  }
}

/// Appends a range of a block's elements, without ghosts, to corners and ids.
void read_block(Source& source, const MshElementBlock& block, const LocalRange& range, std::int32_t id,
                std::vector<mesh::GlobalIndex>& corners, std::vector<std::int32_t>& ids) {
  const std::int64_t width = 1 + block.corners, step = integers_at_once / width;
  const std::vector<std::int64_t>& ghosts = source.tables.ghosts;
  std::vector<std::int64_t> records;
  source.scanner.seek(block.place + 8 * width * range.begin);
  for (std::int64_t i = range.begin; i < range.end; i += step) {
    const std::int64_t taken = std::min(step, range.end - i);
    records.resize(static_cast<std::size_t>(taken * width));
    source.scanner.int64s(records.data(), taken * width);
    for (auto record = records.begin(); record != records.end(); record += width) {
      if (!ghosts.empty() && std::binary_search(ghosts.begin(), ghosts.end(), *record)) continue;
      for (auto corner = record + 1; corner != record + width; ++corner) {
        require_tag(source.scanner, *corner);
        corners.push_back(*corner);
      }
      ids.push_back(id);
    }
  }
}

/// Ids of groups: their places among those of their dimension.
using GroupIds = std::map<Group, std::int32_t>;

void read_elements(Source& source, const GroupIds& groups, RawMesh& raw) {
  const auto read_type = [&](std::int32_t type, std::vector<mesh::GlobalIndex>& corners,
                             std::vector<std::int32_t>& ids) {
    std::int64_t total = 0, before = 0;
    for (const MshElementBlock& block : source.tables.elements) total += block.type == type ? block.count : 0;
    for (const MshElementBlock& block : source.tables.elements) {
      if (block.type != type) continue;
      const LocalRange range = range_of(source, before, block.count, total);
      before += block.count;
      const auto group = groups.find(group_of(source.tables, block));
      if (range.begin < range.end && group != groups.end())
        read_block(source, block, range, group->second, corners, ids);
    }
  };
  for (std::size_t s = 0; s < cell_shape_count; ++s)
    read_type(msh_cell_type[s], raw.cells[s], raw.cell_regions[s]);
  for (std::size_t s = 0; s < face_shape_count; ++s)
    read_type(msh_face_type[s], raw.faces[s], raw.face_patches[s]);
}

}  // namespace

RawMesh read_msh(const SharedPath& file) {
  const parallel::Communicator& communicator = file.communicator;
  std::int64_t parts = 0;
  parallel::on_root(communicator, [&] { parts = count_parts(file.path); });
  parts = communicator.sum(parts);
  std::vector<Source> sources;
  parallel::agree(communicator, [&] { sources = open_sources(file, parts); });
  RawMesh raw(file);
  GroupIds ids;
  for (const NamedGroup& named : agree_on_groups(communicator, sources)) {
    const bool is_patch = named.group.dimension == 2;
    ids[named.group] = static_cast<std::int32_t>(is_patch ? raw.patches.size() : raw.regions.size());
    if (is_patch) {
      raw.patches.push_back({named.name, named.type});
    } else {
      raw.regions.push_back(named.name);
    }
  }
  make_names_distinct(raw);
  if (raw.regions.empty()) raw.regions.emplace_back("volume");
  parallel::agree(communicator, [&] {
    for (Source& source : sources) {
      read_nodes(source, raw);
      read_elements(source, ids, raw);
    }
  });
  return raw;
}

}  // namespace aeroloom::io
