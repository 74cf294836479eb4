#include "pipeline/surface_stages.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/domain/face_patches.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/stage_log.hpp"
#include "pipeline/stage_products.hpp"
#include "volume/volume_mesher.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Whether the model of the sizes is simpler than that of the domain.
bool is_simplified(const domain::SizedDomain& sized) {
  return !sized.findings.joined.groups.empty() || domain::has_closed(sized.findings.edges);
}

/// Sizes that may be chosen once more are warned of when they are final, or where the work with them fails.
template <class Work>
void with_warnings(const domain::SizedDomain& sized, const Work& work) {
  try {
    work();
  } catch (...) {
    if (sized.field.communicator().is_root()) warn_of_sizes(sized);
    throw;
  }
}

/// The tetrahedra that are to be made inside a surface. Nothing where layers change it first, or where what
/// is wrong with it is told later.
std::optional<double> tetrahedra_inside(const surface::SurfaceMesh& surface, const cases::Case& input) {
  if (input.layers.given) return std::nullopt;
  try {
    return volume::decompose({surface, input.volume}).report().expected_tetrahedra;
  } catch (const parallel::CollectiveError&) {
    return std::nullopt;
  }
}

}  // namespace

domain::SizedDomain SurfaceStages::size(const cases::TypedPatches& domain) {
  domain::SizedDomain sized = find_or_build_sizes(domain.model);
  if (_communicator.is_root())
    for (const std::string& warning : domain::warnings_of_lost_patches(domain, sized.model, _input))
      parallel::log_warning(warning);
  with_warnings(sized, [&] {
    domain::require_walls_apart(sized);
    require_memory(sized, types_of(sized.model.patches(), domain), _input);
  });
  return sized;
}

domain::SizedDomain SurfaceStages::find_or_build_sizes(const cad::Model& domain) {
  if (std::optional<io::CheckpointContent> found = _checkpoints.find(SavedStage::sizing)) {
    _record.resumed.emplace_back("sizing");
    domain::SizedDomain sized = unpack_sizes(_communicator, std::move(*found), domain);
    note_sizes(sized);
    return sized;
  }
  domain::SizedDomain sized = build_sizes(domain, domain::Simplification::of(_input));
  _checkpoints.keep(SavedStage::sizing,
                    [&] { return _communicator.is_root() ? pack_sizes(sized) : io::CheckpointDraft(); });
  return sized;
}

domain::SizedDomain SurfaceStages::build_sizes(const cad::Model& domain,
                                               const domain::Simplification& simplification) {
  domain::SizedDomain sized = domain::size_domain(_communicator, domain, _input.sizing, simplification);
  note_sizes(sized);
  return sized;
}

void SurfaceStages::note_sizes(const domain::SizedDomain& sized) {
  _record.sizes = sized.sizes;
  _record.size_field_leaves = sized.field.leaf_count();
  _record.face_names.clear();
  for (cad::FaceId f = 0; f < sized.model.face_count(); ++f)
    _record.face_names.push_back(sized.model.face(f).name);
  _record.findings = sized.findings;
  log_sizing(sized);
}

/// `sized` may become that of the model as it was, with the surface.
FinishedSurface SurfaceStages::mesh(const cases::TypedPatches& domain, domain::SizedDomain sized) {
  const bool simplified = is_simplified(sized);
  const sizing::SizingOptions sizes = sized.sizes;
  if (std::optional<surface::SurfaceMesh> known = find_surface(domain.model, sized)) {
    if (is_simplified(sized) != simplified || !(sized.sizes == sizes)) note_sizes(sized);
    if (_communicator.is_root()) warn_of_sizes(sized);
    parallel::add_pieces(static_cast<std::int64_t>(known->pieces.size()));
    return finish_surface(domain, sized, std::move(*known));
  }
  std::optional<surface::SurfaceMesh> made;
  bool chosen_again = false;
  with_warnings(sized, [&] {
    made = build_surface_or_advise(domain.model, sized);
    chosen_again = choose_again(sized, *made);
  });
  if (_communicator.is_root()) warn_of_sizes(sized);
  FinishedSurface finished = finish_surface(domain, sized, std::move(*made));
  _checkpoints.keep(SavedStage::surface, [&] {
    return pack_surface({finished, sized, chosen_again || is_simplified(sized) != simplified});
  });
  return finished;
}

/// The surface of the sized domain; nothing where it cannot be meshed. `tell` gets the reason.
std::optional<surface::SurfaceMesh> SurfaceStages::attempt_surface(
    const domain::SizedDomain& sized, const std::function<void(const std::string&)>& tell) {
  try {
    return build_surface(sized);
  } catch (const parallel::CollectiveError& error) {
    if (error.kind() != parallel::FailureKind::input) throw;
    tell(error.what());
  } catch (const surface::SurfaceError& error) {
    tell(error.what());
  }
  return std::nullopt;
}

/// Makes the surface again, with sizes that account for what is to be made inside of the last one, as long as
/// that comes nearer to the target.
bool SurfaceStages::choose_again(domain::SizedDomain& sized, surface::SurfaceMesh& made) {
  constexpr int most_choices = 3;  // chosen, not measured
  bool is_other = false;
  std::optional<double> count;
  const auto count_inside = [&] { return count ? count : count = tetrahedra_inside(made, _input); };
  for (int choice = 0; choice < most_choices; ++choice) {
    std::optional<domain::SizedDomain> again =
        domain::size_again(sized, _input.sizing, {made.field, made.lowered, count_inside});
    if (!again) break;
    std::optional<surface::SurfaceMesh> other = attempt_surface(*again, [](const std::string& what) {
      parallel::log_verbose(fmt::format("surface: {}; the sizes before stay", what));
    });
    if (!other) break;
    const std::optional<double> other_count = tetrahedra_inside(*other, _input);
    if (!other_count || !domain::comes_nearer(*other_count, *count, *again, _input.sizing)) break;
    sized = std::move(*again);
    made = std::move(*other);
    count = other_count;
    note_sizes(sized);
    is_other = true;
  }
  if (count) domain::note_count(sized, _input.sizing, *count);
  _record.findings.missed_target = sized.findings.missed_target;
  return is_other;
}

std::optional<surface::SurfaceMesh> SurfaceStages::find_surface(const cad::Model& domain,
                                                                domain::SizedDomain& sized) {
  std::optional<io::CheckpointContent> found = _checkpoints.find(SavedStage::surface);
  if (!found) return std::nullopt;
  std::optional<surface::SurfaceMesh> known = unpack_surface(std::move(*found), domain, sized);
  if (known)
    _record.resumed.emplace_back("surface");
  else
    parallel::log_info("checkpoint: that surface is of other sizes: done anew");
  return known;
}

/// Numbers the surface, checks it, and logs the result.
FinishedSurface SurfaceStages::finish_surface(const cases::TypedPatches& domain,
                                              const domain::SizedDomain& sized,
                                              surface::SurfaceMesh surface) {
  _record.surface = surface.report;
  FinishedSurface finished{std::move(surface), sized.model, types_of(sized.model.patches(), domain),
                           sized.sizes, sized.findings.counts.tetrahedra};
  inspect_surface("the surface mesh", finished);
  judge_chambers(finished, _input.chambers);
  static_cast<report::SurfaceFigures&>(_record) = finished.figures;
  log_surface(finished.report, finished.figures);
  if (_communicator.is_root()) {
    log_needles(finished.report, finished.figures.face_table);
    warn_of_lost_area(finished.figures.patches);
  }
  return finished;
}

surface::SurfaceMesh SurfaceStages::build_surface(const domain::SizedDomain& sized) {
  surface::SurfaceOptions options = _input.surface;
  options.rows = cases::rows_along_edges(cases::in_model_units(_input.sizing).edges, sized.model);
  return surface::mesh_surface(sized.model, sized.field, options, _checkpoints.tasks(SavedStage::surface));
}

/// The surface of the sized domain. Where joined faces or closed edges cannot be meshed, that of the model
/// as it was, and `sized` becomes its.
surface::SurfaceMesh SurfaceStages::build_surface(const cad::Model& domain, domain::SizedDomain& sized) {
  if (!is_simplified(sized)) return build_surface(sized);
  if (auto made = attempt_surface(sized, log_surface_again)) return std::move(*made);
  sized = build_sizes(domain, {cases::NarrowFaces::keep, cad::TrailingEdges::keep});
  return build_surface(sized);
}

/// Meshes the surface; what fails near trailing edges that were closed may not fail where they stay.
surface::SurfaceMesh SurfaceStages::build_surface_or_advise(const cad::Model& domain,
                                                            domain::SizedDomain& sized) {
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

}  // namespace aeroloom::pipeline
