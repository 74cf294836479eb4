/// The messages in which the stages of a run say what they have found. Messages during a stage (retries,
/// searches) are worded where they arise.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

// Every rank calls these; rank 0 prints.

void log_geometry(const cad::Model& model, const cad::DomainReport& report);
void log_sizing(const domain::SizedDomain& sized);
/// Warns of narrow regions that stay unresolved and of sizes that lose the shape of the body. One rank calls.
void warn_of_sizes(const domain::SizedDomain& sized);
/// Warns of formats that assume metres where the model's `unit` is another. One rank calls.
void warn_of_units(const std::string& unit, double metres, const cases::OutputOptions& output);
/// Warns of a y+ at the first node where a format is for solvers that have it at the first cell's centre. One
/// rank calls.
void warn_of_solver_points(const cases::Case& input);
/// All that can be told of a case before any work: units, y+, and rules for patches. One rank calls.
void warn_of_case(const cases::TypedPatches& patches, const cases::Case& input);
void log_surface(const surface::SurfaceReport& report, const report::SurfaceFigures& figures);
/// Warns of walls whose triangles have clearly another area than the CAD. One rank calls.
void warn_of_lost_area(const std::vector<report::PatchRow>& patches);
/// Triangles below ten degrees: how many the CAD forces, and where the others are. `faces` by face id.
void log_needles(const surface::SurfaceReport& report, const std::vector<report::FaceRow>& faces);
/// Joined faces could not be meshed: the surface is meshed again without joining.
void log_surface_again(const std::string& reason);
void log_layers(const report::LayerRecord& layers);
/// Warns of walls that ask for layers and have none. `patches`: names by patch. One rank calls.
void warn_of_missing_layers(const report::LayerRecord& layers, const std::vector<std::string>& patches);
/// Warns of walls whose layers, by their count or total, end much lower than sizes there, or lower than the
/// boundary layer. One rank calls.
void warn_of_low_layers(const report::LayerRecord& layers, const std::vector<std::string>& patches);
void log_decompose(const volume::DecompositionReport& report);
/// Warns where many more tetrahedra are expected than were forecast. `resize_rounds`: of the surface.
void warn_of_count(double expected, double forecast, int resize_rounds);
void log_volume(const volume::VolumeReport& report);
void log_improve(const improve::ImproveReport& report);
/// What cell-centred solvers make of the mesh.
void log_solver_quality(const mesh::SolverQuality& quality);
/// Warns of the worst place of each flaw that is poor. One rank calls.
void warn_of_flaws(const report::VolumeFigures& figures);
/// Prints nothing where no tetrahedron is below its target.
void log_pinned(const attribution::PinnedReport& report);

}  // namespace aeroloom::pipeline
