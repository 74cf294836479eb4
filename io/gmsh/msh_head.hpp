/// The sections of an MSH file before the nodes, and what names become there.
#pragma once

#include "geometry/vec.hpp"
#include "io/file_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// The boxes of the patches, then of the regions of the whole mesh. Collective.
std::vector<geometry::Box> boxes_of_entities(const FileMesh& mesh);

/// The entities that lie in part `part` (from 1), which part files have in addition.
struct MshPartition {
  std::int32_t part = 1;
  std::vector<std::int32_t> patches, regions;
};
/// The tag of the part's share of an entity; `entities`: how many of this dimension the mesh has.
inline std::int64_t partitioned_tag(std::int64_t entities, std::int64_t part, std::int64_t entity) {
  return part * entities + entity + 1;
}

/// $MeshFormat, $Comments, $PhysicalNames, $Entities, and $PartitionedEntities where there is a partition.
std::string msh_head(const FileMesh& mesh, const std::vector<geometry::Box>& boxes,
                     const MshPartition* partition);

}  // namespace aeroloom::io
