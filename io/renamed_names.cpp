#include "io/renamed_names.hpp"

#include "io/boundary_patches.hpp"
#include "io/cgns/cgns_layout.hpp"
#include "io/gmsh/msh_head.hpp"
#include "io/openfoam/foam_case.hpp"
#include "io/su2/su2_markers.hpp"
#include "io/ugrid/ugrid_writer.hpp"

#include <cstddef>
#include <utility>

namespace aeroloom::io {

namespace {

void add_renamed(std::vector<RenamedName>& renamed, const std::string& name, const std::string& in_file) {
  if (name != in_file) renamed.push_back({name, in_file});
}

/// Of patches on the boundary, `names` in their order.
std::vector<RenamedName> renamed_of(const FileMesh& mesh, const BoundaryPatches& patches,
                                    const std::vector<std::string>& names) {
  std::vector<RenamedName> renamed;
  for (std::size_t i = 0; i < patches.size(); ++i)
    add_renamed(renamed, mesh.patches[patches.ids[i]].name, names[i]);
  return renamed;
}

}  // namespace

std::vector<RenamedName> renamed_in_cgns(const FileMesh& mesh) {
  const cgns::Plan plan =
      cgns::plan_file({mesh.vertex_count, mesh.patches, mesh.regions, mesh.region_cells, mesh.patch_faces});
  std::vector<RenamedName> renamed;
  for (const cgns::Boundary& each : plan.boundaries)
    if (!each.full_name.empty()) renamed.push_back({each.full_name, each.name});
  for (const cgns::Section& each : plan.sections)
    if (!each.full_name.empty()) renamed.push_back({each.full_name, each.name});
  return renamed;
}

std::vector<RenamedName> renamed_in_ugrid(const FileMesh& mesh) {
  const BoundaryPatches patches = boundary_patches(mesh);
  return renamed_of(mesh, patches, names_in_mapbc(mesh, patches));
}

std::vector<RenamedName> renamed_in_su2(const FileMesh& mesh) {
  const BoundaryPatches patches = boundary_patches(mesh);
  return renamed_of(mesh, patches, marker_names(mesh, patches));
}

std::vector<RenamedName> renamed_in_msh(const FileMesh& mesh) {
  std::vector<std::string> names;
  for (const mesh::Patch& patch : mesh.patches) names.push_back(patch.name);
  std::vector<RenamedName> renamed;
  for (const std::vector<std::string>& all : {names, mesh.regions}) {
    const std::vector<std::string> held = physical_names(all);
    for (std::size_t i = 0; i < all.size(); ++i) add_renamed(renamed, all[i], held[i]);
  }
  return renamed;
}

std::vector<RenamedName> renamed_in_openfoam(const FileMesh& mesh) {
  const std::vector<std::string> names = foam_patches(mesh.patches).names;
  std::vector<RenamedName> renamed;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) add_renamed(renamed, mesh.patches[p].name, names[p]);
  return renamed;
}

}  // namespace aeroloom::io
