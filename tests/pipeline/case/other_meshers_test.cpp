// Words of other meshers in a case: the answers, and the page that lists them.
#include "pipeline/case/other_meshers.hpp"

#include "pipeline/case/key_info.hpp"
#include "tests/pipeline/case/case_fixture.hpp"
#include "tests/source_tree.hpp"

#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cases {
namespace {

class OtherMeshers : public CaseTest {
protected:
  /// The line of the case below the geometry is refused with this answer, and the page's name.
  void expect(const std::string& line, const std::string& answer) const {
    const std::string said = error_of(transport + line + "\n");
    EXPECT_NE(said.find(answer), std::string::npos) << line << "\n" << said;
    EXPECT_NE(said.find("docs/out_of_scope.md"), std::string::npos) << line << "\n" << said;
    EXPECT_EQ(said.find("did you mean"), std::string::npos) << line << "\n" << said;
    EXPECT_NE(said.find("case.yaml:2:"), std::string::npos) << said;
  }
};

TEST_F(OtherMeshers, KeysOfWhatIsNotMadeAreAnswered) {
  expect("hexahedra: true", "hexahedra and quadrilaterals on the surface are not made");
  expect("layers: {hexahedra: true}", "hexahedra and quadrilaterals");
  expect("volume: {hexcore: true}", "hexahedra and quadrilaterals");
  expect("polyMesh: {}", "polyhedra are not made");
  expect("sizing: {dimension: 2}", "meshes are of three dimensions");
  expect("patches: {left: {periodic: right}}", "periodic pairs of faces are not made");
  expect("dynamicMesh: {motion: rotate}", "meshes do not move");
  expect("porous_zones: [filter]", "zones have no properties");
  expect("farfield: {overset: true}", "overset and overlapping grids");
  expect("Mesh.ElementOrder: 2", "elements are straight");
}

TEST_F(OtherMeshers, KeysOfOthersNameOurs) {
  expect("maxh: 0.5", "the key is 'sizing.maximum'");
  expect("sizing: {MeshSizeFactor: 0.5}", "the key is 'sizing.scale'");
  expect("sizing: {curvature-normal-angle: 18}", "the key is 'sizing.curvature_angle'");
  expect("layers: {nSurfaceLayers: 5}", "the key is 'layers.count'");
  expect("addLayersControls: {expansionRatio: 1.2}", "below 'layers'");
  expect("castellatedMeshControls: {maxGlobalCells: 1000000}", "meshes always fit the CAD");
  expect("farfield: {locationInMesh: [1, 2, 3]}", "the key is 'geometry.domain'");
  expect("Mesh: {MeshSizeMax: 0.5}", "below 'sizing'");
  expect("improve: {optsteps3d: 3}", "below 'improve'");
  expect("output: {scale: 0.001}", "lengths stay in the unit of the file");
}

TEST_F(OtherMeshers, ValuesAreAnswered) {
  expect("layers: {first: 0.1, elements: hexahedra}", "hexahedra and quadrilaterals");
  expect("patches: {left: {type: cyclic}}", "periodic pairs");
  expect("patches: {left: {type: empty}}", "three dimensions");
  expect("patches: {left: {type: symmetryPlane}}", "the type is 'symmetry'");
  expect("patches: {left: {type: pressure-outlet}}", "the type is 'outlet'");
  expect("output: {formats: [vtu, fluent]}", "docs/formats.md");
  const std::string said = error_of(transport + "patches: {left: {type: quux}}\n");
  EXPECT_TRUE(said.ends_with("got 'quux'")) << said;
}

// A key at a wrong place, and what is nearly a key, stay what they are.
TEST_F(OtherMeshers, KeysOfThisProgramAreNotTakenForOthers) {
  EXPECT_NE(error_of(transport + "fineness: 1\n").find("'sizing.scale'"), std::string::npos);
  EXPECT_NE(error_of(transport + "growth: 1\n").find("did you mean 'sizing.growth'?"), std::string::npos);
  const auto names = [] {
    std::set<std::string> all;
    for (const KeyInfo& key : case_keys()) {
      std::string bare;
      for (const unsigned char c : key.name())
        if (std::isalnum(c) != 0) bare += static_cast<char>(std::tolower(c));
      all.insert(bare);
      all.insert(key.choices.begin(), key.choices.end());
    }
    return all;
  }();
  for (const OtherWords& each : out_of_scope()) {
    std::istringstream words{std::string(each.words)};
    for (std::string word; words >> word;) EXPECT_FALSE(names.contains(word)) << word;
  }
}

TEST_F(OtherMeshers, NoWordHasTwoAnswers) {
  std::set<std::string> seen;
  for (const auto table : {out_of_scope(), named_otherwise(), paths_otherwise(), values_otherwise()}) {
    for (const OtherWords& each : table) {
      std::istringstream words{std::string(each.words)};
      for (std::string word; words >> word;) {
        EXPECT_TRUE(seen.insert(word).second) << word;
        for (const unsigned char c : word) EXPECT_TRUE(std::islower(c) != 0 || std::isdigit(c) != 0) << word;
      }
    }
  }
}

TEST_F(OtherMeshers, ThePageHasAllAnswers) {
  std::ifstream stream(source_tree() / page_of_other_words);
  std::string page{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  for (char& c : page)
    if (c == '`') c = '\'';
  for (const auto table : {out_of_scope(), named_otherwise(), paths_otherwise(), values_otherwise()}) {
    for (const OtherWords& each : table) {
      std::string row = "| " + std::string(each.topic) + " | " + std::string(each.answer) + " |";
      for (char& c : row)
        if (c == '`') c = '\'';
      EXPECT_NE(page.find(row), std::string::npos) << row;
    }
  }
}

TEST_F(OtherMeshers, TheirFilesAreNoCases) {
  const auto refused = [&](const std::string& name, const std::string& text) -> std::string {
    try {
      read_case(write(text, name), {});
    } catch (const CaseError& error) {
      return error.what();
    }
    return "no error";
  };
  for (const auto& [name, text, what] :
       {std::array<const char*, 3>{"system/snappyHexMeshDict",
                                   "/*---*/\nFoamFile\n{\n    version 2.0;\n}\ncastellatedMesh true;\n",
                                   "a dictionary of OpenFOAM"},
        {"wing.geo", "Merge \"wing.step\";\n", "a script of Gmsh"},
        {"wing.glf", "package require PWI_Glyph\n", "a script of Pointwise"},
        {"run.jou", "(cx-gui-do)\n", "a journal of Fluent Meshing"}}) {
    const std::string said = refused(name, text);
    EXPECT_NE(said.find(what), std::string::npos) << said;
    EXPECT_NE(said.find("docs/out_of_scope.md"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace aeroloom::cases
