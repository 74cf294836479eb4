// What a run is known by: the bytes of its geometry, wherever they lie, and the dimensions of the built-in
// aircraft.
#include "pipeline/run_identity.hpp"

#include "tests/pipeline/command_line.hpp"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::pipeline {
namespace {

class RunIdentityTest : public CommandLine {
protected:
  RunIdentity of_file(const std::string& file) const {
    cases::Case input;
    input.domain.file = file;
    return identify_run(world, input);
  }
};

TEST_F(RunIdentityTest, IsThatOfTheBytesNotOfTheirPlace) {
  const RunIdentity one = of_file(write("wing.step", "some bytes")),
                    two = of_file(write("moved/wing.step", "some bytes")),
                    other = of_file(write("other/wing.step", "some bytez"));
  EXPECT_TRUE(one.is_known);
  EXPECT_EQ(one.bytes, 10);
  EXPECT_EQ(one.input, "wing.step");
  EXPECT_EQ(one.digest, two.digest);
  EXPECT_EQ(one.build, two.build);
  EXPECT_EQ(one.version, two.version);
  EXPECT_NE(one.digest, other.digest);
  EXPECT_TRUE(one.version.starts_with("aeroloom "));
  EXPECT_NE(one.version.find("OpenCASCADE"), std::string::npos);
}

TEST_F(RunIdentityTest, CountsEveryPart) {
  cases::Case input;
  input.domain.file = write("wing.step", "some bytes");
  input.domain.parts.push_back({});
  input.domain.parts.back().file = write("store.stl", "more");
  const RunIdentity both = identify_run(world, input);
  EXPECT_EQ(both.bytes, 14);
  EXPECT_NE(both.digest, of_file(input.domain.file).digest);
  write("store.stl", "less");
  EXPECT_NE(identify_run(world, input).digest, both.digest);
}

TEST_F(RunIdentityTest, CountsPointsInAFileBesideTheGeometry) {
  const std::string poly = write("cube.poly", "# points stand beside\n0 3 0 0\n1 0\n1\n3 1 2 3\n0\n");
  EXPECT_FALSE(of_file(poly).is_known);
  write("cube.node", "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n");
  const RunIdentity one = of_file(poly);
  EXPECT_TRUE(one.is_known);
  write("cube.node", "3 3 0 0\n1 0 0 0\n2 2 0 0\n3 0 1 0\n");
  EXPECT_NE(of_file(poly).digest, one.digest);
  cases::Case input;
  input.domain.transport.emplace();
  input.domain.parts.push_back({});
  input.domain.parts.back().file = poly;
  const RunIdentity part = identify_run(world, input);
  write("cube.node", "3 3 0 0\n1 0 0 0\n2 4 0 0\n3 0 1 0\n");
  EXPECT_NE(identify_run(world, input).digest, part.digest);
  // A file with points of its own has no other.
  const RunIdentity whole = of_file(write("whole.poly", "1 3 0 0\n1 0 0 0\n0 0\n0\n"));
  write("whole.node", "1 3 0 0\n1 0 0 0\n");
  EXPECT_EQ(of_file(path("whole.poly")).digest, whole.digest);
}

TEST_F(RunIdentityTest, IsUnknownWithoutTheFile) {
  EXPECT_FALSE(of_file(path("absent.step")).is_known);
  EXPECT_FALSE(of_file(folder.string()).is_known);
}

TEST_F(RunIdentityTest, OfTheBuiltInAircraftIsThatOfItsDimensions) {
  cases::Case input;
  input.domain.transport.emplace();
  const RunIdentity one = identify_run(world, input);
  EXPECT_EQ(one.input, "built-in aircraft");
  input.sizing.minimum = 7;
  EXPECT_EQ(identify_run(world, input).digest, one.digest) << "sizes are no geometry";
  input.domain.transport->wing.half_span += 1;
  EXPECT_NE(identify_run(world, input).digest, one.digest);
}

TEST_F(RunIdentityTest, FilesThatChangeWhileTheyAreReadAreRefused) {
  cases::Case input;
  input.domain.file = write("wing.step", "some bytes");
  const RunIdentity identity = identify_run(world, input);
  EXPECT_NO_THROW(require_same_file(identity, input));
  write("wing.step", "some bytez");
  try {
    require_same_file(identity, input);
    ADD_FAILURE() << "taken";
  } catch (const std::filesystem::filesystem_error& error) {
    EXPECT_NE(std::string(error.what()).find("was changed while it was read"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::pipeline
