/// One run: from a case to a mesh on disk.
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/improver.hpp"
#include "improve/pinned.hpp"
#include "mesh/mixed_quality.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/bounded_faces.hpp"
#include "pipeline/case.hpp"
#include "pipeline/exit_code.hpp"
#include "pipeline/picture.hpp"
#include "pipeline/size_conformity.hpp"
#include "pipeline/trailing_edges.hpp"
#include "pipeline/unresolved_features.hpp"
#include "pipeline/wall_findings.hpp"
#include "sizing/size_field.hpp"
#include "surface/surface_mesher.hpp"
#include "volume/volume_mesher.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// A boundary patch of the finished mesh.
struct PatchRow {
  std::string name;
  mesh::PatchType type = mesh::PatchType::wall;
  double area = 0;      ///< of the triangles, in the square of the model's unit
  double cad_area = 0;  ///< of the CAD faces
  std::int64_t triangles = 0;
  bool inner = false;  ///< has faces between two regions
};

/// A region of the finished mesh.
struct RegionRow {
  std::string name;
  double volume = 0;
  std::int64_t tetrahedra = 0;
  double cad_volume = 0;      ///< of the CAD's region; 0 where there is no CAD
  bool in_far_field = false;  ///< bounded by a far field, which is as coarse as it likes
};

/// Everything a run has found out, filled stage by stage; what a report is written from. The same on every
/// rank except `domain` and `pictures`, which rank 0 alone holds.
struct RunRecord {
  std::string input_hash;  ///< 128 bits, of the bytes of the geometry file or of the built-in's dimensions
  std::int64_t input_bytes = 0;      ///< of that file
  std::vector<std::string> resumed;  ///< stages whose results came from an earlier run
  cad::DomainReport domain;
  std::string unit;
  double unit_in_metres = 0;
  geometry::Box bounds;
  std::int32_t regions = 0, faces = 0, edges = 0;
  std::vector<std::string> face_names;       ///< by face id
  std::vector<mesh::PatchType> patch_types;  ///< by patch of the model
  TrailingEdgeReport trailing_edges;         ///< what became of blunt ones
  cad::Changes joined_faces;                 ///< narrow faces that vanished in their neighbours
  sizing::SizingOptions sizes;
  std::optional<FeatureReport> features;
  std::vector<NamedBound> bounded_faces;  ///< on which the smallest size wins over curvature
  sizing::PredictedCounts forecast;       ///< what the size field predicts
  WallFindings walls;                     ///< what was found of walls close to each other
  std::int64_t size_field_leaves = 0;
  surface::SurfaceReport surface;
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  SizeConformity conformity;
  improve::ImproveReport improve;
  improve::PinnedReport pinned;
  mesh::MeshCounts counts;
  double mesh_volume = 0;
  std::string hash;
  std::optional<mesh::QualitySummary> surface_quality, quality;
  std::optional<mesh::MixedQuality> cells;  ///< where the gate asks for what only this has
  std::vector<PatchRow> patches;
  std::vector<RegionRow> regions_filled;
  std::vector<Picture> pictures;
  parallel::StageClock clock;
  double wall_seconds = 0;  ///< of the program, from its start to the end of the last stage
};

/// Runs all stages of the case in order, with validity checks between them, and writes mesh.pvtu,
/// surface.pvtp and, where regions share faces, interfaces.pvtp. Collective. Throws StageFailure on all
/// ranks.
void run_case(const parallel::Communicator& communicator, const Case& input, RunRecord& record);

}  // namespace aeroloom::pipeline
