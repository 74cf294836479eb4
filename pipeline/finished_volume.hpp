/// Improvement, checks and figures of a volume mesh, the same whether it was made or read.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/storage/task_store.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/run.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// An invalid mesh is a defect of the program that must not reach a file unnoticed: throws std::runtime_error
/// with the violations.
void require_valid(const std::string& what, const mesh::ValidityReport& report);

/// Improves the mesh as the case asks for, and puts on record what it returns; `tasks` as in
/// improve::improve_mesh. Collective.
improve::ImproveReport improve_volume(const cases::Case& input, const improve::MeshSource& source,
                                      mesh::DistributedMesh& volume, report::RunRecord& record,
                                      parallel::TaskStore* tasks = nullptr);

/// Checks the mesh that the last stage left, and puts its counts, regions, quality, pinned elements and hash
/// on record; `surface` may be null. Returns the counts. Collective. Throws as require_valid().
mesh::MeshCounts inspect_volume(const cases::Case& input, const mesh::NumberedMesh& volume,
                                const mesh::DistributedMesh* surface, report::RunRecord& record);

/// Adds the volumes of the regions of the model, for comparison.
void add_cad_volumes(const cad::Model& model, std::vector<report::RegionRow>& regions);

/// Triangles and areas of the patches of a mesh from a file; there is no CAD to compare them with.
/// Collective.
std::vector<report::PatchRow> table_of_patches(const mesh::DistributedMesh& volume);

/// The warning about a region that misses the volume of the CAD's by more than the gate allows, but is
/// so few of the smallest elements wide that these explain it. Empty where there is none.
std::string coarse_region(const cases::QualityGate& gate, const report::RunRecord& record);
/// Throws StageFailure when the finished mesh, or its layers, miss the limits of the case.
void require_quality(const cases::Case& input, const report::RunRecord& record);

}  // namespace aeroloom::pipeline
