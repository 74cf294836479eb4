// Lengths of a case against the body.
#include "pipeline/case/given_lengths.hpp"

#include "tests/pipeline/case/case_fixture.hpp"

#include <fmt/format.h>

namespace aeroloom::cases {
namespace {

class GivenLengths : public CaseTest {
protected:
  std::string fault(const std::string& yaml, geometry::Box body = {{0, 0, 0}, {4, 2, 1}}) const {
    return fault_of_lengths(read(transport + yaml).lengths, body);
  }
};

TEST_F(GivenLengths, OfAllKeysAreRefusedFarBelowAndFarAboveTheBody) {
  for (const char* const key :
       {"sizing: {reference_length: X}", "sizing: {minimum: X}", "sizing: {maximum: X}",
        "sizing: {surface_maximum: X}", "sizing: {feature_minimum: X}", "sizing: {chordal_deviation: X}",
        "groups: {a: {faces: '*', size: X}}", "patches: {body: {size: X}}", "layers: {first: X}",
        "layers: {y_plus: 1, reynolds: 1e6, length: X}",
        "sizing: {sources: {a: {shape: sphere, center: [0, 0, 0], radius: X, size: 1}}}",
        "sizing: {walls: {a: {size: 1, distance: X}}}", "sizing: {edges: {a: {between: a, size: X}}}",
        "geometry: {trailing_edges: sharpen, sharpen_width: X}"}) {
    const auto with = [&](const std::string& value) {
      std::string yaml = key;
      yaml.replace(yaml.find('X'), 1, value);
      if (yaml.starts_with("geometry"))
        return read_case(write(transport),
                         {"geometry.trailing_edges=sharpen", "geometry.sharpen_width=" + value})
            .lengths;
      return read(transport + yaml).lengths;
    };
    const geometry::Box body{{0, 0, 0}, {4, 2, 1}};
    for (const char* const good : {"1e-8", "0.5", "3e9"})
      EXPECT_EQ(fault_of_lengths(with(good), body), "") << key;
    for (const char* const bad : {"1e-180", "3e-09", "5e9", "1e300"}) {
      const std::string text = fault_of_lengths(with(bad), body);
      EXPECT_NE(text.find(fmt::format("is {}", bad)), std::string::npos) << key << ": " << text;
      EXPECT_NE(text.find("at least 4e-09 and at most 4e+09"), std::string::npos) << text;
    }
  }
}

TEST_F(GivenLengths, HaveTheirPlaceInTheFile) {
  const std::string text = fault("sizing:\n  maximum: 1\n  minimum: 1e-180\n");
  EXPECT_NE(text.find("case.yaml:4:"), std::string::npos) << text;
  EXPECT_NE(text.find("'sizing.minimum' is 1e-180,"), std::string::npos) << text;
}

TEST_F(GivenLengths, CountInReferenceLengths) {
  EXPECT_EQ(fault("sizing: {reference_length: 5e3, minimum: 1e-12}\n"), "");
  const std::string text = fault("sizing: {reference_length: 4e-3, minimum: 1e-7}\n");
  EXPECT_NE(text.find("'sizing.minimum' is 1e-07 (times 'sizing.reference_length': 4e-10)"),
            std::string::npos)
      << text;
}

// A body of 4 at 1e10, where numbers are 2e-6 apart: sizes above what is left of its extent may be too small.
TEST_F(GivenLengths, AreDistinctAmongCoordinates) {
  const geometry::Box far{{1e10, 0, 0}, {1e10 + 4, 1, 1}};
  EXPECT_EQ(fault("sizing: {minimum: 0.001}\n", far), "");
  for (const char* const small : {"sizing: {minimum: 1e-4}\n", "layers: {first: 1e-5}\n"}) {
    const std::string text = fault(small, far);
    EXPECT_NE(text.find("numbers of the computer are 1.9e-06 apart"), std::string::npos) << text;
    EXPECT_NE(text.find("at least 0.000191"), std::string::npos) << text;
    EXPECT_NE(text.find("Remedy: a model near the origin"), std::string::npos) << text;
  }
}

TEST_F(GivenLengths, OfPlacesMayBeZeroAndFarFromTheOrigin) {
  const std::string begin = "sizing: {sources: {a: {shape: point, size: 1, center: ";
  EXPECT_EQ(fault(begin + "[0, -3, 1e-200]}}}\n"), "");
  EXPECT_NE(fault(begin + "[0, -1e300, 0]}}}\n").find("no farther away than"), std::string::npos);
  EXPECT_EQ(fault("sizing: {walls: {a: {size: 1, distance: 0}}}\n"), "");
  EXPECT_EQ(fault(begin + "[9e9, 0, 0]}}}\n", {{8e9, 0, 0}, {8e9 + 4, 1, 1}}), "");
}

}  // namespace
}  // namespace aeroloom::cases
