// The command check: what it says of a case, how it ends, and that a run does what it predicts.
#include "tests/cad/real_files.hpp"
#include "tests/pipeline/command_line.hpp"
#include "tests/references.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Solid.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;

/// Checks a case; the record, with all that was said as `text`.
class CheckCommand : public CommandLine {
protected:
  Json check(int code, const std::string& text, const std::vector<std::string>& words = {}) {
    write("case.yaml", text);
    said = expect(code, "check case.yaml", words).text();
    return read_json("out/check.json");
  }
  std::string said;
};
using CheckCommandLocal = CheckCommand;

double tetrahedra_of_layers(const Json& report) {
  double sum = 0;
  for (const Json& row : report["layers"]["patches"]) sum += row["tetrahedra"].get<double>();
  return sum;
}

std::set<std::string> names_of(const Json& rows) {
  std::set<std::string> names;
  for (const Json& row : rows) names.insert(row["name"]);
  return names;
}

// The first mesh that anyone makes is a good example: nothing is left to act on.
TEST_F(CheckCommand, PredictsTheSameOfTheDemoOnAnyNumberOfRanks) {
  const std::string demo = "check " + (source_tree() / "configs/transport.yaml").string();
  const CommandResult ended = expect(0, demo + " --set output.directory=out", {"a volume can be meshed"});
  EXPECT_FALSE(ended.has("bounds:")) << ended;
  EXPECT_EQ(ended.err, "");
  const Json record = read_json("out/check.json");
  EXPECT_TRUE(record["meshable"].get<bool>());
  EXPECT_EQ(record["read"]["solids"], 1);
  EXPECT_EQ(record["read"]["open_edges"], 0);
  const std::set<std::string> patches = names_of(record["domain"]["patches"]);
  EXPECT_TRUE(patches.contains("fuselage") && patches.contains("farfield"));
  const Json& forecast = record["forecast"];
  const double tetrahedra = forecast["tetrahedra"];
  const std::string here = fmt::format("{} {}", tetrahedra, forecast["piece_tets"].get<std::int64_t>());
  if (!world.is_root()) return;
  const std::string alone = references::of_one_rank(world, here, [&] {
    run_here(demo + " --set output.directory=alone");
    const Json other = read_json("alone/check.json")["forecast"];
    return fmt::format("{} {}", other["tetrahedra"].get<double>(), other["piece_tets"].get<std::int64_t>());
  });
  const std::size_t blank = alone.find(' ');
  EXPECT_EQ(alone.substr(0, blank), here.substr(0, here.find(' ')));
  EXPECT_GE(std::stoll(alone.substr(blank)), forecast["piece_tets"].get<std::int64_t>());
}

// What becomes of thin trailing edges is the same in `check` and in a run.
TEST_F(CheckCommandLocal, PredictsWhatARunDoesToTrailingEdges) {
  const Json record =
      check(0,
            "geometry:\n  builtin: transport\n"
            "  dimensions: {wing: {trailing_edge: 0.0003}, horizontal_tail: {trailing_edge: 0.003}}\n"
            "farfield: {shape: cylinder, extent: 1}\n"
            "sizing: {target_tetrahedra: 20000, growth: 2, feature_budget: 2}\n"
            "improve: {enabled: false}\noutput: {pictures: false}\n");
  const Json edges = record["forecast"]["trailing_edges"];
  std::map<std::string, std::string> fates;
  for (const Json& edge : edges) {
    fates[edge["face"]] = edge["fate"];
    if (edge["fate"] != "kept") {
      EXPECT_NE(said.find(edge["what"].get<std::string>()), std::string::npos) << edge;
    }
  }
  EXPECT_EQ(fates["wing_left_trailing_edge"], "closed");
  EXPECT_EQ(fates["wing_right_trailing_edge"], "closed");
  EXPECT_EQ(fates["horizontal_tail_left_trailing_edge"], "graded");
  expect(0, "run case.yaml -q");
  const Json report = read_json("out/report.json");
  std::map<std::string, std::string> made;
  for (const Json& edge : report["sizing"]["trailing_edges"]) made[edge["face"]] = edge["fate"];
  EXPECT_EQ(made, fates);  // a run may choose sizes once more, so that aspects are others
  EXPECT_FALSE(names_of(report["patches"]).contains("wing_left_trailing_edge"));
}

TEST_F(CheckCommandLocal, TellsOfEdgesThatAreClosedOnRequest) {
  const std::string begin = "geometry: {builtin: transport, trailing_edges: sharpen, sharpen_faces: [",
                    end =
                        "]}\nsizing: {minimum: 0.5, feature_minimum: 0.5, maximum: 20, surface_maximum: 4, "
                        "growth: 1.8, proximity: 0}\n";
  const Json record = check(0, begin + "'wing*'" + end);
  int closed = 0;
  for (const Json& change : record["domain"]["changes"]) {
    const std::string what = change["what"];
    if (what.find("was closed to a curve") == std::string::npos) continue;
    ++closed;
    EXPECT_GT(change["how_much"].get<double>(), 0.03);
    EXPECT_LT(change["how_much"].get<double>(), 0.06);
    EXPECT_NE(said.find(what), std::string::npos) << what;
  }
  EXPECT_EQ(closed, 2);
  const std::set<std::string> patches = names_of(record["domain"]["patches"]);
  EXPECT_FALSE(patches.contains("wing_left_trailing_edge"));
  EXPECT_TRUE(patches.contains("vertical_tail_trailing_edge"));
}

// Before hours of meshing, and for every format whose solvers expect metres.
TEST_F(CheckCommandLocal, TellsOfLengthsThatSolversTakeForMetres) {
  const std::string line =
      "check /dev/null --set geometry.file=" + (source_tree() / "tests/data/bracket.igs").string() +
      " --set geometry.domain=fluid --set output.directory=out --set sizing.target_tetrahedra=4000 "
      "--set output.formats=";
  EXPECT_FALSE(expect(0, line + "[vtu,msh]").has("for metres"));
  expect(0, line + "[su2,cgns]", {"lengths stay in mm, and solvers take those of su2, cgns for metres"});
}

// What layers would be: y+ in both meanings, as many as sizes ask, and how much of them a duct has no room
// for.
TEST_F(CheckCommandLocal, TellsOfLayersAndOfRoomForThem) {
  const Json record =
      check(0,
            fmt::format("geometry: {{file: '{}/configs/geometry/duct.step', domain: fluid}}\n"
                        "patches: {{inlet: {{faces: ['#ff0000'], type: inlet}}, outlet: {{type: outlet}}}}\n"
                        "sizing: {{target_tetrahedra: 4000, solver: cell}}\n"
                        "layers: {{y_plus: 1.5, reynolds: 1e5, length: 1, growth: 1.2}}\n",
                        source_tree().string()),
            {"y+ 3 at its node, 1.5 at its centre", "no room for that on", "layers add: about"});
  const Json layers = record["forecast"]["layers"];
  // Layers take the place of half of the tetrahedra.
  expect(0, "run case.yaml --set improve.enabled=false --set output.pictures=false");
  const Json made = read_json("out/report.json");
  const double off_layers = made["mesh"]["tetrahedra"].get<double>() - tetrahedra_of_layers(made);
  EXPECT_NEAR(record["forecast"]["tetrahedra"].get<double>() / off_layers, 1, 0.4);
  EXPECT_LT(off_layers, 0.6 * 4000);
  double cells = 0;
  int narrow = 0;
  for (const Json& row : layers["patches"]) {
    cells += row["cells"].get<double>();
    EXPECT_NEAR(row["y_plus_node"].get<double>(), 3, 1e-9);
    EXPECT_NEAR(row["y_plus_centre"].get<double>(), 1.5, 1e-9);
    EXPECT_EQ(row["growth"], 1.2);
    EXPECT_LT(1, row["layers_min"].get<double>());
    EXPECT_LE(row["layers_min"].get<double>(), row["layers_max"].get<double>());
    EXPECT_LT(row["first"].get<double>(), row["total_min"].get<double>());
    EXPECT_LE(row["total_min"].get<double>(), row["total_max"].get<double>());
    if (row["lacking"].get<double>() <= 0) continue;
    ++narrow;
    EXPECT_LT(row["narrowest_gap"].get<double>(),
              2.6 * row["total_max"].get<double>() + record["forecast"]["maximum"].get<double>());
  }
  EXPECT_GT(narrow, 0);
  EXPECT_NEAR(layers["cells"].get<double>(), cells, 1e-9 * cells);
  EXPECT_GT(cells, 1000);
}

// Sectors over sharp edges are a fifth of the cells here.
TEST_F(CheckCommandLocal, CountsFansOfSharpEdges) {
  const std::string layered = fmt::format(
      "geometry: {{file: '{}/configs/geometry/wing.step'}}\n"
      "farfield: {{shape: box, extent: 3}}\n"
      "sizing: {{target_tetrahedra: 20000, solver: cell}}\n"
      "layers:\n  first: 1e-4\n  count: 10\n",
      source_tree().string());
  const double with_fans = check(0, layered)["forecast"]["layers"]["cells"];
  expect(0, "run case.yaml --set improve.enabled=false --set output.pictures=false");
  double made = 0;
  const Json rows = read_json("out/report.json")["layers"]["patches"];
  for (const Json& row : rows) {
    for (const char* cells : {"prisms", "hexahedra", "pyramids", "tetrahedra"})
      made += row[cells].get<double>();
  }
  EXPECT_NEAR(with_fans / made, 1, 0.15);
  EXPECT_GT(with_fans,
            1.15 * check(0, layered + "  fans: none\n")["forecast"]["layers"]["cells"].get<double>());
}

// As a run, which has edges for sizes.
TEST_F(CheckCommandLocal, FitsLayersThatTheirCountEndsEarly) {
  const std::string layered = coarse_duct() + "layers: {first: 1e-3, growth: 1.1, count: 30}\n";
  check(0, layered, {"30 layers end at", "are needed"});
  const CommandResult fitted =
      expect(0, "check case.yaml --set layers.fit=growth", {"by layers.fit: growth"});
  EXPECT_FALSE(fitted.has("layers end at")) << fitted;
  for (const Json& row : read_json("out/check.json")["forecast"]["layers"]["patches"]) {
    EXPECT_GT(row["growth"], 1.1);
    EXPECT_EQ(row["layers_max"], 30);
  }
}

// Layers too: half as high at first, twice as many, as high together.
TEST_F(CheckCommandLocal, TellsOfAFamilyWhatEachOfItsCasesSays) {
  const std::string layered = coarse_duct() + "layers: {first: 0.004, growth: 1.44, count: 4}\n";
  const Json record = check(0, layered);
  EXPECT_TRUE(record["forecast"]["family"].empty());
  const CommandResult table =
      expect(0, "check case.yaml --levels 3 --ratio 2", {"family: sizing.scale", " 0.25 "});
  const Json family = read_json("out/check.json")["forecast"]["family"];
  ASSERT_EQ(family.size(), 3u) << table;
  EXPECT_EQ(family[0]["scale"], 1);
  EXPECT_EQ(family[0]["tetrahedra"], record["forecast"]["tetrahedra"]);
  for (const auto& [level, scale] : {std::pair(1, "0.5"), std::pair(2, "0.25")}) {
    expect(0, std::string("check case.yaml --set sizing.scale=") + scale,
           {std::string("all sizes times ") + scale});
    const Json forecast = read_json("out/check.json")["forecast"];
    for (const char* const number : {"tetrahedra", "triangles", "minimum", "maximum", "bytes"})
      EXPECT_NEAR(family[level][number].get<double>() / forecast[number].get<double>(), 1, 1e-9) << number;
    EXPECT_NEAR(family[level]["layer_cells"].get<double>() / forecast["layers"]["cells"].get<double>(), 1,
                1e-9);
    EXPECT_NEAR(family[level]["layer_first"].get<double>() * (1 << level), 0.004, 1e-12);
    EXPECT_NEAR(family[level]["layer_total"].get<double>() / family[0]["layer_total"].get<double>(), 1, 0.25);
  }
  expect(2, "check case.yaml --levels 3 --ratio 1", {"--ratio is 1", "Remedy"});
  expect(2, "check case.yaml --levels 10 --ratio 3", {"fewer levels"});
  expect(2, "check case.yaml --levels 3 --ratio 0.4", {"'layers.growth'", "to that power"});
  expect(2, "check case.yaml --ratio 2", {"--levels"});
}

TEST_F(CheckCommandLocal, ARunHasTheScaleOfItsCase) {
  write("case.yaml", coarse_duct());
  std::map<std::string, double> cells;
  for (const std::string scale : {"1", "1.5"}) {
    expect(0, "run case.yaml --set sizing.scale=" + scale + " --set output.directory=out_" + scale);
    cells[scale] = read_json("out_" + scale + "/report.json")["mesh"]["tetrahedra"];
  }
  EXPECT_LT(cells["1.5"], 0.6 * cells["1"]);
}

// The walls of a bent duct lie on its box but for two.
TEST_F(CheckCommandLocal, SeesWallsOfADuctAsARunDoes) {
  const TopoDS_Shape bend = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 4, 4, 1).Shape(),
                                            BRepPrimAPI_MakeBox(gp_Pnt(1, 1, -1), 4, 4, 3).Shape());
  BRepTools::Write(bend, path("bend.brep").c_str());
  constexpr double target = 15000;
  const Json forecast =
      check(0,
            "geometry: {file: " + path("bend.brep") +
                ", domain: fluid}\nsizing: {target_tetrahedra: 15000}\nimprove: {enabled: false}\n"
                "output: {pictures: false}\n",
            {"far field: none, all faces are sized as walls"})["forecast"];
  EXPECT_NEAR(forecast["tetrahedra"].get<double>(), target, 0.25 * target);
  expect(0, "run case.yaml", {"far field: none"});
  const Json report = read_json("out/report.json");
  EXPECT_EQ(report["sizing"]["far_field"], forecast["far_field"]);
  EXPECT_NEAR(report["mesh"]["tetrahedra"].get<double>(), target, 0.35 * target);
  double fewest = 1e300, most = 0;
  for (const Json& face : report["faces"]) {
    const double density = face["triangles"].get<double>() / face["area"].get<double>();
    fewest = std::min(fewest, density), most = std::max(most, density);
  }
  EXPECT_LT(most, 1.6 * fewest) << "walls are even";
}

// An inlet and an outlet at the ends tell a duct from a body, by layer, colour, side or usual name.
TEST_F(CheckCommandLocal, TakesADuctWithInletAndOutletForTheFluid) {
  const auto kind_of = [&](const std::string& geometry, const std::string& patches) {
    return check(0, fmt::format("geometry: {{file: '{}'{}}}\nsizing: {{target_tetrahedra: 4000}}\n{}",
                                (source_tree() / "configs/geometry/duct.step").string(), geometry,
                                patches))["domain"]["kind"]
        .get<std::string>();
  };
  const std::string ends = "patches: {in: {faces: ['#ff0000'], type: inlet}, outlet: {type: outlet}}\n";
  EXPECT_EQ(kind_of("", ends), "fluid");
  EXPECT_NE(said.find("are an inlet and an outlet on the hull"), std::string::npos) << said;
  EXPECT_EQ(kind_of("", "groups: {in: {faces: '#ff0000', type: inlet}}\n"), "fluid");
  EXPECT_EQ(kind_of("", "groups: {in: {box: [[-1, -1, -1], [0.1, 3, 2]], type: inlet}}\n"), "body");
  EXPECT_NE(said.find("inlet and outlet of a body in a far field"), std::string::npos) << said;
  EXPECT_EQ(kind_of("", "groups: {in: {faces: '*', box: [[-1, -1, -1], [0.1, 3, 2]], type: inlet}}\n"),
            "body");
  EXPECT_EQ(kind_of("", ""), "body") << "an outlet alone may be an engine's";
  EXPECT_EQ(kind_of(", domain: body", "patches: {in: {faces: ['#ff0000'], type: inlet}}\n"), "body");
}

// A ball that is cut out of a cube touches a side from inside.
TEST_F(CheckCommandLocal, PointsToWhereFacesTouch) {
  TopoDS_Solid cube = BRepPrimAPI_MakeBox(1, 1, 1);
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Ax2({0.3, 0.4, 0.25}, {0, 0, -1}), 0.25);
  BRep_Builder().Add(cube, TopExp_Explorer(ball, TopAbs_SHELL).Current().Reversed());
  BRepTools::Write(cube, path("tangent.brep").c_str());
  const Json contacts = check(0, "geometry: {file: " + path("tangent.brep") +
                                     ", domain: fluid}\nsizing: {target_tetrahedra: 20000}\n")["contacts"];
  ASSERT_EQ(contacts.size(), 1u);
  const Json where = contacts[0]["where"];
  EXPECT_NEAR(where[0].get<double>(), 0.3, 1e-3);
  EXPECT_NEAR(where[1].get<double>(), 0.4, 1e-3);
  EXPECT_NEAR(where[2].get<double>(), 0, 1e-3);
}

TEST_F(CheckCommand, PointsToWhatIsOpen) {
  const Json record =
      check(3, fmt::format("geometry: {{file: '{}/tests/data/open_shell.step'}}\n", source_tree().string()),
            {"no volume can be meshed", "an open edge of length"});
  EXPECT_FALSE(record["meshable"].get<bool>());
  EXPECT_GT(record["read"]["open_edges"], 0);
  ASSERT_FALSE(record["findings"].empty());
  for (const Json& finding : record["findings"]) EXPECT_EQ(finding["where"].size(), 3u);
  EXPECT_FALSE(record.contains("forecast"));
  EXPECT_NE(record["failure"].get<std::string>().find("open_shell.step"), std::string::npos);
}

TEST_F(CheckCommand, CountsTheEdgesOfARealOpenShell) {
  const std::string name = "parts/gmsh_capot.brep";
  if (!cad::real::has(name)) GTEST_SKIP() << "no real geometry here";
  const Json record =
      check(3, "geometry: {file: " + std::filesystem::canonical(cad::real::file(name)).string() + "}\n",
            {"no volume can be meshed", "an open edge of length"});
  EXPECT_FALSE(record["meshable"].get<bool>());
  EXPECT_EQ(record["read"]["open_edges"], 22);
  EXPECT_EQ(record["read"]["faces"], 18);
  for (const Json& finding : record["findings"]) EXPECT_EQ(finding["where"].size(), 3u);
  EXPECT_FALSE(record.contains("forecast"));
  EXPECT_NE(record["failure"].get<std::string>().find("gmsh_capot.brep"), std::string::npos);
}

// Ids, groups, layers and colours of faces.
TEST_F(CheckCommandLocal, TellsWhoIsInWhichGroup) {
  write("case.yaml", groups_case() + "  pictures: false\n");
  expect(0, "check case.yaml --set output.directory=look");
  const std::map<std::string, std::set<int>> groups = {
      {"inlet", {0}}, {"outlet", {5, 9}}, {"branch", {7, 8}}, {"top", {2}}, {"walls", {1, 3, 4, 6}}};
  const Json rows = read_json("look/check.json")["domain"]["faces"];
  ASSERT_EQ(rows.size(), 10u);
  std::set<int> ids;
  for (const Json& row : rows) {
    ids.insert(row["id"].get<int>());
    EXPECT_TRUE(groups.at(row["group"]).contains(row["id"].get<int>())) << row;
  }
  EXPECT_EQ(ids.size(), 10u);
  EXPECT_EQ(rows[0]["colour"], "#ff0000");
  EXPECT_EQ(rows[5]["layer"], "outlet");
}

}  // namespace
}  // namespace aeroloom::pipeline
