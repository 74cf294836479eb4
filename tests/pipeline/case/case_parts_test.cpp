// Bodies of triangles beside the geometry of a case.
#include "tests/pipeline/case/case_fixture.hpp"

namespace aeroloom::cases {
namespace {

const std::string two_parts =
    "geometry:\n  file: a.step\n  parts:\n"
    "    store: {file: store.stl, scale: 0.001}\n"
    "    ice: {file: ice/ice.obj}\n";

TEST_F(CaseTest, PartsComeBackInTheirOrder) {
  const Case input = read(two_parts);
  ASSERT_EQ(input.domain.parts.size(), 2u);
  EXPECT_EQ(input.domain.parts[0].name, "store");
  EXPECT_EQ(input.domain.parts[0].scale, 0.001);
  EXPECT_EQ(input.domain.parts[1].file, "ice/ice.obj");
  EXPECT_EQ(input.domain.parts[1].scale, 1);
  const Case again = case_of_resolved(resolved_yaml(input));
  ASSERT_EQ(again.domain.parts.size(), 2u);
  EXPECT_EQ(again.domain.parts[0].file, "store.stl");
  EXPECT_EQ(again.domain.parts[0].scale, 0.001);
  EXPECT_EQ(resolved_yaml(again), resolved_yaml(input));
}

TEST_F(CaseTest, FilesOfPartsAreSeenFromTheCase) {
  write("solid", "store.stl");
  const auto store = [&](const std::vector<std::string>& overrides) {
    return read(two_parts, overrides).domain.parts[0].file;
  };
  EXPECT_EQ(store({}), (folder / "store.stl").string());
  EXPECT_EQ(store({"geometry.parts.store.scale=2"}), (folder / "store.stl").string());
  EXPECT_EQ(store({"geometry.parts.store.file=store.stl"}), "store.stl");
  EXPECT_EQ(store({"geometry.parts={store: {file: store.stl}}"}), "store.stl");
}

TEST_F(CaseTest, PartsAreBodiesWithAFile) {
  EXPECT_EQ(error_of("geometry: {file: a.step, parts: {store: {scale: 2}}}\n"),
            "case.yaml:1:34: 'geometry.parts.store' needs 'file', its triangles");
  EXPECT_NE(error_of("geometry: {file: a.step, domain: fluid, parts: {store: {file: s.stl}}}\n")
                .find("is a body in a far field, but 'geometry.domain' is fluid"),
            std::string::npos);
  EXPECT_NE(error_of("geometry: {parts: {store: {file: s.stl}}}\n").find("the case has no geometry"),
            std::string::npos);
  EXPECT_NE(error_of("geometry: {file: a.step, parts: {store: {file: s.stl, scale: 0}}}\n").find("above 0"),
            std::string::npos);
  EXPECT_NE(error_of("geometry: {file: a.step, parts: {store: {fil: s.stl}}}\n").find("did you mean 'file'"),
            std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
