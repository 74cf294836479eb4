#include "io/cgns/cgns_writer.hpp"

#include "io/cgns/cgns_layout.hpp"
#include "io/streams/range_writer.hpp"
#include "parallel/communication/collective_error.hpp"

namespace aeroloom::io {

using parallel::SharedFile;

namespace {

void write_coordinates(SharedFile& file, const cgns::Plan& plan, const MeshPart& part) {
  const std::int64_t before = part.first_owned * static_cast<std::int64_t>(sizeof(double));
  RangeWriter x(file, plan.coordinates[0] + before), y(file, plan.coordinates[1] + before),
      z(file, plan.coordinates[2] + before);
  for (mesh::LocalIndex v = 0; v < part.vertex_count(); ++v) {
    if (part.owned[static_cast<std::size_t>(v)] == 0) continue;
    const geometry::Vec3 p = part.point(v);
    x.put(p.x);
    y.put(p.y);
    z.put(p.z);
  }
  x.flush();
  y.flush();
  z.flush();
}

/// The elements of a run, by the numbers of their vertices from 1.
template <class Index>
void write_elements(SharedFile& file, const cgns::Section& section, const MeshPart& part, const Block& block,
                    const Run& run) {
  RangeWriter writer(file,
                     section.offset + run.before * block.corners * static_cast<std::int64_t>(sizeof(Index)));
  for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
    for (int k = 0; k < block.corners; ++k)
      writer.put(static_cast<Index>(part.numbers[static_cast<std::size_t>(block.item(i)[k])] + 1));
  }
  writer.flush();
}

void write_block(SharedFile& file, const cgns::Plan& plan, const MeshPart& part, const Block& block,
                 std::size_t shape, const auto& section_of) {
  for (const Run& run : block.runs) {
    const std::int32_t place = section_of[static_cast<std::size_t>(run.id)][shape];
    if (place < 0) continue;
    const cgns::Section& section = plan.sections[static_cast<std::size_t>(place)];
    if (plan.index_type == hdf5::ItemType::int32) {
      write_elements<std::int32_t>(file, section, part, block, run);
    } else {
      write_elements<std::int64_t>(file, section, part, block, run);
    }
  }
}

}  // namespace

void write_cgns(const FileMesh& mesh, const std::string& path) {
  cgns::Plan plan;
  std::vector<hdf5::Extent> structure;
  parallel::agree(mesh.communicator(), [&] {
    plan =
        cgns::plan_file({mesh.vertex_count, mesh.patches, mesh.regions, mesh.region_cells, mesh.patch_faces});
    structure = cgns::lay_out(plan);
  });
  hdf5::write_laid_out({mesh.communicator(), path}, structure, [&](SharedFile& file) {
    for (const MeshPart& part : mesh.parts) {
      write_coordinates(file, plan, part);
      for (std::size_t s = 0; s < part.cells.size(); ++s)
        write_block(file, plan, part, part.cells[s], s, plan.section_of_region);
      for (std::size_t s = 0; s < part.faces.size(); ++s)
        write_block(file, plan, part, part.faces[s], s, plan.section_of_patch);
    }
  });
}

}  // namespace aeroloom::io
