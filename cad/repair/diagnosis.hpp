/// Examines a geometry before meshing, for users who have to repair it.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/repair/change.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace aeroloom::cad {

/// Counts of entities as read, and of questionable ones.
struct EntityCounts {
  std::int32_t solids = 0, shells = 0, faces = 0, edges = 0;
  std::int32_t open_edges = 0;    ///< edges of one face only
  std::int32_t short_edges = 0;   ///< shorter than 1e-5 of the diagonal
  std::int32_t sliver_faces = 0;  ///< narrower than 1e-4 of the diagonal and than a hundredth of their length
};

struct Diagnosis {
  std::string format;     ///< "STEP", "IGES", "BREP" or "built-in"
  std::string unit_name;  ///< empty if none is declared
  Box bounds;             ///< of the shape as read
  EntityCounts counts;
  Changes findings;              ///< defects: entity, place, size (`how_much`); at most 20 of each kind
  std::optional<Domain> domain;  ///< absent if none can be made
  std::string failure;           ///< why there is no domain
};

/// Reads the geometry, examines it, and prepares the domain as a run would. Not collective. Throws CadError
/// only if the geometry cannot be read at all, and std::ios_base::failure if the file cannot be opened.
Diagnosis diagnose(const DomainOptions& options);

}  // namespace aeroloom::cad
