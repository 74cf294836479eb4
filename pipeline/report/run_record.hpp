/// The record of a run, from which its report is written.
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/attribution/pinned.hpp"
#include "improve/attribution/size_conformity.hpp"
#include "improve/improver.hpp"
#include "layers/columns.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/quality.hpp"
#include "mesh/quality/solver_quality.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/case/layer_rules.hpp"
#include "pipeline/case/quality_gate.hpp"
#include "pipeline/domain/sizing_findings.hpp"
#include "pipeline/report/picture.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/surface_mesher.hpp"
#include "volume/volume_mesher.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::report {

/// A boundary patch of the finished mesh.
struct PatchRow {
  std::string name;
  mesh::PatchType type = mesh::PatchType::wall;
  double area = 0;      ///< of the triangles, in the square of the model's unit
  double cad_area = 0;  ///< of the CAD faces
  std::int64_t triangles = 0;
  bool inner = false;  ///< has faces between two regions
};

/// A CAD face of the finished mesh.
struct FaceRow {
  std::string name;
  std::int32_t number = -1;  ///< in the CAD file; -1: made by the program
  std::string patch;
  double area = 0;      ///< of the triangles, in the square of the model's unit
  double cad_area = 0;  ///< of the CAD face
  std::int64_t triangles = 0;
};

/// A region of the finished mesh.
struct RegionRow {
  std::string name;
  double volume = 0;
  std::int64_t tetrahedra = 0;
  double cad_volume = 0;      ///< of the CAD region; 0 without CAD
  bool in_far_field = false;  ///< bounded by a far field; its volume is not judged
};

/// The layers asked for and the layers made, both by patch of the mesh.
struct LayerRecord {
  layers::LayerOptions asked;  ///< as `layers.fit` has changed it
  layers::LayerReport report;
  /// Thickness of a flat plate's boundary layer at the case's Reynolds number, if it has one.
  std::optional<double> boundary_layer = {};
  cases::LayerFit fit = cases::LayerFit::none;  ///< the case's
};

/// The results of checking a finished surface mesh.
struct SurfaceFigures {
  std::optional<mesh::QualitySummary> surface_quality;
  std::vector<FaceRow> face_table;  ///< by face id; empty for a mesh from a file
  std::vector<PatchRow> patches;
};

/// The results of checking a finished volume mesh.
struct VolumeFigures {
  mesh::MeshCounts counts;
  double mesh_volume = 0;
  std::string hash;
  std::optional<mesh::QualitySummary> quality;
  std::optional<mesh::MixedQuality> cells;    ///< if the mesh has layers, or the gate limits their measures
  std::optional<mesh::SolverQuality> solver;  ///< as `cells`, and if the gate limits its measures
  attribution::PinnedReport pinned;
  std::vector<RegionRow> regions_filled;

  cases::MeasuredCells measured_cells() const {
    return {cells ? &*cells : nullptr, solver ? &*solver : nullptr};
  }
};

/// The facts of a run, from which its report is written. The driver copies the results of each stage into the
/// record and never reads it. Equal on every rank, but only rank 0 has `domain` and `pictures`.
struct RunRecord : SurfaceFigures, VolumeFigures {
  std::string input_hash;        ///< 128 bits, of the geometry file or of the built-in geometry's dimensions
  std::int64_t input_bytes = 0;  ///< of that file
  std::vector<std::string> resumed;  ///< stages whose results come from an earlier run
  cad::DomainReport domain;
  std::string unit;
  double unit_in_metres = 0;
  geometry::Box bounds;
  std::int32_t regions = 0, faces = 0, edges = 0;
  std::vector<std::string> face_names;  ///< by face id
  sizing::SizingOptions sizes;
  domain::SizingFindings findings;
  std::int64_t size_field_leaves = 0;
  surface::SurfaceReport surface;
  std::optional<LayerRecord> layers;  ///< if the case asks for layers
  volume::DecompositionReport decomposition;
  volume::VolumeReport volume;
  attribution::SizeConformity conformity;
  improve::ImproveReport improve;
  std::vector<Picture> pictures;
  parallel::StageClock clock;
  double wall_seconds = 0;  ///< from the start of the program to the end of the last stage
};

}  // namespace aeroloom::report
