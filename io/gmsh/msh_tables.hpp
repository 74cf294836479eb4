/// The tables of an MSH file: groups, entities, and the places of its blocks of nodes and elements.
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
  std::int64_t count = 0, tags = 0, points = 0;  ///< `tags`, `points`: offsets in the file
  std::int64_t stride = 3;                       ///< values of a point: coordinates, and parameters if any
};

struct MshElementBlock {
  std::int32_t dimension = 0, entity = 0, type = 0, corners = 0;
  std::int64_t count = 0, place = 0;  ///< `place`: offset in the file
};

struct MshEntity {
  std::vector<std::int32_t> physical;             ///< tags of its physical groups, without sign
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
  std::set<std::int32_t> cell_partitions;  ///< the partitions of the volumes in this file
  std::set<std::int32_t> ghost_entities;   ///< entities whose elements belong to other partitions
  std::vector<MshNodeBlock> nodes;
  std::vector<MshElementBlock> elements;  ///< of dimension two and three
  std::vector<std::int64_t> ghosts;       ///< ascending tags of elements that another partition's file owns
};

enum class MshExtent { all, before_nodes };

/// Reads the tables, and leaves the scanner in the encoding of the file. `partition`: the partition of this
/// file, from 1; 0: the file has the whole mesh. Throws std::runtime_error with the place and the reason.
MshTables read_msh_tables(MshScanner& scanner, std::int64_t partition, MshExtent extent);

}  // namespace aeroloom::io
