/// Tables of an MSH file: groups, entities, and where its blocks of nodes and elements stand.
#pragma once

#include "io/file_mesh.hpp"
#include "io/gmsh/msh_scanner.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace aeroloom::io {

struct MshNodeBlock {
  std::int64_t count = 0, tags = 0, points = 0;  ///< places in the file
  std::int64_t stride = 3;                       ///< values per point: three, and parameters
};

struct MshElementBlock {
  std::int32_t dimension = 0, entity = 0, type = 0, corners = 0;
  std::int64_t count = 0, place = 0;
};

struct MshEntity {
  std::vector<std::int32_t> physical;             ///< as listed, without sign
  std::int32_t parent_dimension = 0, parent = 0;  ///< of a partitioned entity
  bool partitioned = false;
};

struct MshComment {
  std::string type, name;
};

using MshTag = std::pair<std::int32_t, std::int32_t>;  ///< dimension and tag

struct MshTables {
  std::map<MshTag, std::string> physical_names;
  std::map<MshTag, MshComment> comments;  ///< by physical group
  std::map<MshTag, MshEntity> entities;
  std::int64_t partitions = 0;
  std::set<std::int32_t> cell_partitions;  ///< which of them the volumes of this file lie in
  std::set<std::int32_t> ghost_entities;   ///< whose elements belong to other partitions
  std::vector<MshNodeBlock> nodes;
  std::vector<MshElementBlock> elements;  ///< of two and three dimensions
  std::vector<std::int64_t> ghosts;  ///< tags of elements that belong to another partition's file, ascending
};

enum class MshExtent { all, before_nodes };

/// Walks through the file and leaves the scanner in its mode. `partition`: which one this file is for, from
/// 1; 0: all of the mesh. Throws std::runtime_error with the place and what is wrong.
MshTables read_msh_tables(MshScanner& scanner, std::int64_t partition, MshExtent extent);

}  // namespace aeroloom::io
