/// Improvement, checks and figures of a volume mesh, the same whether it was made or read.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/storage/task_store.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::pipeline {

/// An invalid mesh is a defect of the program that must not reach a file unnoticed: throws std::runtime_error
/// with the violations.
void require_valid(const std::string& what, const mesh::ValidityReport& report);

/// Improvement as the case asks for it. The boundary stays as it is where layers stand on it.
improve::ImproveOptions improve_options(const cases::Case& input);

/// Improves the mesh if the options enable it, and logs the result; `tasks` as in improve::improve_mesh.
/// Collective.
improve::ImproveReport improve_volume(const improve::ImproveOptions& options,
                                      const improve::MeshSource& source, mesh::DistributedMesh& volume,
                                      parallel::TaskStore* tasks = nullptr);

/// Checks the finished mesh and measures it; `options` are those that it was improved with, `surface` may be
/// null. Collective. Throws as require_valid().
report::VolumeFigures inspect_volume(const improve::ImproveOptions& options, const cases::QualityGate& gate,
                                     const mesh::DistributedMesh& volume, const mesh::Numbering& numbering,
                                     const mesh::DistributedMesh* surface);

/// Adds the volumes of the regions of the model, for comparison.
void add_cad_volumes(const cad::Model& model, std::vector<report::RegionRow>& regions);

/// The area and the triangles that one piece has of a face or patch.
struct PieceArea {
  mesh::PieceId piece;
  std::int32_t of;  ///< the face or patch
  double area = 0;
  std::int64_t triangles = 0;

  void add(const mesh::Piece& of_piece, const mesh::LocalIndex* triangle);
  static constexpr auto fields() {
    return std::tuple(&PieceArea::piece, &PieceArea::of, &PieceArea::area, &PieceArea::triangles);
  }
};
/// The rows of all ranks, by piece, then face or patch. Sums in this order do not depend on ranks.
/// Collective.
std::vector<PieceArea> gather_areas(const mesh::DistributedMesh& mesh, const std::vector<PieceArea>& mine);

/// Triangles and areas of the patches of a mesh from a file; there is no CAD to compare them with.
/// Collective.
std::vector<report::PatchRow> table_of_patches(const mesh::DistributedMesh& volume);

/// The results that the quality gate judges. Refers to its members' originals.
struct JudgedMesh {
  const report::VolumeFigures& volume;
  const std::vector<report::PatchRow>& patches;
  const report::LayerRecord* layers = nullptr;  ///< null: a mesh without layers
  sizing::SizingOptions sizes = {};             ///< for messages
  std::string unit = {};                        ///< of lengths, for messages
};

/// A warning about a region whose volume misses the CAD's by more than the gate allows, where the region is
/// only a few of the smallest elements wide. Empty where there is none.
std::string coarse_region(const cases::QualityGate& gate, const JudgedMesh& mesh);
/// Throws StageFailure when the finished mesh, or its layers, miss the limits of the case.
void require_quality(const cases::Case& input, const JudgedMesh& mesh);

}  // namespace aeroloom::pipeline
