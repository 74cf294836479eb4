#include "tests/pipeline/case/case_fixture.hpp"

namespace aeroloom::cases {
namespace {

TEST_F(CaseTest, PatchesHaveNamesOfTheUsers) {
  const std::string yaml =
      transport +
      "patches:\n  wing: {faces: [wing_*, 'fl?p'], type: slip}\n  farfield: {type: outlet}\n"
      "  everything else: {faces: '*'}\n";
  const Case input = read(yaml, {"patches.wing.type=wall", "patches.fin.type=inlet"});
  ASSERT_EQ(input.patches.size(), 4U);
  EXPECT_EQ(input.patches[0].name, "wing");
  EXPECT_EQ(input.patches[0].faces, (std::vector<std::string>{"wing_*", "fl?p"}));
  EXPECT_EQ(input.patches[0].type, mesh::PatchType::wall);
  EXPECT_TRUE(input.patches[1].faces.empty());
  EXPECT_EQ(input.patches[2].type, std::nullopt);
  EXPECT_EQ(input.patches[3].name, "fin");
  const Case again = read(resolved_yaml(input));
  ASSERT_EQ(again.patches.size(), 4U);
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
  EXPECT_NE(
      error_of(transport, {"patches.wing.faces=[*wing]"}).find("a text that begins with * stands in quotes"),
      std::string::npos);
  EXPECT_EQ(error_of(transport + "patches:\n  wing: {tipe: wall}\n"),
            "case.yaml:3:10: unknown key 'tipe' in 'patches.wing'; did you mean 'type'?");
  EXPECT_EQ(error_of(transport + "patches:\n  wing: {type: sticky}\n"),
            "case.yaml:3:16: 'patches.wing.type': expected one of wall, slip, symmetry, farfield, inlet, "
            "outlet, got "
            "'sticky'");
}

TEST_F(CaseTest, FormatsAreAListOfNames) {
  EXPECT_EQ(read(transport).output.formats, std::vector<io::FileFormat>{io::FileFormat::vtu});
  const Case input = read(transport + "output: {formats: [cgns, su2b, cgns], parts: 4}\n");
  EXPECT_EQ(input.output.formats, (std::vector<io::FileFormat>{io::FileFormat::cgns, io::FileFormat::su2b}));
  EXPECT_EQ(input.output.parts, 4);
  EXPECT_EQ(read(resolved_yaml(input)).output.formats, input.output.formats);
  EXPECT_EQ(read(transport, {"output.formats=msh"}).output.formats,
            std::vector<io::FileFormat>{io::FileFormat::msh});
  EXPECT_NE(error_of(transport + "output: {formats: [cgsn]}\n").find("expected one of vtu, vtkhdf, cgns"),
            std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
