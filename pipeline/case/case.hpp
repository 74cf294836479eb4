/// A case: everything a run depends on, as plain options of the stages. Keys: docs/configuration/.
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/improve_options.hpp"
#include "io/file_formats.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/case/case_error.hpp"
#include "pipeline/case/face_groups.hpp"
#include "pipeline/case/layer_rules.hpp"
#include "pipeline/case/patch_rules.hpp"
#include "pipeline/case/quality_gate.hpp"
#include "sizing/choice/feature_resolution.hpp"
#include "sizing/choice/given_sizes.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/sources/patch_size.hpp"
#include "sizing/sources/size_shapes.hpp"
#include "surface/surface_options.hpp"
#include "volume/volume_options.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {
struct WallSize;
struct EdgeSize;
}  // namespace aeroloom::sizing

namespace aeroloom::cases {

/// A source of sizes as it is written, or in the model's unit.
struct SourceRule {
  std::string name;
  sizing::SizeShape shape;
  double size = 0;  ///< largest size within; of a wake where it begins
};

/// A band of small elements off walls as it is written.
struct WallRule {
  std::string name;
  std::vector<std::string> faces;  ///< patterns; none: all walls
  std::optional<double> size, distance;
};

/// Sizes along CAD edges as they are written.
struct EdgeRule {
  std::string name;
  std::vector<std::string> between;         ///< patterns of faces
  std::optional<geometry::Vec3> low, high;  ///< corners of a box
  std::optional<double> size;
};

/// What rules ask for that have all they need.
sizing::WallSize wall_of(const WallRule& rule);
sizing::EdgeSize edge_of(const EdgeRule& rule);

/// The sizes that the user gave; others are chosen from the model.
struct SizingRequest : sizing::GivenSizes {
  /// The number of tetrahedra that chosen sizes aim at; left out: default_target, or any where minimum and
  /// maximum are given.
  std::optional<double> target_tetrahedra;
  /// With sizes chosen from the model: tetrahedra over those aimed at, at most, where features finer than the
  /// minimum come on top.
  double feature_budget = sizing::default_feature_budget;
  /// What one unit of the lengths here and of their places is, in the model's unit; left out: 1.
  std::optional<double> reference_length;
  std::string expression;                                      ///< a formula of the place; empty: none
  std::optional<sizing::Level> level;                          ///< takes what is not given from guidelines
  std::optional<double> budget;                                ///< of tetrahedra: takes a coarser level
  std::optional<sizing::LevelFamily> family;                   ///< of the level; left out: hlpw
  sizing::SolverPoints solver = sizing::SolverPoints::vertex;  ///< what spacings of a level mean
  std::optional<geometry::Vec3> flow;  ///< its direction, for levels; of any length; left out: default_flow
  std::vector<std::string> lifting;    ///< patterns of faces with trailing edges, for levels; none: all faces
  std::vector<SourceRule> sources;     ///< regions with sizes of their own
  std::vector<WallRule> walls;         ///< bands off walls
  std::vector<EdgeRule> edges;         ///< sizes along CAD edges
  std::vector<sizing::PatchSize> patch_sizes;  ///< of patches and groups that have any
};

/// The request with all lengths and places but those of the expression in the model's unit.
SizingRequest in_model_units(const SizingRequest& request);

inline constexpr geometry::Vec3 default_flow{1, 0, 0};
inline constexpr double default_target = 1'000'000;

/// The treatment of faces narrower than the smallest size that go on smoothly in a neighbour.
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
  bool tasks = true;                                    ///< writes tasks.csv, a row for each task
  io::Compression compression = io::Compression::none;  ///< of mesh.pvtu and its like
  CheckpointUse checkpoints = CheckpointUse::none;      ///< in DIRECTORY/checkpoint
  bool pictures = true;                                 ///< in report.html
};

struct Case {
  cad::DomainOptions domain;
  NarrowFaces narrow_faces = NarrowFaces::join;
  SizingRequest sizing;
  surface::SurfaceOptions surface;
  LayerRequest layers;
  volume::VolumeOptions volume;
  improve::ImproveOptions improve;
  QualityGate gate;
  FaceGroups groups;
  std::vector<PatchRule> patches;  ///< the first that a face in no group matches holds
  OutputOptions output;
  parallel::Sandbox sandbox = parallel::Sandbox::process;  ///< changes no result
  /// Bytes that all ranks of this node may take together; 0: any. Not a key: it changes no result.
  std::int64_t memory_limit = 0;
};

/// Reads a case and overrides of the form "section.key=value" (the value is YAML; a later one wins). A
/// relative geometry.file is sought in the case file's folder, then in the working directory; one found in
/// neither, or given by an override, stays as it is. Throws CaseError: unknown keys (with the nearest one),
/// duplicates, wrong types, values out of range or at odds with each other, no geometry or two.
Case read_case(const std::string& file, const std::vector<std::string>& overrides);

/// The case that resolved_yaml() has written, on a rank that does not look at the file itself.
Case case_of_resolved(const std::string& yaml);

/// A case from overrides alone, for commands that need no geometry. Throws CaseError as read_case.
Case case_of_overrides(const std::vector<std::string>& overrides);

/// The case as YAML with every value spelled out, which read_case reads back to the same case.
std::string resolved_yaml(const Case& input);

}  // namespace aeroloom::cases
