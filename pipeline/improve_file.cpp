#include "pipeline/improve_file.hpp"

#include "io/import/imported_mesh.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/report/pictures.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/write_outputs.hpp"

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Tetrahedra of boundary layers are flat on purpose: improvement takes them for bad ones. Collective.
void warn_of_layers(const mesh::DistributedMesh& volume) {
  constexpr double flat_deg = 1, fraction_of_layers = 0.1;  // chosen, not measured
  std::int64_t flat = 0, all = 0;
  for (const mesh::Piece& piece : volume.pieces) {
    all += piece.cell_count();
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const mesh::LocalIndex* v = piece.cell(c);
      const auto p = [&](int k) { return piece.point(v[k]); };
      flat += mesh::dihedral_range(p(0), p(1), p(2), p(3)).smallest < flat_deg ? 1 : 0;
    }
  }
  flat = volume.communicator.sum(flat), all = volume.communicator.sum(all);
  if (!volume.communicator.is_root() ||
      static_cast<double>(flat) <= fraction_of_layers * static_cast<double>(all))
    return;
  parallel::log_warning(fmt::format(
      "improve: {:.0f} % of the tetrahedra have an angle below {} degree, as those of boundary layers have: "
      "improvement takes time over each of them and destroys the layers. Remedy: improve the mesh in the run "
      "that makes it, which leaves layers as they are",
      100.0 * static_cast<double>(flat) / static_cast<double>(all), flat_deg));
}

}  // namespace

void improve_file(const parallel::Communicator& communicator, const std::string& file,
                  const cases::Case& input, report::RunRecord& record) {
  improve::ImproveOptions options = improve_options(input);
  options.boundary_may_change = false;
  mesh::DistributedMesh volume = run_stage(record.clock, "input", report::ExitCode::files, [&] {
    return imported::import_mesh({communicator, file}, input.volume.piece_tets);
  });
  record.face_names = volume.faces;
  warn_of_layers(volume);
  record.improve = run_stage(record.clock, "improve", report::ExitCode::volume,
                             [&] { return improve_volume(options, {}, volume); });
  report::VolumeFigures figures;
  std::vector<report::PatchRow> patches;
  const mesh::NumberedMesh finished = run_stage(record.clock, "inspect", report::ExitCode::volume, [&] {
    mesh::NumberedMesh numbered = mesh::number_mesh(std::move(volume));
    figures = inspect_volume(options, input.gate, numbered, nullptr);
    patches = table_of_patches(numbered);
    return numbered;
  });
  static_cast<report::VolumeFigures&>(record) = figures;
  record.patches = patches;
  run_stage(record.clock, "output", report::ExitCode::files, [&] {
    if (!wants_vtk(input.output) && !input.output.pictures)
      return write_outputs(finished, nullptr, input.output, {});
    const mesh::NumberedMesh surface = mesh::number_mesh(mesh::boundary_mesh(finished));
    write_outputs(finished, &surface, input.output, {});
    if (!input.output.pictures) return;
    record.pictures = report::pictures_or_warning({surface, finished.patch_types, ""}, &finished);
  });
  require_quality(input, {figures, patches});
}

}  // namespace aeroloom::pipeline
