/// Improves, checks and measures a volume mesh, whether made by the stages or read from a file.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/storage/task_store.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// Throws std::runtime_error with the violations if a mesh is invalid. This is a defect of the program; no
/// file is written.
void require_valid(const std::string& what, const mesh::ValidityReport& report);

/// The case's options of improvement. With layers, the boundary must not change.
improve::ImproveOptions improve_options(const cases::Case& input);

/// Improves the mesh if the options enable it, and logs the result. `tasks`: as for improve::improve_mesh().
/// Collective.
improve::ImproveReport improve_volume(const improve::ImproveOptions& options,
                                      const improve::MeshSource& source, mesh::DistributedMesh& volume,
                                      parallel::TaskStore* tasks = nullptr);

/// Checks and measures the finished mesh. `options`: used to improve it; `surface`: boundary to compare with,
/// may be null. Collective. Throws as require_valid().
report::VolumeFigures inspect_volume(const improve::ImproveOptions& options, const cases::QualityGate& gate,
                                     const mesh::NumberedMesh& volume, const mesh::DistributedMesh* surface);

/// Adds the volume of each region in the CAD model, for comparison.
void add_cad_volumes(const cad::Model& model, std::vector<report::RegionRow>& regions);

/// Area and number of triangles of one piece on a face or patch.
struct PieceArea {
  mesh::PieceId piece;
  std::int32_t of;  ///< id of the face or index of the patch
  double area = 0;
  std::int64_t triangles = 0;

  void add(const mesh::Piece& of_piece, const mesh::LocalIndex* triangle);
};
/// The rows of all ranks, ordered by piece, then face or patch. Sums in this order are independent of ranks.
/// Collective.
std::vector<PieceArea> gather_areas(const mesh::DistributedMesh& mesh, const std::vector<PieceArea>& mine);

/// Triangles and areas of the patches of a mesh from a file, without CAD areas. Collective.
std::vector<report::PatchRow> table_of_patches(const mesh::DistributedMesh& volume);

/// The results that the quality gate judges. Holds references.
struct JudgedMesh {
  const report::VolumeFigures& volume;
  const std::vector<report::PatchRow>& patches;
  const report::LayerRecord* layers = nullptr;  ///< null: no layers
  sizing::SizingOptions sizes = {};             ///< for messages
  std::string unit = {};                        ///< of lengths, for messages
};

/// A warning about a region whose volume deviates from the CAD by more than the limit, but which is only a
/// few of the smallest elements wide. May be empty.
std::string coarse_region(const cases::QualityGate& gate, const JudgedMesh& mesh);
/// The limits of the case that the mesh or its layers miss, a line for each; empty if there are none.
std::string missed_quality(const cases::Case& input, const JudgedMesh& mesh);
/// Throws StageFailure if there are any.
void require_quality(const cases::Case& input, const JudgedMesh& mesh);

}  // namespace aeroloom::pipeline
