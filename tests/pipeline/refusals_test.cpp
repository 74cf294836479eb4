// Bad input ends on all ranks within seconds, with its exit code and a message that says what is wrong.
#include "tests/pipeline/command_line.hpp"
#include "tests/scoped_fault.hpp"
#include "tests/source_tree.hpp"

#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;

/// Seconds within which a message must be there.
constexpr double soon = 60;

struct Refusal {
  std::string setting;  ///< SECTION.KEY=VALUE
  std::vector<std::string> words;
};

class Refusals : public CommandLine {
protected:
  /// A run that ends with the code, the words, and a report that says the same; one that cannot read its case
  /// has no report.
  void expect_failure(int code, const std::string& line, const std::vector<std::string>& words) const {
    const CommandResult ended = expect(code, line, words);
    EXPECT_LT(ended.seconds, soon) << line;
    if (code == 2) return;
    const Json report = read_json("out/report.json");
    EXPECT_EQ(report["status"], "failed") << line;
    EXPECT_EQ(report["exit_code"], code) << line;
  }
  void expect_all(int code, const std::string& command, const std::vector<Refusal>& refusals) const {
    for (const Refusal& refusal : refusals) {
      std::vector<std::string> words{command, "case.yaml", "--set", refusal.setting};
      const CommandResult ended = run(words);
      EXPECT_EQ(ended.code, code) << refusal.setting << ": " << ended;
      for (const std::string& word : refusal.words)
        EXPECT_TRUE(ended.has(word)) << refusal.setting << ": '" << word << "': " << ended;
    }
  }
};

std::string file_case(const std::string& file) {
  return fmt::format("geometry: {{file: {}}}\nsizing: {{minimum: 1, maximum: 100}}\n", file);
}

TEST_F(Refusals, OfFilesThatAreNoModel) {
  const std::string corrupt =
      write("corrupt.step",
            "ISO-10303-21;\nHEADER;FILE_DESCRIPTION((''),'2;1');FILE_NAME('','',(''),(''),'','',"
            "'');FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;\nDATA;\n#1=ADVANCED_FACE('',(#2,#3),"
            "#4,.T.);\n#2=FACE_BOUND(\n");
  write("case.yaml", file_case(corrupt));
  expect_failure(3, "run case.yaml", {"corrupt.step"});
  write("case.yaml", file_case(write("empty.step", "")));
  expect_failure(3, "run case.yaml", {"empty.step"});
  write("case.yaml", file_case(path("absent.step")));
  expect_failure(7, "run case.yaml", {"absent.step"});
  expect_failure(7, "check case.yaml", {"absent.step"});
  EXPECT_FALSE(exists("out/check.json"));
  write("case.yaml", file_case((source_tree() / "tests/data/open_shell.step").string()));
  expect_failure(3, "run case.yaml", {"open"});
}

TEST_F(Refusals, OfPipesAndDevices) {
  write("case.yaml", coarse_wing());
  at_root([&] { EXPECT_EQ(mkfifo(path("pipe.step").c_str(), 0600), 0); });
  for (const std::string& file : {path("pipe.step"), std::string("/dev/zero")})
    for (const std::string command : {"check", "run"})
      expect(7, command + " case.yaml --set geometry.file=" + file, {"a device or a pipe"});
}

TEST_F(Refusals, OfPipesWhereverAFileIsRead) {
  write("case.yaml", coarse_wing());
  const std::string poly = write("cube.poly", "0 3 0 0\n1 0\n1\n3 1 2 3\n0\n");
  at_root([&] {
    for (const char* name : {"pipe.yaml", "pipe.stl", "pipe.brep", "cube.node", "pipe.vtkhdf", "pipe.vtu",
                             "pipe.msh", "pipe.su2", "pipe.meshb", "pipe.lb8.ugrid", "pipe.json"})
      EXPECT_EQ(mkfifo(path(name).c_str(), 0600), 0);
  });
  const std::string why = "a device or a pipe, which cannot be read twice. Remedy";
  for (const std::string command : {"check", "run"}) {
    expect(2, command + " pipe.yaml", {"pipe.yaml", why});
    expect(2, command + " /dev/zero", {"/dev/zero", why});
    for (const std::string& file : {path("pipe.stl"), path("pipe.brep")})
      expect(7, command + " case.yaml --set geometry.file=" + file, {file, why});
    expect(7, command + " case.yaml --set geometry.file=" + poly, {"cube.node", why});
  }
  for (const std::string end : {"vtkhdf", "vtu", "msh", "su2", "meshb", "lb8.ugrid"}) {
    expect(7, "info " + path("pipe." + end), {"pipe." + end, why});
    expect(7, "quality " + path("pipe." + end), {"pipe." + end, why});
  }
  if (world.size() == 1) expect(7, "scaling out --predict 8 --network pipe.json", {"pipe.json", why});
}

TEST_F(Refusals, OfKeysAndSizesThatCannotBe) {
  write("case.yaml", coarse_wing() + "sizng: {minimum: 1}\n");
  expect_failure(2, "run case.yaml", {"sizng", "sizing", "case.yaml:6:"});
  write("case.yaml", coarse_wing());
  expect_failure(2, "run case.yaml --set sizing.minimum=0", {"sizing.minimum"});
  expect_failure(2, "run case.yaml --set sizing.growth=1.0000000001", {"sizing.growth"});
  const std::string tiny =
      " case.yaml --set sizing.minimum=1e-6 --set sizing.maximum=1e-6 "
      "--set sizing.surface_maximum=1e-6 --set sizing.feature_minimum=1e-6";
  const std::string huge =
      " case.yaml --set sizing.minimum=50 --set sizing.maximum=100 --set sizing.surface_maximum=60";
  for (const std::string command : {"check", "run"}) {
    expect(2, command + tiny, {"triangles", "Remedy"});
    expect(2, command + huge, {"but the body is only"});
  }
}

// No work begins with them: some would never end.
TEST_F(Refusals, OfLengthsThatAreNoneOfTheModel) {
  write("case.yaml", coarse_duct());
  for (const std::string command : {"check", "run"}) {
    expect(2, command + " case.yaml --set sizing.minimum=1e-180 --set sizing.maximum=1e-180",
           {"--set", "'sizing.minimum' is 1e-180,", "at least"});
    expect(2, command + " case.yaml --set sizing.reference_length=1e-300",
           {"'sizing.reference_length' is 1e-300", "times that"});
  }
  write("case.yaml", coarse_duct() + "patches:\n  body:\n    size: 1e-180\n");
  expect(2, "run case.yaml", {"case.yaml:7:", "'patches.body.size' is 1e-180,"});
}

TEST_F(Refusals, OfAFarFieldThatCutsTheBody) {
  write("case.yaml", coarse_wing());
  expect_failure(3, "run case.yaml --set farfield.extent=0.4", {"far field"});
}

TEST_F(Refusals, OfFoldersThatCannotBeWritten) {
  write("case.yaml", coarse_wing());
  expect(7, "run case.yaml --set output.directory=/proc/out");
  expect(0, "check case.yaml --set output.directory=/proc/nowhere",
         {"a volume can be meshed", "check.json is not written"});
}

TEST_F(Refusals, OfCrashesInTetGen) {
  write("case.yaml", coarse_wing());
  const ScopedFault fault("zone=aborts");
  expect_failure(5, "run case.yaml", {"SIGABRT"});
}

// A group without faces and a face without group end a run at once, with the place in the case.
TEST_F(Refusals, OfGroupsThatSelectNothing) {
  const std::string text = groups_case();
  write("case.yaml", text);
  expect_all(2, "run",
             {{"groups.lid={color: '#00ff00'}", {"'groups.lid'", "like '#00ff00'", "'#ff0000'", "Remedy"}},
              {"groups.lid={area: [7, 8]}", {"'groups.lid': no face meets", "by area 0"}},
              {"groups.lid={ids: 12}", {"no face has the id 12", "largest is 9"}},
              {"groups.lid={color: green}", {"'groups.lid.color': expected a colour"}},
              {"groups.walls={faces: face_1}",
               {"case.yaml:", "'groups.strict': 3 of 10 faces", "'face_3' (around 0.75, 1, 0.5)"}}});
  std::string broken = text;
  broken.replace(broken.find("'#ff0000'"), 9, "'#ff0001'");
  write("case.yaml", broken);
  expect(2, "run case.yaml", {"case.yaml:11:3: 'groups.inlet'"});
}

TEST_F(Refusals, OfPatchesThatAreNotThere) {
  write("case.yaml", coarse_duct() + "layers: {first: 1e-3, patches: {no_such_patch: {count: 3}}}\n");
  for (const std::string command : {"check", "run"})
    expect(2, command + " case.yaml",
           {"case.yaml:5:", "layers.patches.no_such_patch: there is no such patch"});
  EXPECT_FALSE(exists("out/surface.pvtp"));
  write("case.yaml", coarse_transport() + "patches:\n  wing: {faces: ['wing_*'], type: slip}\n");
  expect(2, "run case.yaml --set patches.wing.faces=winglet_*", {"'winglet_*'", "'wing_left_upper'"});
  write("case.yaml", coarse_wing());
  expect(3, "check case.yaml --set geometry.sharpen_faces=[wings]",
         {"no face and no patch of this model is called 'wings'"});
  // These strips were closed; sides as the next ones are those of a fluid.
  write("case.yaml", coarse_transport() + "patches:\n  te: {faces: '*_trailing_edge'}\n");
  expect(2, "check case.yaml",
         {"case.yaml:7:", "patches.te: the file has 'wing_", "was closed", "optional: true"});
  write("case.yaml", coarse_wing() + "patches:\n  side: {faces: xmin}\n");
  expect(2, "check case.yaml", {"taken as a body", "geometry.domain: fluid"});
  expect(2, "check case.yaml --set geometry.encoding=klingon", {"no encoding 'klingon'"});
}

// Sizes that nobody can hold, or that are of nothing, are refused with the name of what asks for them.
TEST_F(Refusals, OfSourcesThatCannotBe) {
  std::string text = coarse_wing();
  const std::string sizing = "sizing: {";
  text.replace(text.find(sizing), sizing.size(),
               sizing +
                   "sources: {wake: {shape: box, low: [8, -2, -2], high: [12, 2, 2], size: 0.8}, "
                   "ball: {shape: sphere, center: [2, 0, 5], radius: 2, size: 0.7}, "
                   "jet: {shape: cylinder, from: [2, 8, -4], to: [6, 8, -4], radius: 1.6, size: 0.6}}, ");
  write("case.yaml", text);
  expect_all(2, "run",
             {{"sizing.sources.wake.size=1e-6", {"sizing.sources.wake", "Remedy"}},
              {"sizing.sources.ball.radius=-1", {"sizing.sources.ball.radius"}},
              {"sizing.sources.ball.low=[0,0,0]", {"sizing.sources.ball", "'low'"}},
              {"sizing.sources.jet.to=[0,0]", {"three numbers"}}});
}

TEST_F(Refusals, OfFormulasWallsWakesAndEdgesThatCannotBe) {
  std::string text = coarse_wing();
  const std::string sizing = "sizing: {";
  text.replace(
      text.find(sizing), sizing.size(),
      sizing +
          "expression: \"max(0.7, 0.25*sqrt((x - 20)^2 + (y - 30)^2 + (z - 25)^2))\", "
          "sources: {wing: {shape: wake, behind: ['face_1'], direction: [3, 0, 0], length: 5, size: 0.5, "
          "end_size: 1.5}}, walls: {tail: {faces: ['face_1'], size: 0.4, distance: 1.5}}, "
          "edges: {root: {between: ['face_1', 'face_2'], size: 0.4}, "
          "corner: {low: [0, -5, -1], high: [8, 5, 1], size: 0.4}}, ");
  write("case.yaml", text);
  expect_all(
      2, "run",
      {{"sizing.expression=0.1*x", {"sizing.expression is", "Remedy"}},
       {"sizing.expression=max(1, foo)", {"sizing.expression", "\"foo\""}},
       {"sizing.expression=1/(x - x)", {"sizing.expression is inf at ("}},
       {"sizing.walls.tail={faces: no_such_wall}", {"sizing.walls.tail", "'no_such_wall'"}},
       {"sizing.sources.wing.direction=[-1, 0, 0]", {"sizing.sources.wing", "Remedy"}},
       {"sizing.sources.wing.from=[0, 0, 1]", {"sizing.sources.wing", "either"}},
       {"sizing.edges.corner={low: [100, 0, 0], high: [101, 1, 1]}", {"sizing.edges.corner", "Remedy"}},
       {"sizing.edges.rows={between: '*', size: 1, height: 1}", {"sizing.edges.rows", "not both"}},
       {"sizing.edges.rows={between: '*', size: 1, growth: 1.2}", {"sizing.edges.rows", "without 'height'"}},
       {"sizing.edges.rows={low: [0, 0, 0], high: [1, 1, 1], height: 1}",
        {"sizing.edges.rows", "whole edges"}},
       {"sizing.walls.tail.size=1e-5", {"sizing.walls.tail", "Remedy"}}});
  expect(2, "run case.yaml --set sizing.minimum=0.01 --set 'sizing.expression=1e-5+0*x'",
         {"sizing.expression: more elements", "Remedy"});
  expect(0, "check case.yaml");  // as it stands it can be
}

TEST_F(Refusals, OfStudies) {
  write("case.yaml", coarse_duct());
  if (world.size() > 1) {
    expect(2, "scaling case.yaml", {"without a launcher"});
    return;
  }
  write("cut/report.json", "{\"status\": ");
  write("cut/tasks.csv", "stage,kind\n");
  write("jobs/results", folder.string() + "\n");
  write("study.json", "{\"program\": \"aeroloom\"}");
  write("network.json", "{\"latency_seconds\": 1e-6, \"bytes_per_second\": 1e9}\n");
  for (const auto& [line, code, word] : std::vector<std::tuple<std::string, int, std::string>>{
           {"scaling case.yaml --launcher true", 2, "lacks {ranks}"},
           {"scaling", 2, "needs a case"},
           {"scaling case.yaml --job-header x", 2, "--write-jobs"},
           {"scaling --collect nowhere", 7, "nowhere"},
           {"scaling --predict nowhere", 7, "has no report.json"},
           {"scaling --predict cut", 7, "report.json' is not whole JSON"},
           {"scaling --compare cut/report.json cut", 7,
            "report.json' is not whole JSON: parse error at line 1"},
           {"scaling --compare network.json network.json", 7, "it has no list 'rows'"},
           {"scaling --compare nowhere cut", 7, "nowhere"},
           {"scaling --collect jobs", 7, "study.json' is not the record of a study"},
           {"scaling --predict cut --ranks 0", 2, "--ranks"},
           {"scaling --predict cut --bandwidth 0", 2, "--bandwidth"},
           {"scaling --predict cut --network network.json --latency 1e-6", 2, "--latency"},
           {"scaling --predict cut --collect jobs", 2, "--predict"},
           {"scaling --measure-network there.json", 2, "mpirun -n 2"}})
    expect(code, line, {word});
}

// What is not read, what is not written, and what would be read as something else.
TEST_F(Refusals, OfConversions) {
  write("case.yaml", coarse_duct() + "\n");
  expect(0, "run case.yaml -q");
  expect(7, "convert absent.su2 x.cgns", {"absent.su2", "No such file"});
  expect(2, "convert " + mesh() + " x.stl", {"x.stl", ".cgns"});
  expect(7, "convert " + path("out/report.json") + " x.cgns", {"report.json", ".meshb"});
  expect(7, "convert " + mesh() + " /proc/x.cgns", {"/proc/x.cgns"});
}

// Eight corners of a cube as one voxel, in the text of VTK.
constexpr const char* voxel = R"(<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="8" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">11</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>
)";

TEST_F(Refusals, OfMeshesThatCannotBeImproved) {
  write("case.yaml", coarse_duct() + "\n");
  expect(0, "run case.yaml -q --set output.parts=1");
  write("voxel.vtu", voxel);
  write("mesh.stl", "solid\n");
  at_root([&] {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "out"))
      if (entry.path().extension() == ".vtu")
        std::filesystem::copy_file(entry.path(), path("torn.vtu"),
                                   std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(path("torn.vtu"), 2000);
  });
  for (const auto& [name, word] :
       std::vector<std::pair<std::string, std::string>>{{"voxel.vtu", "vtkVoxel"},
                                                        {"torn.vtu", "cut off"},
                                                        {"mesh.stl", ".pvtu"},
                                                        {"absent.vtu", "No such file"}})
    expect(7, "improve " + path(name) + " --set output.directory=bad", {word, name});
  expect(2, "improve " + mesh() + " --set output.directory=bad --set improve.gate.smallest_angel=10",
         {"smallest_angle"});
  expect(2, "improve " + mesh() + " --set output.directory=bad --set sizing.minimum=0.1",
         {"'sizing.minimum' says nothing to improve"});
  expect(2, "improve " + mesh(), {"is not overwritten", "output.directory"});
  EXPECT_EQ(read_json("out/report.json")["status"], "ok");
}

}  // namespace
}  // namespace aeroloom::pipeline
