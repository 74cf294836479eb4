#include "io/gmsh/msh_tables.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <sstream>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

/// The number of a physical group; a minus says that the group looks at the entity from behind.
std::int32_t physical_group(std::int32_t tag) {
  return tag < 0 ? -std::max(tag, -std::numeric_limits<std::int32_t>::max()) : tag;
}

/// Back from what msh_head.cpp makes of line breaks.
std::string unescaped_word(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\' || i + 1 == text.size()) {
      result += text[i];
      continue;
    }
    ++i;
    result += text[i] == 'n' ? '\n' : text[i] == 'r' ? '\r' : text[i];
  }
  return result;
}

/// Corners of what is read or passed over; an error says what the others are.
std::int32_t corners_of_type(const MshScanner& scanner, std::int32_t type) {
  switch (type) {
    case 15:
      return 1;
    case 1:
      return 2;
    case 2:
      return 3;
    case 3:
    case 4:
      return 4;
    case 7:
      return 5;
    case 6:
      return 6;
    case 5:
      return 8;
    default:
      scanner.fail(fmt::format(
          "elements of type {} are not read: cells are tetrahedra, pyramids, prisms and hexahedra of first "
          "order (gmsh -order 1)",
          type));
  }
}

class Walker {
public:
  Walker(MshScanner& scanner, std::int64_t partition) : _scanner(scanner), _partition(partition) {}

  MshTables walk(MshExtent extent) {
    read_format();
    for (std::string name = _scanner.next_line(); !name.empty(); name = _scanner.next_line()) {
      if (name.front() != '$' || name.starts_with("$End"))
        _scanner.fail(fmt::format("'{}' where a section ($NAME) was expected", name.substr(0, 40)));
      if (name == "$Nodes" && extent == MshExtent::before_nodes) break;
      read_section(name.substr(1));
      const std::string end = _scanner.next_line();
      if (end != "$End" + name.substr(1))
        _scanner.fail(fmt::format("'{}' where $End{} was expected", end.substr(0, 40), name.substr(1)));
    }
    if (extent == MshExtent::all && !_has_elements)
      _scanner.fail("no section $Elements: the file is cut short or has no mesh");
    std::sort(_tables.ghosts.begin(), _tables.ghosts.end());
    return std::move(_tables);
  }

private:
  void read_format() {
    if (_scanner.next_line() != "$MeshFormat") _scanner.fail("no MSH file: it begins without $MeshFormat");
    std::istringstream line(_scanner.line());
    std::string version;
    int is_binary = 0, size = 0;
    if (!(line >> version >> is_binary >> size)) _scanner.fail("a line 'version type size' was expected");
    if (version != "4.1") {
      _scanner.fail(
          fmt::format("version {} of the format is not read; gmsh FILE -save -format msh41 -o NEW.msh "
                      "converts it to 4.1",
                      version.substr(0, 16)));
    }
    if (is_binary != 0) {
      if (size != 8) _scanner.fail(fmt::format("tags of {} bytes are not read, 8 were expected", size));
      _scanner.binary = true;
      if (_scanner.int32() != 1) _scanner.fail("a big-endian file is not read");
    }
    if (_scanner.next_line() != "$EndMeshFormat") _scanner.fail("$EndMeshFormat was expected");
  }

  void read_section(const std::string& name) {
    if (name == "PhysicalNames") return read_names();
    if (name == "Comments") return read_comments();
    if (name == "Entities") return read_entities();
    if (name == "PartitionedEntities") return read_partitioned();
    if (name == "Nodes") return read_nodes();
    if (name == "Elements") return read_elements();
    if (name == "GhostElements") return read_ghosts();
    skip_section("$End" + name);
  }

  /// Up to the line that ends a section of unknown content, binary perhaps.
  void skip_section(const std::string& end) {
    const std::int64_t begin = _scanner.position();
    while (_scanner.position() < _scanner.size()) {
      const std::int64_t here = _scanner.position();
      if (_scanner.line_is(end)) return _scanner.seek(here);
    }
    _scanner.seek(begin);
    _scanner.fail(fmt::format("no {} follows", end));
  }

  void read_names() {
    std::istringstream head(_scanner.next_line());
    std::int64_t count = -1;
    if (!(head >> count) || count < 0) _scanner.fail("a number of physical names was expected");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::string text = _scanner.next_line();
      std::istringstream line(text);
      std::int32_t dimension = 0, tag = 0;
      const std::size_t first = text.find('"'), last = text.rfind('"');
      if (!(line >> dimension >> tag) || first == std::string::npos || first == last)
        _scanner.fail(fmt::format("'{}' where a physical name was expected", text.substr(0, 40)));
      _tables.physical_names[{dimension, physical_group(tag)}] = text.substr(first + 1, last - first - 1);
    }
  }

  void read_comments() {
    while (true) {
      const std::int64_t here = _scanner.position();
      const std::string text = _scanner.line();
      if (text == "$EndComments") return _scanner.seek(here);
      if (_scanner.position() >= _scanner.size()) _scanner.fail("no $EndComments follows");
      std::istringstream line(text);
      std::string what, type, name;
      std::int32_t tag = 0;
      if (!(line >> what >> tag) || (what != "patch" && what != "region")) continue;
      if (what == "patch" && !(line >> type)) continue;
      line.get();
      std::getline(line, name);
      _tables.comments[{what == "patch" ? 2 : 3, tag}] = {type, unescaped_word(name)};
    }
  }

  void read_physical(MshEntity& entity) {
    const std::int64_t count = _scanner.count(4);
    for (std::int64_t i = 0; i < count; ++i) entity.physical.push_back(physical_group(_scanner.int32()));
  }

  /// Reads the record of an entity after its tag.
  MshEntity read_entity(std::int32_t dimension, bool partitioned) {
    MshEntity entity;
    entity.partitioned = partitioned;
    if (partitioned) {
      entity.parent_dimension = _scanner.int32();
      entity.parent = _scanner.int32();
      const std::int64_t parts = _scanner.count(4);
      for (std::int64_t i = 0; i < parts; ++i) {
        const std::int32_t part = _scanner.int32();
        if (dimension == 3) _tables.cell_partitions.insert(part);
      }
    }
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) _scanner.real();
    read_physical(entity);
    if (dimension > 0) {
      const std::int64_t bounding = _scanner.count(4);
      for (std::int64_t i = 0; i < bounding; ++i) _scanner.int32();
    }
    return entity;
  }

  void read_entities_of_all_dimensions(bool partitioned) {
    std::array<std::int64_t, 4> counts{};
    for (std::int64_t& count : counts) count = _scanner.count(4);
    for (std::int32_t dimension = 0; dimension < 4; ++dimension) {
      for (std::int64_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
        const std::int32_t tag = _scanner.int32();
        MshEntity entity = read_entity(dimension, partitioned);
        if (dimension >= 2) _tables.entities[{dimension, tag}] = std::move(entity);
      }
    }
  }

  void read_entities() { read_entities_of_all_dimensions(false); }

  void read_partitioned() {
    _tables.partitions = _scanner.int64();
    const std::int64_t ghosts = _scanner.count(8);
    for (std::int64_t i = 0; i < ghosts; ++i) {
      _tables.ghost_entities.insert(_scanner.int32());
      _scanner.int32();  // their partition
    }
    read_entities_of_all_dimensions(true);
  }

  void read_nodes() {
    const std::int64_t blocks = _scanner.count(20);
    _scanner.skip_values(3);
    for (std::int64_t b = 0; b < blocks; ++b) {
      MshNodeBlock block;
      const std::int32_t dimension = _scanner.int32();
      _scanner.int32();
      const bool parametric = _scanner.int32() != 0;
      if (dimension < 0 || dimension > 3) _scanner.fail(fmt::format("nodes of dimension {}", dimension));
      block.stride = 3 + (parametric ? dimension : 0);
      block.count = _scanner.count(32);
      block.tags = _scanner.position();
      _scanner.skip_values(block.count);
      block.points = _scanner.position();
      _scanner.skip_values(block.count * block.stride);
      if (block.count > 0) _tables.nodes.push_back(block);
    }
  }

  void read_elements() {
    _has_elements = true;
    const std::int64_t blocks = _scanner.count(20);
    _scanner.skip_values(3);
    for (std::int64_t b = 0; b < blocks; ++b) {
      MshElementBlock block;
      block.dimension = _scanner.int32();
      block.entity = _scanner.int32();
      block.type = _scanner.int32();
      block.corners = corners_of_type(_scanner, block.type);
      const std::int32_t dimension = block.type == 15 ? 0 : block.type == 1 ? 1 : block.type <= 3 ? 2 : 3;
      if (block.dimension != dimension) {
        _scanner.fail(
            fmt::format("elements of type {} in an entity of dimension {}", block.type, block.dimension));
      }
      block.count = _scanner.count(16);
      block.place = _scanner.position();
      _scanner.skip_values(block.count * (1 + block.corners));
      if (block.count > 0 && block.corners >= 3) _tables.elements.push_back(block);
    }
  }

  void read_ghosts() {
    const std::int64_t count = _scanner.count(20);
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t tag = _scanner.int64();
      const std::int32_t owner = _scanner.int32();
      const std::int64_t others = _scanner.count(4);
      for (std::int64_t k = 0; k < others; ++k) _scanner.int32();
      if (_partition > 0 && owner != _partition) _tables.ghosts.push_back(tag);
    }
  }

  MshScanner& _scanner;
  std::int64_t _partition;
  MshTables _tables;
  bool _has_elements = false;
};

}  // namespace

MshTables read_msh_tables(MshScanner& scanner, std::int64_t partition, MshExtent extent) {
  return Walker(scanner, partition).walk(extent);
}

}  // namespace aeroloom::io
