/// A case: all that a run depends on, as plain options of the stages. Keys: docs/configuration/.
#pragma once

#include "cad/domain/domain.hpp"
#include "improve/improve_options.hpp"
#include "io/file_formats.hpp"
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
#include <utility>
#include <vector>

namespace aeroloom::sizing {
struct WallSize;
struct EdgeSize;
}  // namespace aeroloom::sizing

namespace aeroloom::cases {

/// A region with a size of its own, in the lengths of the case or in the model's unit.
struct SourceRule {
  std::string name;
  sizing::SizeShape shape;
  double size = 0;  ///< largest size in the region; of a wake, where it begins
};

/// A band of small elements along walls, as the case file has it.
struct WallRule {
  std::string name;
  std::vector<std::string> faces;  ///< name patterns; none: all walls
  std::optional<double> size, distance;
};

/// A size along CAD edges, as the case file has it.
struct EdgeRule {
  std::string name;
  std::vector<std::string> between;         ///< name patterns of faces
  std::optional<geometry::Vec3> low, high;  ///< corners of a box
  std::optional<double> size;
  /// Of rows: the first height; the growth from row to row; the longest segment of the edge over the height.
  std::optional<double> height, growth, stretch;
};

/// What a checked rule asks the size field for.
sizing::WallSize wall_of(const WallRule& rule);
sizing::EdgeSize edge_of(const EdgeRule& rule);
/// The rows that the rules ask for, by CAD edge, of several the lowest; empty: none. In units of the model.
std::vector<surface::EdgeRows> rows_along_edges(const std::vector<EdgeRule>& rules, const cad::Model& model);

/// The sizes that the user gave. All others are chosen from the model.
struct SizingRequest : sizing::GivenSizes {
  /// Number of tetrahedra to aim at. Left out: default_target, or no target where `minimum` and `maximum` are
  /// given.
  std::optional<double> target_tetrahedra;
  /// Chosen sizes may resolve features finer than `minimum` up to this factor times the target count.
  double feature_budget = sizing::default_feature_budget;
  /// Factor on all sizes, chosen ones included, after they were chosen. In (0, inf).
  double scale = 1;
  /// Length of the case's unit for sizes and places, in the model's unit; left out: 1.
  std::optional<double> reference_length;
  std::string expression;              ///< size as a formula of the place; empty: none
  std::optional<sizing::Level> level;  ///< guidelines of this level supply what is not given
  std::optional<double> budget;  ///< most tetrahedra; a level that needs more is replaced by a coarser one
  std::optional<sizing::LevelFamily> family;                   ///< of the level; left out: hlpw
  sizing::SolverPoints solver = sizing::SolverPoints::vertex;  ///< where a level's spacings are measured
  std::optional<geometry::Vec3> flow;  ///< flow direction for levels, of any length; left out: default_flow
  std::vector<std::string>
      lifting;  ///< name patterns of faces with trailing edges, for levels; none: all faces
  std::vector<SourceRule> sources;             ///< regions with sizes of their own
  std::vector<WallRule> walls;                 ///< bands along walls
  std::vector<EdgeRule> edges;                 ///< sizes along CAD edges
  std::vector<sizing::PatchSize> patch_sizes;  ///< of patches and groups that have a size
  /// Of patches and groups that have a condition; the last of one name holds.
  std::vector<std::pair<std::string, mesh::PatchType>> patch_types;
};

/// The request with lengths and places in the model's unit. The expression stays as it is.
SizingRequest in_model_units(const SizingRequest& request);

inline constexpr geometry::Vec3 default_flow{1, 0, 0};
inline constexpr double default_target = 1'000'000;

/// Whether a region may fall into parts that nothing joins.
enum class ChamberUse { refuse, keep };

/// What happens to a face narrower than the smallest size that continues smoothly into a neighbour.
enum class NarrowFaces { join, keep };

/// Whether results of stages are kept for a later run.
enum class CheckpointUse {
  none,
  write,  ///< keeps results, ignores those of earlier runs
  resume  ///< takes results of an earlier run, keeps the others
};

struct OutputOptions {
  std::string directory = "out";                                ///< relative to the working directory
  std::vector<io::FileFormat> formats = {io::FileFormat::vtu};  ///< each is written once
  std::int64_t parts = 0;  ///< number of parts in formats that have parts; 0: chosen by the size of the mesh
  parallel::LogLevel log = parallel::LogLevel::normal;  ///< how much is printed
  bool tasks = true;                                    ///< writes tasks.csv, a row for each task
  io::Compression compression = io::Compression::none;  ///< of the VTK files
  CheckpointUse checkpoints = CheckpointUse::none;      ///< in DIRECTORY/checkpoint
  bool pictures = true;                                 ///< in report.html
};

/// A length, or a place, as a key of the case file gives it.
struct GivenLength {
  std::string key, where;      ///< `where`: file and line
  std::vector<double> values;  ///< in the key's unit: one, or three of a place
  bool is_place = false;       ///< of any sign, and zero
  bool may_be_zero = false;
  double unit = 1;  ///< of the key, in the model's unit
};

struct Case {
  cad::DomainOptions domain;
  NarrowFaces narrow_faces = NarrowFaces::join;
  ChamberUse chambers = ChamberUse::refuse;
  SizingRequest sizing;
  surface::SurfaceOptions surface;
  LayerRequest layers;
  volume::VolumeOptions volume;
  improve::ImproveOptions improve;
  QualityGate gate;
  FaceGroups groups;
  std::vector<PatchRule> patches;  ///< the first matching rule holds, for faces in no group
  OutputOptions output;
  std::vector<GivenLength> lengths;  ///< as keys gave them, on the rank that has read the case file
  parallel::Sandbox sandbox = parallel::Sandbox::process;  ///< does not change results
  /// Most bytes for all ranks of this node; 0: no limit. Not a key: it does not change results.
  std::int64_t memory_limit = 0;
};

/// Reads a case and overrides "section.key=value"; the value is YAML, a later override wins. A relative
/// geometry.file is looked up beside the case file, then in the working directory. A file found in neither
/// place, or given by an override, keeps its path. Throws CaseError: unknown key (with the nearest one),
/// duplicate, wrong type, value out of range, contradiction, no geometry or two.
Case read_case(const std::string& file, const std::vector<std::string>& overrides);

/// Reads the output of resolved_yaml(), on ranks that do not read the file.
Case case_of_resolved(const std::string& yaml);

/// A case from overrides alone, for commands without geometry. Throws CaseError as read_case().
Case case_of_overrides(const std::vector<std::string>& overrides);

/// The case as YAML with every value written out. read_case() reads it back to the same case.
std::string resolved_yaml(const Case& input);

}  // namespace aeroloom::cases
