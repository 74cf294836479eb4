// What the command info tells of meshes, CAD and cases, and of what is none of these.
#include "tests/pipeline/command_line.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;

class InfoCommand : public CommandLine {
protected:
  Json facts(const std::string& file) const { return Json::parse(expect(0, "info --json " + file).out); }
};

/// What is not distributed is read by one rank for all.
class InfoCommandLocal : public InfoCommand {};

TEST_F(InfoCommand, OfAMeshTellsWhatItsReportTells) {
  write("case.yaml", coarse_wing());
  expect(0, "run case.yaml -q");
  const Json mesh = facts(CommandLine::mesh()), report = read_json("out/report.json")["mesh"];
  EXPECT_EQ(mesh, Json::parse(run_alone("info --json " + CommandLine::mesh()).out))
      << "it depends on the number of ranks";
  EXPECT_EQ(mesh["kind"], "mesh");
  EXPECT_GE(mesh["parts"], 1);
  EXPECT_EQ(mesh["tetrahedra"], report["tetrahedra"]);
  EXPECT_EQ(mesh["points"], report["points"]);
  std::map<std::string, std::string> types;
  std::int64_t triangles = 0;
  for (const Json& patch : mesh["patches"]) {
    types[patch["name"]] = patch["type"];
    triangles += patch["triangles"].get<std::int64_t>();
  }
  EXPECT_EQ(types, (std::map<std::string, std::string>{{"body", "wall"}, {"farfield", "farfield"}}));
  EXPECT_EQ(triangles, report["boundary_triangles"]);
  EXPECT_EQ(mesh["regions"], Json::array({{{"name", "fluid"}, {"cells", mesh["cells"]}}}));
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(mesh["bounds"][0][axis], -10);
    EXPECT_GT(mesh["bounds"][1][axis], 10);
  }
  expect(0, "info " + CommandLine::mesh(), {"tetrahedra " + mesh["tetrahedra"].dump(), "patch body"});
}

TEST_F(InfoCommandLocal, OfCadTellsUnitSolidsAndNames) {
  write("case.yaml", coarse_transport());
  expect(0, "export-cad case.yaml wing.step -q");
  const Json cad = facts(path("wing.step"));
  EXPECT_EQ(cad["kind"], "cad");
  EXPECT_EQ(cad["format"], "STEP");
  EXPECT_EQ(cad["unit"], "m");
  EXPECT_EQ(cad["solids"], 1);
  EXPECT_EQ(cad["shells"], 1);
  EXPECT_EQ(cad["bounds"], cad["bounds_in_metres"]);
  EXPECT_NEAR(cad["bounds"][1][0].get<double>(), 37.6, 1e-6);
  const Json& names = cad["face_names"];
  EXPECT_EQ(std::count(names.begin(), names.end(), Json({{"name", "fuselage"}, {"faces", 12}})), 1) << names;
  EXPECT_EQ(cad["parts"][0]["name"], "transport");

  std::string millimetres = read("wing.step");
  const std::string metres = "SI_UNIT($,.METRE.)";
  for (std::size_t at; (at = millimetres.find(metres)) != std::string::npos;)
    millimetres.replace(at, metres.size(), "SI_UNIT(.MILLI.,.METRE.)");
  const Json small = facts(write("small.step", millimetres));
  EXPECT_EQ(small["unit"], "mm");
  const double bound = small["bounds"][1][0], in_metres = small["bounds_in_metres"][1][0];
  EXPECT_NEAR(bound / in_metres, 1000, 1e-9);
}

TEST_F(InfoCommandLocal, OfACaseSpellsOutItsValues) {
  write("case.yaml", coarse_transport());
  const Json told = facts("case.yaml");
  EXPECT_EQ(told["kind"], "case");
  EXPECT_NE(told["configuration"].get<std::string>().find("growth: 1.8"), std::string::npos);
}

TEST_F(InfoCommand, OfOtherFilesSaysWhatIsWrong) {
  write("wrong.yaml", "geometry: {fil: a.step}\n");
  write("broken.vtu", "<VTKFile");
  write("out/report.json", "{}\n");
  struct Wrong {
    const char* file;
    int code;
    const char* word;
  };
  for (const Wrong& wrong : {Wrong{"nowhere.step", 7, "nowhere.step"}, Wrong{"out", 3, "is a folder"},
                             Wrong{"out/report.json", 3, "neither STEP"}, Wrong{"mesh.cgns", 7, "not read"},
                             Wrong{"wrong.yaml", 2, "'file'"}, Wrong{"broken.vtu", 3, "broken.vtu"}}) {
    const CommandResult ended = expect(wrong.code, "info " + path(wrong.file));
    EXPECT_NE(ended.err.find(wrong.word), std::string::npos) << wrong.file << ": " << ended;
    EXPECT_EQ(ended.out, "") << wrong.file;
  }
}

// A face is called by its number in the file, whatever is cut off before it is meshed; info and check say
// where it is.
TEST_F(InfoCommandLocal, FacesKeepTheirNamesWhereAPlaneCuts) {
  const std::string file = (source_tree() / "tests" / "data" / "bracket.igs").string();
  const Json told = facts(file);
  std::map<std::string, Json> by_name;
  for (const Json& face : told["face_table"]) by_name[face["name"]] = face;
  EXPECT_EQ(by_name.size(), told["faces"].get<std::size_t>());
  EXPECT_TRUE(by_name.contains("face_0"));
  expect(0, "info " + file, {"centre", "face_0"});

  const Json low = told["bounds"][0], high = told["bounds"][1];
  const double middle = 0.5 * (low[1].get<double>() + high[1].get<double>());
  double slack = 0;
  for (int k = 0; k < 3; ++k)
    slack = std::max(slack, 1e-6 * std::abs(high[k].get<double>() - low[k].get<double>()));
  std::map<std::string, std::map<std::string, Json>> seen;
  for (const std::string symmetry : {"none", "y"}) {
    const std::string position = symmetry == "y" ? ", symmetry_position: " + Json(middle).dump() : "";
    write("cut.yaml",
          "geometry: {file: \"" + file + "\"}\nfarfield: {shape: box, extent: 3, symmetry: " + symmetry +
              position +
              "}\nsizing: {minimum: 10, maximum: 100, growth: 2.5, curvature_angle: 90, proximity: 0}\n");
    expect(0, "check cut.yaml");
    const Json checked = read_json("out/check.json");
    for (const Json& row : checked["domain"]["faces"])
      if (row["name"].get<std::string>().starts_with("face_")) seen[symmetry][row["name"]] = row;
  }
  EXPECT_EQ(seen["none"].size(), by_name.size());
  EXPECT_GE(seen["y"].size(), 3u);
  int whole = 0;
  for (const auto& [name, row] : seen["y"]) {
    const Json& uncut = by_name.at(name);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(uncut["box"][0][k].get<double>() - slack, row["box"][0][k].get<double>()) << name;
      EXPECT_GE(uncut["box"][1][k].get<double>() + slack, row["box"][1][k].get<double>()) << name;
    }
    whole += std::abs(row["area"].get<double>() / uncut["area"].get<double>() - 1) < 1e-3 ? 1 : 0;
  }
  EXPECT_GE(whole, 1) << "no face lies on one side";
}

}  // namespace
}  // namespace aeroloom::pipeline
