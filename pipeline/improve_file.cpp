#include "pipeline/improve_file.hpp"

#include "imported/imported_mesh.hpp"
#include "mesh/boundary_mesh.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/write_outputs.hpp"
#include "report/pictures.hpp"

namespace aeroloom::pipeline {

void improve_file(const parallel::Communicator& communicator, const std::string& file,
                  const cases::Case& input, report::RunRecord& record) {
  cases::Case fixed = input;
  fixed.improve.boundary_may_change = false;
  mesh::DistributedMesh volume = run_stage(record, "input", report::ExitCode::files, [&] {
    return imported::import_mesh(communicator, file, input.volume.piece_tets);
  });
  record.face_names = volume.faces;
  run_stage(record, "improve", report::ExitCode::volume,
            [&] { improve_volume(communicator, fixed, {}, volume, record); });
  const mesh::Numbering numbering = run_stage(record, "inspect", report::ExitCode::volume, [&] {
    mesh::Numbering finished = mesh::number_mesh(communicator, volume);
    inspect_volume(communicator, fixed, volume, finished, nullptr, record);
    record.patches = table_of_patches(communicator, volume);
    return finished;
  });
  run_stage(record, "output", report::ExitCode::files, [&] {
    if (!wants_vtk(input.output) && !input.output.pictures)
      return write_outputs(communicator, volume, numbering, nullptr, input.output);
    const mesh::DistributedMesh surface = mesh::boundary_mesh(communicator, volume, numbering);
    const mesh::Numbering surface_numbers = mesh::number_mesh(communicator, surface);
    const SurfaceView view{surface, surface_numbers};
    write_outputs(communicator, volume, numbering, &view, input.output);
    if (!input.output.pictures) return;
    record.pictures = report::pictures_or_warning(communicator, &volume,
                                                  {surface, surface_numbers, volume.patch_types, ""});
  });
  require_quality(input, record);
}

}  // namespace aeroloom::pipeline
