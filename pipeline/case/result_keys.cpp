#include "mesh/quality/cell_measures.hpp"
#include "pipeline/case/case_keys.hpp"

#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cases {

namespace {

void declare_gate(KeyTable& keys, QualityGate& gate) {
  const Range angle = Range::between(0, 180, "degrees"), ratio = Range::between(0, 1);
  keys.number("smallest_angle", gate.smallest_angle, angle,
              {"No dihedral angle may be smaller, but where the CAD forces it.", "none", "5"});
  keys.number("largest_angle", gate.largest_angle, angle,
              {"No dihedral angle may be larger, but where the CAD forces it.", "none", "170"});
  const auto percentile = [&](const char* name, std::optional<double>& target, const char* text) {
    keys.number(name, target, angle, {text, "none", "15"});
  };
  percentile("percentile_01", gate.percentile_01,
             "The smallest angle of 0.1 % of the tetrahedra may be below this, of no more. Where more are, "
             "improvement works once more with that angle as its target.");
  percentile("percentile_1", gate.percentile_1, "As `percentile_01`, for 1 % of the tetrahedra.");
  percentile("percentile_5", gate.percentile_5, "As `percentile_01`, for 5 % of the tetrahedra.");
  keys.number("min_mean_ratio", gate.min_mean_ratio, ratio,
              {"Mean ratio of the worst tetrahedron, at least.", "none", "0.1"});
  keys.number("mean_mean_ratio", gate.mean_mean_ratio, ratio,
              {"Mean ratio of all tetrahedra on average, at least.", "none", "0.8"});
  keys.number("largest_volume_ratio", gate.largest_volume_ratio, Range::between(1, mesh::largest_ratio),
              {"The volume of no cell may be more than so many times that of a neighbour at a face "
               "([definitions](quality.md)).",
               "none", "20"});
  keys.number("largest_edge_ratio", gate.largest_edge_ratio, Range::between(1, mesh::largest_ratio),
              {"No cell may have a longest edge of more than so many times its shortest.", "none", "20"});
  keys.number("min_scaled_jacobian", gate.min_scaled_jacobian, Range::between(-1, 1),
              {"Scaled Jacobian of pyramids and prisms, at least; without any there is nothing to miss.",
               "none", "0.1"});
  keys.number("area_deviation", gate.area_deviation, Range::between(0, 1),
              "By which share the area of all walls, and the volume of a region without far field, may miss "
              "that of the CAD: more means that elements are too large for the body, or the unit is "
              "another. Of a region that is a few of the smallest elements wide it is a warning.");
}

void declare_improve(KeyTable& keys, Case& result) {
  keys.flag(
      "enabled", result.improve.enabled,
      "Whether the mesh is improved at all. Without it tetrahedra stay as the volume stage makes them.");
  keys.number("target_angle", result.improve.target_angle, Range::above(0, 50, "degrees"),
              "Tetrahedra with a smaller dihedral angle, or a larger one than 180 minus 1.5 times this, are "
              "worked on.");
  keys.integer("sweeps", result.improve.sweeps, Range::between(0, 1000),
               "How many sweeps there are, at most; it ends earlier when they gain little.");
  keys.integer("relaxation", result.improve.relaxation, Range::between(0, 100),
               "Passes of smoothing for the average; 0: none, which saves a third of the time.");
  declare_gate(
      keys.section("gate",
                   "Limits that the mesh has to meet. Where one is missed the run ends with exit code "
                   "6, the mesh written."),
      result.gate);
}

void declare_files(KeyTable& keys, OutputOptions& output) {
  keys.path("directory", output.directory,
            common("Where everything is written, relative to the working directory. `${NAME}` in the path is "
                   "an environment variable."));
  std::vector<std::pair<std::string, io::FileFormat>> formats;
  formats.reserve(io::format_names.size());
  for (const io::FormatName& format : io::format_names) formats.emplace_back(format.name, format.format);
  keys.choices("formats", output.formats, formats,
               common("List of formats that the mesh is written in ([Formats](formats.md))."));
  keys.integer("parts", output.parts, Range::between(0, 1e6),
               {"Parts of the formats that come in parts (`openfoam`, `msh_parts`, `vtkhdf`), whatever the "
                "number of ranks: as many as the solver shall have.",
                "what suits the size"});
  keys.flag(
      "tasks", output.tasks,
      "Whether `tasks.csv` is written: a row for each task with its rank, stage, kind, number, the load "
      "it was scheduled by, CPU seconds, bytes of what it made, peak memory of its child, its round within "
      "the stage and what it "
      "counts for when further tasks are scheduled: what `aeroloom scaling --predict` goes by.");
  keys.choice<io::Compression>(
      "compression", output.compression,
      {{"none", io::Compression::none}, {"lz4", io::Compression::lz4}, {"zlib", io::Compression::zlib}},
      "Of the arrays of `.vtu` and `.vtp` files: `none`, `lz4` (quick) or `zlib` (smaller).");
  keys.choice<CheckpointUse>(
      "checkpoints", output.checkpoints,
      {{"none", CheckpointUse::none}, {"write", CheckpointUse::write}, {"resume", CheckpointUse::resume}},
      common("`write`: what each stage has made is kept in `checkpoint` in the output "
             "directory. `resume`: a run goes on from there, on any number of ranks, and "
             "keeps the rest."));
  keys.flag("pictures", output.pictures, "Whether `report.html` has pictures of the mesh.");
  keys.choice<parallel::LogLevel>("log", output.log,
                                  {{"quiet", parallel::LogLevel::quiet},
                                   {"normal", parallel::LogLevel::normal},
                                   {"verbose", parallel::LogLevel::verbose}},
                                  "How much is printed; `-q` and `-v` on the command line win.");
}

}  // namespace

void declare_result_keys(KeyTable& root, Case& result) {
  declare_improve(root.section("improve", "How hard bad tetrahedra are worked on."), result);
  declare_files(root.section("output", common("What is written, and where.")), result.output);
}

}  // namespace aeroloom::cases
