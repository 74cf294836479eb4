#include "pipeline/run.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/domain/face_patches.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/layer_stage.hpp"
#include "pipeline/report/pictures.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/stage_log.hpp"
#include "pipeline/stage_products.hpp"
#include "pipeline/volume_stages.hpp"
#include "pipeline/write_outputs.hpp"

#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::Communicator;

/// The stages of one run. What a stage has made is taken from the checkpoint of an earlier run where there is
/// one, else made and kept; later stages cannot tell which.
class CaseRun {
public:
  CaseRun(const Communicator& communicator, const cases::Case& input, report::RunRecord& record)
      : _communicator(communicator), _input(input), _record(record) {}

  void run() {
    const cad::Model domain = stage("geometry", report::ExitCode::cad, [&] { return load_geometry(); });
    domain::SizedDomain sized = stage("sizing", report::ExitCode::cad, [&] {
      domain::SizedDomain found = find_or_build_sizes(domain);
      domain::require_walls_apart(found);
      require_memory(_communicator, found, types_of(found.model.patches()), _input);
      return found;
    });
    FinishedSurface surface =
        stage("surface", report::ExitCode::surface, [&] { return find_or_build_surface(domain, sized); });
    const report::PictureSource pictured{surface.mesh, surface.numbering, _record.patch_types, _record.unit};
    mesh::DistributedMesh volume =
        report::with_pictures_of_failure(_communicator, pictured, _input.output, _record.pictures,
                                         [&] { return find_or_build_volume(sized.model, surface); });
    const mesh::Numbering numbering =
        stage("inspect", report::ExitCode::volume, [&] { return inspect(sized.model, volume, surface); });
    volume.patch_types = _record.patch_types;
    stage("output", report::ExitCode::files, [&] {
      write(volume, numbering, surface);
      if (_input.output.pictures)
        _record.pictures = report::pictures_or_warning(_communicator, &volume, pictured);
    });
    require_quality(_input, _record);
  }

private:
  template <class Work>
  std::invoke_result_t<Work> stage(const std::string& name, report::ExitCode code, Work work) {
    return run_stage(_record, name, code, work);
  }

  std::optional<io::CheckpointContent> find(SavedStage saved, const char* name) {
    std::optional<io::CheckpointContent> content = _checkpoints->find(saved);
    if (content) _record.resumed.emplace_back(name);
    return content;
  }

  // --- geometry

  cad::Model load_geometry() {
    _identity = identify_run(_communicator, _input);
    if (_identity.is_known) {
      _record.input_hash = _identity.digest.text();
      _record.input_bytes = _identity.bytes;
    }
    _checkpoints.emplace(_communicator, _input, _identity);
    if (!_input.domain.file.empty() && _identity.is_known) {
      const std::size_t parts = _input.domain.parts.size();
      parallel::log_info(fmt::format("geometry: '{}'{}, {} bytes, hash {}", _input.domain.file,
                                     parts > 0 ? fmt::format(" and {} parts", parts) : "", _identity.bytes,
                                     _record.input_hash));
    }
    cases::TypedPatches patches = domain::find_patches(_communicator, find_or_load_domain(), _input);
    for (std::size_t p = 0; p < patches.types.size(); ++p)
      _record.type_of_patch[patches.model.patches()[p]] = patches.types[p];
    if (_communicator.is_root())
      for (const std::string& warning : patches.warnings) parallel::log_warning(warning);
    describe(patches.model);
    return std::move(patches.model);
  }

  std::vector<mesh::PatchType> types_of(const std::vector<std::string>& patches) const {
    std::vector<mesh::PatchType> types;
    for (const std::string& patch : patches) types.push_back(_record.type_of_patch.at(patch));
    return types;
  }

  cad::Model find_or_load_domain() {
    if (std::optional<io::CheckpointContent> found = find(SavedStage::geometry, "geometry")) {
      std::optional<cad::Domain> domain;
      parallel::agree(_communicator, [&] {
        const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::repeated);
        domain = unpack_domain_product(std::move(*found));
      });
      if (_communicator.is_root()) _record.domain = std::move(domain->report);
      return std::move(domain->model);
    }
    cad::Model model = domain::load_domain(_communicator, _input.domain, _record.domain);
    require_same_file(_communicator, _identity, _input);
    _checkpoints->keep(SavedStage::geometry, [&] {
      return _communicator.is_root() ? pack_domain_product({model, _record.domain}) : io::CheckpointDraft();
    });
    return model;
  }

  void describe(const cad::Model& model) {
    _record.unit = model.unit_name();
    _record.unit_in_metres = model.unit_in_metres();
    _record.bounds = model.bounds();
    _record.regions = model.region_count();
    _record.faces = model.face_count();
    _record.edges = model.edge_count();
    log_geometry(model, _record);
  }

  // --- sizes, and the model they are for

  domain::SizedDomain find_or_build_sizes(const cad::Model& domain) {
    if (std::optional<io::CheckpointContent> found = find(SavedStage::sizing, "sizing")) {
      domain::SizedDomain sized = unpack_sizes(_communicator, std::move(*found), domain);
      note_sizes(sized);
      return sized;
    }
    domain::SizedDomain sized = build_sizes(domain, domain::Simplification::of(_input));
    _checkpoints->keep(SavedStage::sizing,
                       [&] { return _communicator.is_root() ? pack_sizes(sized) : io::CheckpointDraft(); });
    return sized;
  }

  domain::SizedDomain build_sizes(const cad::Model& domain, const domain::Simplification& simplification) {
    domain::SizedDomain sized = domain::size_domain(_communicator, domain, _input.sizing, simplification);
    note_sizes(sized);
    return sized;
  }

  void note_sizes(const domain::SizedDomain& sized) {
    _record.sizes = sized.sizes;
    _record.size_field_leaves = sized.field.leaf_count();
    _record.face_names.clear();
    for (cad::FaceId f = 0; f < sized.model.face_count(); ++f)
      _record.face_names.push_back(sized.model.face(f).name);
    _record.findings = sized.findings;
    log_sizing(_record);
    if (_communicator.is_root()) warn_of_sizes(_record);
  }

  // --- surface

  FinishedSurface find_or_build_surface(const cad::Model& domain, domain::SizedDomain& sized) {
    if (std::optional<io::CheckpointContent> found = find(SavedStage::surface, "surface")) {
      const cad::Changes joined_before = sized.findings.joined.changes;
      const bool closed_before = domain::has_closed(sized.findings.edges);
      if (std::optional<surface::SurfaceMesh> known =
              unpack_surface(_communicator, std::move(*found), domain, sized)) {
        if (sized.findings.joined.changes.size() != joined_before.size() ||
            domain::has_closed(sized.findings.edges) != closed_before)
          note_sizes(sized);
        parallel::add_pieces(static_cast<std::int64_t>(known->mesh.pieces.size()));
        return finish_surface(sized.model, std::move(*known));
      }
      _record.resumed.pop_back();
      parallel::log_info("checkpoint: that surface is of other sizes: done anew");
    }
    const std::size_t joined_before = sized.findings.joined.groups.size();
    const bool closed_before = domain::has_closed(sized.findings.edges);
    surface::SurfaceMesh made = build_surface_or_advise(domain, sized);
    const bool sizes_are_other = sized.findings.joined.groups.size() != joined_before ||
                                 domain::has_closed(sized.findings.edges) != closed_before;
    FinishedSurface finished = finish_surface(sized.model, std::move(made));
    _checkpoints->keep(SavedStage::surface, [&] {
      return pack_surface(_communicator,
                          {finished.mesh, finished.field, _record.surface, sized, sizes_are_other});
    });
    return finished;
  }

  /// Numbers it, checks it, tells of it.
  FinishedSurface finish_surface(const cad::Model& model, surface::SurfaceMesh surface) {
    _record.surface = std::move(surface.report);
    mesh::Numbering numbering = mesh::number_mesh(surface.mesh);
    FinishedSurface finished{{std::move(surface.mesh), std::move(numbering)}, std::move(surface.field)};
    inspect_surface(model, "the surface mesh", finished, _record);
    log_surface(_record);
    if (_communicator.is_root()) log_needles(_record);
    return finished;
  }

  surface::SurfaceMesh build_surface(const domain::SizedDomain& sized) {
    return surface::mesh_surface(_communicator, sized.model, sized.field, _input.surface,
                                 _checkpoints->tasks(SavedStage::surface));
  }

  /// The surface of the sized domain. Where joined faces or closed edges cannot be meshed, that of the model
  /// as it was, and `sized` becomes its.
  surface::SurfaceMesh build_surface(const cad::Model& domain, domain::SizedDomain& sized) {
    if (sized.findings.joined.groups.empty() && !domain::has_closed(sized.findings.edges))
      return build_surface(sized);
    try {
      return build_surface(sized);
    } catch (const parallel::CollectiveError& error) {
      if (error.kind() != parallel::FailureKind::input) throw;
      log_surface_again(error.what());
    } catch (const surface::SurfaceError& error) {
      log_surface_again(error.what());
    }
    sized = build_sizes(domain, {cases::NarrowFaces::keep, cad::TrailingEdges::keep});
    return build_surface(sized);
  }

  /// Meshes the surface; what fails near trailing edges that were closed may not fail where they stay.
  surface::SurfaceMesh build_surface_or_advise(const cad::Model& domain, domain::SizedDomain& sized) {
    const bool sharpened = _input.domain.trailing_edges.treatment == cad::TrailingEdges::sharpen;
    const auto advised = [&](const std::string& text) {
      return text +
             "; or leave the trailing edges there as they are (geometry.sharpen_faces, "
             "geometry.sharpen_width)";
    };
    try {
      return build_surface(domain, sized);
    } catch (const parallel::CollectiveError& error) {
      if (!sharpened) throw;
      throw parallel::CollectiveError(error.kind(), advised(error.what()));
    } catch (const surface::SurfaceError& error) {
      if (!sharpened) throw;
      throw surface::SurfaceError(advised(error.what()));
    }
  }

  // --- volume

  /// The volume within the surface; where the case asks for layers, behind their front, and they before it.
  mesh::DistributedMesh find_or_build_volume(const cad::Model& model, FinishedSurface& surface) {
    VolumeStages stages(_communicator, _input, _record, *_checkpoints);
    if (!_input.layers.given) return stages.find_or_build(model, {surface, surface.field});
    const LayeredSurface layered = stage("layers", report::ExitCode::surface,
                                         [&] { return build_layers(_input, model, surface, _record); });
    mesh::DistributedMesh volume = stages.find_or_build(model, {layered.front, layered.field});
    stage("layers", report::ExitCode::volume,
          [&] { append_layers(_input, surface, layered, volume, _record); });
    return volume;
  }

  // --- the finished mesh

  mesh::Numbering inspect(const cad::Model& model, const mesh::DistributedMesh& volume,
                          FinishedSurface& surface) {
    mesh::Numbering numbering = mesh::number_mesh(volume);
    if (_record.improve.changed_triangles > 0) adopt_boundary(model, volume, numbering, surface, _record);
    const bool is_of_surface = !_record.layers || !_record.layers->end_on_planes;
    inspect_volume(_input, volume, numbering, is_of_surface ? &surface.mesh : nullptr, _record);
    add_cad_volumes(model, _record.regions_filled);
    const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
    _record.conformity = attribution::measure_conformity(volume, surface.field);
    return numbering;
  }

  void write(const mesh::DistributedMesh& volume, const mesh::Numbering& numbering,
             const FinishedSurface& surface) {
    const bool is_of_surface = !_record.layers || !_record.layers->end_on_planes;
    const SurfaceView view{surface.mesh, surface.numbering, is_of_surface};
    {
      const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
      write_outputs(volume, numbering, &view, _input.output);
    }
    if (_input.output.formats.size() == 1 && wants_vtk(_input.output)) note_files();
    if (_communicator.is_root()) {
      warn_of_units(_record, _input.output);
      if (const std::string coarse = coarse_region(_input.gate, _record); !coarse.empty())
        parallel::log_warning("quality gate: " + coarse);
    }
  }

  /// Puts files on record as tasks that cost equally much, what all ranks have spent on them together.
  /// Collective.
  void note_files() {
    const double seconds = _communicator.sum(_record.clock.costs().back().task_cpu_seconds);
    const std::int64_t of_file = io::cells_per_vtk_file(_record.counts.cells);
    const std::int64_t files = (_record.counts.cells + of_file - 1) / of_file;
    for (std::int64_t i = 0; _communicator.is_root() && i < files; ++i)
      parallel::note_task({.kind = parallel::TaskKind::file,
                           .number = i,
                           .predicted = static_cast<double>(of_file),
                           .cpu_seconds = seconds / static_cast<double>(files)});
  }

  const Communicator& _communicator;
  const cases::Case& _input;
  report::RunRecord& _record;
  RunIdentity _identity;
  std::optional<Checkpoints> _checkpoints;  // from the first stage on
};

}  // namespace

void run_case(const Communicator& communicator, const cases::Case& input, report::RunRecord& record) {
  if (!input.layers.given) return CaseRun(communicator, input, record).run();
  cases::Case kept = input;
  kept.improve.boundary_may_change = false;  // layers stand before it
  CaseRun(communicator, kept, record).run();
}

}  // namespace aeroloom::pipeline
