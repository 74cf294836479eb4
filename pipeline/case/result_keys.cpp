#include "io/file_formats.hpp"
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
              {"Smallest allowed dihedral angle, except where the CAD forces a smaller one.", "none", "5"});
  keys.number("largest_angle", gate.largest_angle, angle,
              {"Largest allowed dihedral angle, except where the CAD forces a larger one.", "none", "170"});
  const auto percentile = [&](const char* name, std::optional<double>& target, const char* text) {
    keys.number(name, target, angle, {text, "none", "15"});
  };
  percentile("percentile_01", gate.percentile_01,
             "The smallest angle may be below this in at most 0.1 % of the tetrahedra. If more are, "
             "improvement works once more with that angle as its target.");
  percentile("percentile_1", gate.percentile_1, "As `percentile_01`, for 1 % of the tetrahedra.");
  percentile("percentile_5", gate.percentile_5, "As `percentile_01`, for 5 % of the tetrahedra.");
  keys.number("min_mean_ratio", gate.min_mean_ratio, ratio,
              {"Least mean ratio of a tetrahedron.", "none", "0.1"});
  keys.number("mean_mean_ratio", gate.mean_mean_ratio, ratio,
              {"Least average of the mean ratio of all tetrahedra.", "none", "0.8"});
  keys.number("largest_volume_ratio", gate.largest_volume_ratio, Range::between(1, mesh::largest_ratio),
              {"Largest ratio of the volumes of two cells with a common face ([definitions](quality.md)).",
               "none", "20"});
  keys.number("largest_edge_ratio", gate.largest_edge_ratio, Range::between(1, mesh::largest_ratio),
              {"Largest ratio of the longest to the shortest edge of a cell.", "none", "20"});
  keys.number("min_scaled_jacobian", gate.min_scaled_jacobian, Range::between(-1, 1),
              {"Least scaled Jacobian of pyramids, prisms and hexahedra; it holds for meshes that have them.",
               "none", "0.1"});
  keys.number(
      "largest_non_orthogonality", gate.largest_non_orthogonality, Range::between(0, 180, "degrees"),
      {"Largest angle between the normal of a face and the line of the centres of its cells, as "
       "OpenFOAM's `checkMesh` measures it ([definitions](quality.md#as-cell-centred-solvers-judge)).",
       "none", "70"});
  keys.number("largest_skewness", gate.largest_skewness, Range::between(0, mesh::largest_ratio),
              {"Largest skewness of a face, as `checkMesh` measures it.", "none", "4"});
  keys.number("largest_aspect_ratio", gate.largest_aspect_ratio, Range::between(1, mesh::largest_ratio),
              {"Largest aspect ratio of a cell, as `checkMesh` measures it. Layers have hundreds and more.",
               "none", "1000"});
  keys.number("min_determinant", gate.min_determinant, Range::between(0, 1),
              {"Least determinant of a cell, as `checkMesh` measures it. A cell with fewer than three inner "
               "faces has 0.",
               "none", "0.001"});
  keys.number("area_deviation", gate.area_deviation, Range::between(0, 1),
              "Largest relative error of the area of all walls, and of the volume of a region without far "
              "field, against the CAD. More means that elements are too large for the body, or that the unit "
              "is wrong. For a region only a few of the smallest elements wide it is a warning.");
}

void declare_improve(KeyTable& keys, Case& result) {
  keys.flag("enabled", result.improve.enabled,
            "Whether the mesh is improved at all. Otherwise tetrahedra stay as the volume stage makes them.");
  keys.number(
      "target_angle", result.improve.target_angle, Range::above(0, 50, "degrees"),
      "Tetrahedra with a smaller dihedral angle, or one above 180 minus 1.5 times this, are improved.");
  keys.integer("sweeps", result.improve.sweeps, Range::between(0, 1000),
               "Largest number of sweeps. Improvement ends earlier when sweeps gain little.");
  keys.integer("relaxation", result.improve.relaxation, Range::between(0, 100),
               "Passes of smoothing for the average quality. 0: none, which saves a third of the time.");
  declare_gate(
      keys.section(
          "gate",
          "Limits for the mesh. If one is missed, the run ends with exit code 6 after writing the mesh."),
      result.gate);
}

void declare_files(KeyTable& keys, OutputOptions& output) {
  keys.path("directory", output.directory,
            common("Folder of all output, relative to the working directory. `${NAME}` in the path is an "
                   "environment variable."));
  std::vector<std::pair<std::string, io::FileFormat>> formats;
  for (const io::FormatRow& row : io::file_formats()) formats.emplace_back(row.name, row.format);
  keys.choices("formats", output.formats, formats,
               common("Formats in which the mesh is written ([Formats](formats.md))."));
  keys.integer("parts", output.parts, Range::between(0, 1e6),
               {"Number of parts in formats that have parts (`openfoam`, `msh_parts`, `vtkhdf`), whatever "
                "the number of ranks: that of the solver's ranks.",
                "what suits the size"});
  keys.flag("tasks", output.tasks,
            "Whether `tasks.csv` is written, the input of `aeroloom scaling --predict` "
            "([columns](usage.md#what-a-run-leaves-in-the-output-directory)).");
  keys.choice<io::Compression>(
      "compression", output.compression,
      {{"none", io::Compression::none}, {"lz4", io::Compression::lz4}, {"zlib", io::Compression::zlib}},
      "Compression of the arrays in `.vtu` and `.vtp` files: `none`, `lz4` (quick) or `zlib` (smaller).");
  keys.choice<CheckpointUse>(
      "checkpoints", output.checkpoints,
      {{"none", CheckpointUse::none}, {"write", CheckpointUse::write}, {"resume", CheckpointUse::resume}},
      common("`write`: results of the stages are kept in `checkpoint` in the output directory. `resume`: the "
             "run continues from there, on any number of ranks ([Checkpoints](checkpoints.md))."));
  keys.flag("pictures", output.pictures, "Whether `report.html` has pictures of the mesh.");
  keys.choice<parallel::LogLevel>("log", output.log,
                                  {{"quiet", parallel::LogLevel::quiet},
                                   {"normal", parallel::LogLevel::normal},
                                   {"verbose", parallel::LogLevel::verbose}},
                                  "How much is printed; `-q` and `-v` on the command line take precedence.");
}

}  // namespace

void declare_result_keys(KeyTable& root, Case& result) {
  declare_improve(root.section("improve", "How bad tetrahedra are improved."), result);
  declare_files(root.section("output", common("What is written, and where.")), result.output);
}

}  // namespace aeroloom::cases
