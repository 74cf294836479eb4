#include "pipeline/run.hpp"

#include "io/vtk/vtk_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/domain/face_patches.hpp"
#include "pipeline/domain/length_ranges.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/layer_stage.hpp"
#include "pipeline/report/pictures.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/stage_log.hpp"
#include "pipeline/surface_stages.hpp"
#include "pipeline/volume_stages.hpp"
#include "pipeline/write_outputs.hpp"

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {
namespace {

/// The flow that layers are made for, as far as the case says it.
io::FlowReference flow_of(const cases::LayerRequest& layers, const cad::Model& model) {
  io::FlowReference flow{.unit = model.unit_name(), .unit_in_metres = model.unit_in_metres()};
  if (layers.reynolds && layers.length) flow.reynolds = *layers.reynolds, flow.length = *layers.length;
  return flow;
}

/// The finished volume.
struct InspectedVolume : mesh::NumberedMesh {
  report::VolumeFigures figures = {};
};

/// The stages of one run. A stage takes its result from the checkpoint of an earlier run where there is one;
/// else it makes and keeps the result. Later stages cannot tell which. The results are copied into the
/// record, which no stage reads.
class CaseRun {
public:
  CaseRun(parallel::Communicator communicator, const cases::Case& input, report::RunRecord& record)
      : _communicator(std::move(communicator)), _input(input), _record(record), _clock(record.clock) {}

  /// With files and pictures. Throws StageFailure if a gate is missed.
  void run() {
    make([&](const InspectedVolume& finished, const FinishedSurface& surface, const Finish& finish) {
      stage("output", report::ExitCode::files, [&] {
        write(finished, surface);
        if (_communicator.is_root()) warn(finish.judged);
        if (_input.output.pictures)
          _record.pictures = report::pictures_or_warning(finish.pictured, &finished);
      });
      require_quality(_input, finish.judged);
    });
  }

  /// Without files.
  MeshOfCase run_in_memory() {
    MeshOfCase result;
    make([&](InspectedVolume& finished, const FinishedSurface&, const Finish& finish) {
      if (_communicator.is_root()) warn(finish.judged);
      result.hash = finished.figures.hash;
      result.missed = cases::with_keys(missed_quality(_input, finish.judged));
      result.unit = finish.judged.unit;
      result.unit_in_metres = finish.metres;
      result.mesh = std::move(static_cast<mesh::NumberedMesh&>(finished));
    });
    return result;
  }

private:
  /// What the end of a run needs besides the meshes.
  struct Finish {
    const report::PictureSource& pictured;
    JudgedMesh judged;
    double metres;  ///< the unit of the model
  };

  /// Makes the mesh; `end` gets the inspected volume, the surface and what it needs besides.
  template <class End>
  void make(const End& end) {
    using report::ExitCode;
    const cases::TypedPatches domain = stage("geometry", ExitCode::cad, [&] { return load_geometry(); });
    SurfaceStages first(_communicator, _input, *_checkpoints, _record);
    domain::SizedDomain sized = stage("sizing", ExitCode::cad, [&] { return first.size(domain); });
    FinishedSurface surface =
        stage("surface", ExitCode::surface, [&] { return first.mesh(domain, std::move(sized)); });
    report::PictureSource pictured{surface, surface.types, domain.model.unit_name()};
    std::optional<report::LayerRecord> layers;
    VolumeProduct volume = report::with_pictures_of_failure(pictured, _input.output, _record.pictures, [&] {
      VolumeStages stages(_input, *_checkpoints);
      std::optional<LayersAndCap> layered;
      if (_input.layers.given) {
        layered = stage("layers", ExitCode::surface, [&] { return build_layers(_input, surface); });
        _record.layers = layers = layered->record;
        if (_input.output.pictures) pictured.layers = layers_over_triangles(surface, *layered);
      }
      const sizing::SizedSurface& boundary = layered ? layered->cap : surface;
      VolumeStart start =
          stage("decompose", ExitCode::volume, [&] { return decompose(stages, boundary, surface); });
      VolumeProduct filled =
          stage("volume", ExitCode::volume, [&] { return stages.fill(boundary, start, _record.volume); });
      note_volume(filled);
      VolumeProduct improved = stage("improve", ExitCode::volume, [&] {
        return stages.improve(surface.model, boundary, start, std::move(filled));
      });
      note_volume(improved);
      if (layered)
        stage("layers", ExitCode::volume, [&] { append_layers(_input, surface, *layered, improved.mesh); });
      return improved;
    });
    InspectedVolume finished =
        stage("inspect", ExitCode::volume, [&] { return inspect(std::move(volume), surface); });
    end(finished, surface,
        {pictured,
         {finished.figures, surface.figures.patches, layers ? &*layers : nullptr, surface.sizes,
          domain.model.unit_name()},
         domain.model.unit_in_metres()});
  }

  template <class Work>
  std::invoke_result_t<Work> stage(const std::string& name, report::ExitCode code, Work work) {
    return run_stage(_clock, name, code, work);
  }

  // --- geometry

  cases::TypedPatches load_geometry() {
    _identity = identify_run(_communicator, _input);
    if (_identity.is_known) {
      _record.input_hash = _identity.digest.text();
      _record.input_bytes = _identity.bytes;
    }
    _checkpoints.emplace(_communicator, _input, _identity);
    if (const std::string text = text_of_files(_identity, _input); !text.empty())
      parallel::log_info("geometry: " + text);
    const cad::Domain domain = find_or_load_domain();
    domain::require_lengths_of_model(_communicator, domain.model, _input);
    cases::TypedPatches patches = domain::find_patches(_communicator, domain, _input);
    if (_communicator.is_root()) warn_of_case(patches, _input);
    note_model(patches.model);
    log_geometry(patches.model, domain.report);
    return patches;
  }

  /// With the report on rank 0 alone.
  cad::Domain find_or_load_domain() {
    if (std::optional<io::CheckpointContent> found = _checkpoints->find(SavedStage::geometry)) {
      _record.resumed.emplace_back("geometry");
      std::optional<cad::Domain> domain;
      parallel::collectively(_communicator, parallel::ScopedCpu::As::repeated,
                             [&] { domain = domain::unpack_domain(found->common); });
      if (!_communicator.is_root()) domain->report = {};
      _record.domain = domain->report;
      return std::move(*domain);
    }
    cad::Domain domain = domain::load_domain(_communicator, _input.domain);
    _record.domain = domain.report;
    parallel::on_root(_communicator, [&] { require_same_file(_identity, _input); });
    _checkpoints->keep(SavedStage::geometry, [&] {
      return _communicator.is_root() ? io::CheckpointDraft{domain::pack_domain(domain), {}}
                                     : io::CheckpointDraft();
    });
    return domain;
  }

  void note_model(const cad::Model& model) {
    _record.unit = model.unit_name();
    _record.unit_in_metres = model.unit_in_metres();
    _record.bounds = model.bounds();
    _record.regions = model.region_count();
    _record.faces = model.face_count();
    _record.edges = model.edge_count();
  }

  // --- volume

  VolumeStart decompose(VolumeStages& stages, const sizing::SizedSurface& boundary,
                        const FinishedSurface& surface) {
    VolumeStart start = stages.decompose(boundary);
    if (start.zones) {
      _record.decomposition = start.zones->report();
      if (_communicator.is_root())
        warn_of_count(_record.decomposition.expected_tetrahedra, surface.forecast_tetrahedra,
                      surface.report.mending_rounds);
    } else {
      _record.resumed.emplace_back("volume");
      if (start.improved) _record.resumed.emplace_back("improve");
    }
    return start;
  }

  void note_volume(const VolumeProduct& product) {
    _record.decomposition = product.decomposition;
    _record.volume = product.volume;
    _record.improve = product.improve;
  }

  // --- the finished mesh

  InspectedVolume inspect(VolumeProduct volume, FinishedSurface& surface) {
    InspectedVolume finished{mesh::number_mesh(std::move(volume.mesh))};
    if (volume.improve.changed_triangles > 0) adopt_boundary(finished, surface);
    static_cast<report::SurfaceFigures&>(_record) = surface.figures;
    finished.figures = inspect_volume(improve_options(_input), _input.gate, finished,
                                      surface.bounds_volume ? &surface : nullptr);
    add_cad_volumes(surface.model, finished.figures.regions_filled);
    static_cast<report::VolumeFigures&>(_record) = finished.figures;
    const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
    _record.conformity = attribution::measure_conformity(finished, surface.field);
    finished.patch_types = surface.types;
    return finished;
  }

  void write(const InspectedVolume& volume, const FinishedSurface& surface) {
    {
      const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
      write_outputs(volume, surface.bounds_volume ? &surface : nullptr, _input.output,
                    flow_of(_input.layers, surface.model));
    }
    if (_input.output.formats.size() == 1 && wants_vtk(_input.output))
      note_files(volume.figures.counts.cells);
  }

  void warn(const JudgedMesh& judged) const {
    warn_of_flaws(judged.volume);
    if (const std::string coarse = coarse_region(_input.gate, judged); !coarse.empty())
      parallel::log_warning("quality gate: " + coarse);
  }

  /// Notes the files as tasks of equal cost, together what all ranks have spent on them. Collective.
  void note_files(mesh::GlobalIndex cells) {
    const double seconds = _communicator.sum(_clock.costs().back().task_cpu_seconds);
    const std::int64_t of_file = io::cells_per_vtk_file(cells);
    const std::int64_t files = (cells + of_file - 1) / of_file;
    for (std::int64_t i = 0; _communicator.is_root() && i < files; ++i)
      parallel::note_task({.kind = parallel::TaskKind::file,
                           .number = i,
                           .predicted = static_cast<double>(of_file),
                           .cpu_seconds = seconds / static_cast<double>(files)});
  }

  parallel::Communicator _communicator;
  const cases::Case& _input;
  report::RunRecord& _record;
  parallel::StageClock& _clock;  // of the record
  RunIdentity _identity;
  std::optional<Checkpoints> _checkpoints;  // from the first stage on
};

}  // namespace

void run_case(const parallel::Communicator& communicator, const cases::Case& input,
              report::RunRecord& record) {
  CaseRun(communicator, input, record).run();
}

MeshOfCase mesh_of_case(const parallel::Communicator& communicator, const cases::Case& input,
                        report::RunRecord& record) {
  return CaseRun(communicator, input, record).run_in_memory();
}

}  // namespace aeroloom::pipeline
