#include "pipeline/run.hpp"

#include "io/vtk/vtk_writer.hpp"
#include "mesh/boundary_mesh.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include "parallel/collective_error.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/load_domain.hpp"
#include "pipeline/pictures.hpp"
#include "pipeline/size_domain.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/stage_log.hpp"
#include "pipeline/write_outputs.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::Communicator;

void describe_domain(const cad::Model& model, RunRecord& record) {
  record.unit = model.unit_name();
  record.unit_in_metres = model.unit_in_metres();
  record.bounds = model.bounds();
  record.regions = model.region_count();
  record.faces = model.face_count();
  record.edges = model.edge_count();
  log_geometry(model, record);
}

/// Sizes, and the model they are for.
SizedDomain build_sizes(const Communicator& communicator, const cad::Model& model, const Case& input,
                        NarrowFaces narrow_faces, RunRecord& record) {
  SizedDomain sized = size_domain(communicator, model, input.sizing, narrow_faces, record.clock);
  record.sizes = sized.sizes;
  record.size_field_leaves = sized.field.leaf_count();
  record.face_names.clear();
  for (cad::FaceId f = 0; f < sized.model.face_count(); ++f) {
    record.face_names.push_back(sized.model.face(f).name);
  }
  record.joined_faces = sized.joined;
  record.features = sized.features;
  log_sizing(record);
  return sized;
}

/// Areas and counts by patch; sums run in the order of the pieces, whatever rank they live on.
std::vector<PatchRow> table_of_patches(const Communicator& communicator, const cad::Model& model,
                                       const mesh::DistributedMesh& surface,
                                       const std::vector<mesh::PatchType>& types) {
  struct PieceRow {
    mesh::PieceId piece;
    cad::FaceId face;
    double area;
    std::int64_t triangles;
  };
  std::vector<PieceRow> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    double area = 0;
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const geometry::Vec3 a = piece.point(v[0]);
      area += 0.5 * norm(cross(piece.point(v[1]) - a, piece.point(v[2]) - a));
    }
    mine.push_back({piece.id, piece.common_face(), area, piece.cell_count()});
  }
  std::vector<PieceRow> rows = communicator.all_gather_items<PieceRow>(mine);
  std::sort(rows.begin(), rows.end(), [](const PieceRow& a, const PieceRow& b) { return a.piece < b.piece; });
  std::vector<PatchRow> patches;
  for (std::size_t p = 0; p < model.patches().size(); ++p)
    patches.push_back({.name = model.patches()[p], .type = types.at(p)});
  std::vector<char> counted(model.face_count(), 0);
  for (const PieceRow& row : rows) {
    PatchRow& patch = patches[model.face(row.face).patch];
    patch.inner = patch.inner || model.face(row.face).back != cad::no_entity;
    patch.area += row.area;
    patch.triangles += row.triangles;
    if (!counted[row.face]) patch.cad_area += model.face_area(row.face);
    counted[row.face] = 1;
  }
  return patches;
}

/// A mesh with its global numbers.
struct NumberedMesh {
  mesh::DistributedMesh mesh;
  mesh::Numbering numbering;
};

/// The finished surface with its sizes.
struct FinishedSurface : NumberedMesh {
  sizing::SizeField field;
};

void inspect_surface(const Communicator& communicator, const cad::Model& model, const std::string& what,
                     const NumberedMesh& surface, RunRecord& record) {
  const parallel::ScopedCpu check(record.clock, parallel::ScopedCpu::As::check);
  require_valid(what, mesh::check_surface_mesh(communicator, surface.mesh, surface.numbering));
  record.surface_quality = mesh::summarise_quality(communicator, surface.mesh, surface.numbering);
  record.patches = table_of_patches(communicator, model, surface.mesh, record.patch_types);
}

FinishedSurface build_surface(const Communicator& communicator, const cad::Model& model,
                              const sizing::SizeField& field, const Case& input, RunRecord& record) {
  surface::SurfaceMesh surface =
      surface::mesh_surface(communicator, model, field, input.surface, record.clock);
  record.surface = surface.report;
  mesh::Numbering numbering = mesh::number_mesh(communicator, surface.mesh);
  FinishedSurface finished{{std::move(surface.mesh), std::move(numbering)}, std::move(surface.field)};
  inspect_surface(communicator, model, "the surface mesh", finished, record);
  log_surface(record);
  if (communicator.is_root()) log_needles(record);
  return finished;
}

/// The surface of the sized domain. Where joined faces cannot be meshed, that of the model as it was, and
/// `sized` becomes its.
FinishedSurface build_surface(const Communicator& communicator, const cad::Model& model, const Case& input,
                              SizedDomain& sized, RunRecord& record) {
  if (sized.joined.empty()) return build_surface(communicator, sized.model, sized.field, input, record);
  try {
    return build_surface(communicator, sized.model, sized.field, input, record);
  } catch (const parallel::CollectiveError& error) {
    if (error.kind() != parallel::FailureKind::input) throw;
    log_surface_again(error.what());
  } catch (const surface::SurfaceError& error) {
    log_surface_again(error.what());
  }
  sized = build_sizes(communicator, model, input, NarrowFaces::keep, record);
  return build_surface(communicator, sized.model, sized.field, input, record);
}

/// As above; what fails near trailing edges that were closed may not fail where they stay.
FinishedSurface build_surface_or_advise(const Communicator& communicator, const cad::Model& model,
                                        const Case& input, SizedDomain& sized, RunRecord& record) {
  const bool sharpened = input.domain.trailing_edges.treatment == cad::TrailingEdges::sharpen;
  const auto advised = [&](const std::string& text) {
    return text +
           "; or leave the trailing edges there as they are (geometry.sharpen_faces, "
           "geometry.sharpen_width)";
  };
  try {
    return build_surface(communicator, model, input, sized, record);
  } catch (const parallel::CollectiveError& error) {
    if (!sharpened) throw;
    throw parallel::CollectiveError(error.kind(), advised(error.what()));
  } catch (const surface::SurfaceError& error) {
    if (!sharpened) throw;
    throw surface::SurfaceError(advised(error.what()));
  }
}

volume::VolumeInput volume_input(const FinishedSurface& surface, const Case& input) {
  return {surface.mesh, surface.numbering, surface.field, input.volume};
}

volume::Decomposition decompose(const Communicator& communicator, const FinishedSurface& surface,
                                const Case& input, RunRecord& record) {
  volume::Decomposition decomposition =
      volume::decompose(communicator, volume_input(surface, input), record.clock);
  record.decomposition = decomposition.report();
  log_decompose(record);
  return decomposition;
}

/// The surface follows a volume whose boundary was improved.
void adopt_boundary(const Communicator& communicator, const cad::Model& model,
                    const mesh::DistributedMesh& volume, const mesh::Numbering& numbering,
                    FinishedSurface& surface, RunRecord& record) {
  surface.mesh = mesh::boundary_mesh(communicator, volume, numbering);
  surface.numbering = mesh::number_mesh(communicator, surface.mesh);
  inspect_surface(communicator, model, "the improved surface mesh", surface, record);
}

/// Leaves the triangles at fault in a file and throws the failure with the file's name. Collective.
[[noreturn]] void point_at_offenders(const Communicator& communicator, const volume::VolumeFailure& failure,
                                     const std::string& file) {
  std::string outcome = "the triangles are in " + file;
  try {
    parallel::agree(communicator, [&] {
      if (communicator.is_root()) io::write_triangles(failure.points(), failure.triangles(), file);
    });
  } catch (const parallel::CollectiveError& error) {
    outcome = fmt::format("the triangles cannot be written: {}", error.what());
  }
  throw parallel::CollectiveError(failure.kind(), fmt::format("{}; {}", failure.what(), outcome));
}

mesh::DistributedMesh fill_volume(const Communicator& communicator, const FinishedSurface& surface,
                                  volume::Decomposition decomposition, const Case& input, RunRecord& record) {
  try {
    return volume::fill_zones(communicator, volume_input(surface, input), std::move(decomposition),
                              record.clock, record.volume);
  } catch (const volume::VolumeFailure& failure) {
    point_at_offenders(communicator, failure, input.output.directory + "/offending_triangles.vtp");
  }
}

mesh::DistributedMesh build_volume(const Communicator& communicator, const FinishedSurface& surface,
                                   volume::Decomposition decomposition, const Case& input,
                                   RunRecord& record) {
  mesh::DistributedMesh filled = fill_volume(communicator, surface, std::move(decomposition), input, record);
  log_volume(record);
  return filled;
}

/// The stages from the surface to the improved volume.
mesh::DistributedMesh mesh_volume(const Communicator& communicator, const SizedDomain& sized,
                                  const FinishedSurface& surface, const Case& input, RunRecord& record) {
  volume::Decomposition decomposition = run_stage(
      record, "decompose", ExitCode::volume, [&] { return decompose(communicator, surface, input, record); });
  mesh::DistributedMesh volume = run_stage(record, "volume", ExitCode::volume, [&] {
    return build_volume(communicator, surface, std::move(decomposition), input, record);
  });
  run_stage(record, "improve", ExitCode::volume, [&] {
    cad::PointLocator locator(sized.model);
    improve_volume(communicator, input, {&locator, &surface.field}, volume, record);
  });
  return volume;
}

}  // namespace

void run_case(const Communicator& communicator, const Case& input, RunRecord& record) {
  const cad::Model loaded = run_stage(record, "geometry", ExitCode::cad, [&] {
    const cad::Model model =
        load_domain(communicator, input.domain, record.clock, record.domain, input.geometry_sabotage);
    TypedPatches patches = apply_patch_rules(model, input.patches);
    record.patch_types = std::move(patches.types);
    describe_domain(patches.model, record);
    return std::move(patches.model);
  });
  SizedDomain sized = run_stage(record, "sizing", ExitCode::cad, [&] {
    return build_sizes(communicator, loaded, input, input.narrow_faces, record);
  });
  FinishedSurface surface = run_stage(record, "surface", ExitCode::surface, [&] {
    return build_surface_or_advise(communicator, loaded, input, sized, record);
  });
  const PictureSource pictured{surface.mesh, surface.numbering, record.patch_types, record.unit};
  mesh::DistributedMesh volume =
      with_pictures_of_failure(communicator, pictured, input.output, record.pictures,
                               [&] { return mesh_volume(communicator, sized, surface, input, record); });
  const mesh::Numbering numbering = run_stage(record, "inspect", ExitCode::volume, [&] {
    mesh::Numbering finished = mesh::number_mesh(communicator, volume);
    if (record.improve.changed_triangles > 0)
      adopt_boundary(communicator, sized.model, volume, finished, surface, record);
    inspect_volume(communicator, input, volume, finished, &surface.mesh, record);
    const parallel::ScopedCpu check(record.clock, parallel::ScopedCpu::As::check);
    record.conformity = measure_conformity(communicator, volume, surface.field);
    return finished;
  });
  volume.patch_types = record.patch_types;
  run_stage(record, "output", ExitCode::files, [&] {
    write_outputs(communicator, volume, numbering, input.output);
    if (wants_vtk(input.output)) write_surfaces(communicator, surface.mesh, surface.numbering, input.output);
    if (input.output.pictures) record.pictures = pictures_or_warning(communicator, &volume, pictured);
  });
  require_quality(input.gate, record);
}

}  // namespace aeroloom::pipeline
