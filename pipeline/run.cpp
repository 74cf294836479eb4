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

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::Communicator;

/// Whether the model of the sizes is simpler than that of the domain.
bool is_simplified(const domain::SizedDomain& sized) {
  return !sized.findings.joined.groups.empty() || domain::has_closed(sized.findings.edges);
}

/// The types of patches of a model that has some of those of the domain: a patch whose faces were all closed
/// is gone, and those after it have other numbers.
std::vector<mesh::PatchType> types_of(const std::vector<std::string>& patches,
                                      const cases::TypedPatches& domain) {
  const std::vector<std::string>& names = domain.model.patches();
  std::vector<mesh::PatchType> types;
  for (const std::string& patch : patches) {
    const auto found = std::find(names.begin(), names.end(), patch);
    types.push_back(domain.types.at(static_cast<std::size_t>(found - names.begin())));
  }
  return types;
}

/// The finished volume.
struct InspectedVolume : mesh::NumberedMesh {
  mesh::MeshCounts counts = {};
};

/// The stages of one run. What a stage has made is taken from the checkpoint of an earlier run where there is
/// one, else made and kept; later stages cannot tell which. The record is written, never read, but for the
/// quality gate, which judges it.
class CaseRun {
public:
  CaseRun(const Communicator& communicator, const cases::Case& input, report::RunRecord& record)
      : _communicator(communicator), _input(input), _record(record) {}

  void run() {
    using report::ExitCode;
    const cases::TypedPatches domain = stage("geometry", ExitCode::cad, [&] { return load_geometry(); });
    domain::SizedDomain sized = stage("sizing", ExitCode::cad, [&] { return size(domain); });
    FinishedSurface surface =
        stage("surface", ExitCode::surface, [&] { return find_or_build_surface(domain, std::move(sized)); });
    const report::PictureSource pictured{surface, surface.patch_types, domain.model.unit_name()};
    VolumeProduct volume =
        report::with_pictures_of_failure(_communicator, pictured, _input.output, _record.pictures, [&] {
          VolumeStages stages(_communicator, _input, _record, *_checkpoints);
          std::optional<LayeredSurface> layered;
          if (_input.layers.given)
            layered =
                stage("layers", ExitCode::surface, [&] { return build_layers(_input, surface, _record); });
          const sizing::SizedSurface& boundary = layered ? layered->front : surface;
          VolumeStart start =
              stage("decompose", ExitCode::volume, [&] { return stages.decompose(boundary); });
          VolumeProduct filled =
              stage("volume", ExitCode::volume, [&] { return stages.fill(boundary, start); });
          VolumeProduct improved = stage("improve", ExitCode::volume, [&] {
            return stages.improve(surface.model, boundary, start, std::move(filled));
          });
          if (layered)
            stage("layers", ExitCode::volume,
                  [&] { append_layers(_input, surface, *layered, improved.mesh); });
          return improved;
        });
    const InspectedVolume finished =
        stage("inspect", ExitCode::volume, [&] { return inspect(std::move(volume), surface); });
    stage("output", ExitCode::files, [&] { write(finished, surface, pictured); });
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

  cases::TypedPatches load_geometry() {
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
    if (_communicator.is_root())
      for (const std::string& warning : patches.warnings) parallel::log_warning(warning);
    describe(patches.model);
    return patches;
  }

  cad::Model find_or_load_domain() {
    if (std::optional<io::CheckpointContent> found = find(SavedStage::geometry, "geometry")) {
      std::optional<cad::Domain> domain;
      parallel::collectively(_communicator, parallel::ScopedCpu::As::repeated,
                             [&] { domain = unpack_domain_product(std::move(*found)); });
      if (_communicator.is_root()) _record.domain = std::move(domain->report);
      return std::move(domain->model);
    }
    cad::DomainReport found;
    cad::Model model = domain::load_domain(_communicator, _input.domain, found);
    _record.domain = found;
    require_same_file(_communicator, _identity, _input);
    _checkpoints->keep(SavedStage::geometry, [&] {
      return _communicator.is_root() ? pack_domain_product({model, found}) : io::CheckpointDraft();
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

  domain::SizedDomain size(const cases::TypedPatches& domain) {
    domain::SizedDomain sized = find_or_build_sizes(domain.model);
    domain::require_walls_apart(sized);
    require_memory(_communicator, sized, types_of(sized.model.patches(), domain), _input);
    return sized;
  }

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

  /// `sized` may become that of the model as it was, with the surface.
  FinishedSurface find_or_build_surface(const cases::TypedPatches& domain, domain::SizedDomain sized) {
    const bool simplified = is_simplified(sized);
    if (std::optional<surface::SurfaceMesh> known = find_surface(domain.model, sized)) {
      if (is_simplified(sized) != simplified) note_sizes(sized);
      parallel::add_pieces(static_cast<std::int64_t>(known->pieces.size()));
      return finish_surface(domain, sized.model, std::move(*known));
    }
    surface::SurfaceMesh made = build_surface_or_advise(domain.model, sized);
    FinishedSurface finished = finish_surface(domain, sized.model, std::move(made));
    _checkpoints->keep(SavedStage::surface, [&] {
      return pack_surface(_communicator, {finished, sized, is_simplified(sized) != simplified});
    });
    return finished;
  }

  std::optional<surface::SurfaceMesh> find_surface(const cad::Model& domain, domain::SizedDomain& sized) {
    std::optional<io::CheckpointContent> found = _checkpoints->find(SavedStage::surface);
    if (!found) return std::nullopt;
    std::optional<surface::SurfaceMesh> known =
        unpack_surface(_communicator, std::move(*found), domain, sized);
    if (known)
      _record.resumed.emplace_back("surface");
    else
      parallel::log_info("checkpoint: that surface is of other sizes: done anew");
    return known;
  }

  /// Numbers it, checks it, tells of it.
  FinishedSurface finish_surface(const cases::TypedPatches& domain, const cad::Model& model,
                                 surface::SurfaceMesh surface) {
    _record.surface = surface.report;
    FinishedSurface finished{std::move(surface), model, types_of(model.patches(), domain)};
    inspect_surface("the surface mesh", finished, _record);
    log_surface(_record);
    if (_communicator.is_root()) log_needles(_record);
    return finished;
  }

  surface::SurfaceMesh build_surface(const domain::SizedDomain& sized) {
    return surface::mesh_surface(sized.model, sized.field, _input.surface,
                                 _checkpoints->tasks(SavedStage::surface));
  }

  /// The surface of the sized domain. Where joined faces or closed edges cannot be meshed, that of the model
  /// as it was, and `sized` becomes its.
  surface::SurfaceMesh build_surface(const cad::Model& domain, domain::SizedDomain& sized) {
    if (!is_simplified(sized)) return build_surface(sized);
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

  // --- the finished mesh

  InspectedVolume inspect(VolumeProduct volume, FinishedSurface& surface) {
    InspectedVolume finished{mesh::number_mesh(std::move(volume.mesh))};
    if (volume.improve.changed_triangles > 0) adopt_boundary(finished, surface, _record);
    finished.counts = inspect_volume(_input, finished, surface.bounds_volume ? &surface : nullptr, _record);
    add_cad_volumes(surface.model, _record.regions_filled);
    const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
    _record.conformity = attribution::measure_conformity(finished, surface.field);
    finished.patch_types = surface.patch_types;
    return finished;
  }

  void write(const InspectedVolume& volume, const FinishedSurface& surface,
             const report::PictureSource& pictured) {
    {
      const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
      write_outputs(volume, surface.bounds_volume ? &surface : nullptr, _input.output);
    }
    if (_input.output.formats.size() == 1 && wants_vtk(_input.output)) note_files(volume.counts.cells);
    if (_communicator.is_root()) {
      warn_of_units(_record, _input.output);
      if (const std::string coarse = coarse_region(_input.gate, _record); !coarse.empty())
        parallel::log_warning("quality gate: " + coarse);
    }
    if (_input.output.pictures)
      _record.pictures = report::pictures_or_warning(_communicator, &volume, pictured);
  }

  /// Puts files on record as tasks that cost equally much, what all ranks have spent on them together.
  /// Collective.
  void note_files(mesh::GlobalIndex cells) {
    const double seconds = _communicator.sum(_record.clock.costs().back().task_cpu_seconds);
    const std::int64_t of_file = io::cells_per_vtk_file(cells);
    const std::int64_t files = (cells + of_file - 1) / of_file;
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
