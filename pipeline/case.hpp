/// A case: everything a run depends on, as plain options of the stages. Keys: docs/configuration.md.
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/improve_options.hpp"
#include "io/file_formats.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "parallel/log.hpp"
#include "pipeline/case_error.hpp"
#include "pipeline/patch_rules.hpp"
#include "pipeline/quality_gate.hpp"
#include "sizing/feature_share.hpp"
#include "surface/surface_options.hpp"
#include "volume/volume_options.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// What the user said about sizes; what is left out comes from the preset. Lengths in the model's unit.
struct SizingRequest {
  std::optional<double> minimum, maximum;   ///< minimum <= maximum
  std::optional<double> feature_minimum;    ///< smallest size at short edges, narrow faces, sharp corners
  std::optional<double> surface_maximum;    ///< largest size on faces that are not far field
  std::optional<double> curvature_angle;    ///< degrees
  std::optional<double> chordal_deviation;  ///< of triangles from curved faces
  std::optional<double> growth;             ///< ratio of neighbouring sizes
  std::optional<double> proximity;          ///< elements across thin parts and gaps; 0: any
  double target_tetrahedra = 1'000'000;     ///< what sizes chosen from the model aim at
  /// With sizes chosen from the model: tetrahedra over those aimed at, at most, where features finer than the
  /// minimum come on top.
  double feature_budget = sizing::default_feature_budget;
};

/// What happens to faces narrower than the smallest size that go on smoothly in a neighbour.
enum class NarrowFaces { join, keep };

/// Whether what stages have made is kept for a later run.
enum class CheckpointUse {
  none,
  write,  ///< anew, whatever is there
  resume  ///< goes on from what is there, and writes the rest
};

struct OutputOptions {
  std::string directory = "out";                                ///< relative to the working directory
  std::vector<io::FileFormat> formats = {io::FileFormat::vtu};  ///< that are written, each once
  std::int64_t parts = 0;  ///< of formats that come in parts; 0: what suits the size
  parallel::LogLevel log = parallel::LogLevel::normal;  ///< what is printed
  bool tasks = false;                                   ///< writes tasks.csv, a row for each task
  io::Compression compression = io::Compression::none;  ///< of mesh.pvtu and its like
  CheckpointUse checkpoints = CheckpointUse::none;      ///< in DIRECTORY/checkpoint
  bool pictures = true;                                 ///< in report.html
};

struct Case {
  cad::DomainOptions domain;
  parallel::Sabotage geometry_sabotage = parallel::Sabotage::none;  ///< of the contained CAD run
  NarrowFaces narrow_faces = NarrowFaces::join;
  SizingRequest sizing;
  surface::SurfaceOptions surface;
  volume::VolumeOptions volume;
  improve::ImproveOptions improve;
  QualityGate gate;
  std::vector<PatchRule> patches;  ///< the first that a face matches holds
  OutputOptions output;
  /// Bytes that all ranks of this node may take together; 0: any. Not a key: it changes no result.
  std::int64_t memory_limit = 0;
};

/// Reads a case and overrides of the form "section.key=value" (the value is YAML; a later one wins). A
/// relative geometry.file is sought in the working directory, then in the case file's folder; one found in
/// neither stays as it is. Throws CaseError: unknown keys (with the nearest one), duplicates, wrong types,
/// values out of range or at odds with each other, no geometry or two.
Case read_case(const std::string& file, const std::vector<std::string>& overrides);

/// A case from overrides alone, for commands that need no geometry. Throws CaseError as read_case.
Case case_of_overrides(const std::vector<std::string>& overrides);

/// The case as YAML with every value spelled out, which read_case reads back to the same case.
std::string resolved_yaml(const Case& input);

}  // namespace aeroloom::pipeline
