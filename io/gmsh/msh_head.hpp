/// The sections of an MSH file before the nodes.
#pragma once

#include "geometry/vec.hpp"
#include "io/file_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::io {

/// The boxes of all patches, then of all regions, of the whole mesh. Collective.
std::vector<geometry::Box> boxes_of_entities(const FileMesh& mesh);

/// A part, and the entities that have elements in it. Only part files have this section.
struct MshPartition {
  std::int32_t part = 1;  ///< counted from 1
  std::vector<std::int32_t> patches, regions;
};
/// The tag of entity `entity` in part `part`. `entities`: the number of entities of this dimension.
inline std::int64_t partitioned_tag(std::int64_t entities, std::int64_t part, std::int64_t entity) {
  return part * entities + entity + 1;
}

/// The names of patches, or of regions, in $PhysicalNames, all different.
std::vector<std::string> physical_names(const std::vector<std::string>& names);

/// $MeshFormat, $Comments, $PhysicalNames and $Entities; $PartitionedEntities unless `partition` is null.
std::string msh_head(const FileMesh& mesh, const std::vector<geometry::Box>& boxes,
                     const MshPartition* partition);

}  // namespace aeroloom::io
