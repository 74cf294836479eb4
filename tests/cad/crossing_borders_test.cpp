// Faces whose border crosses itself are refused with name and place, before any mesh.
#include "cad/repair/crossing_borders.hpp"

#include "cad/domain/domain.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/prisms.hpp"
#include "tests/cad/real_files.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

/// The upper and the lower curve cross before they reach the trailing edge.
const std::vector<std::pair<double, double>> fishtail{{0, 0},     {1, -1},   {4, -0.25}, {6, 0.25},
                                                      {6, -0.25}, {4, 0.25}, {1, 1}};

std::string refusal_of(const TopoDS_Shape& shape) {
  try {
    shapes::prepare(shape, {});
  } catch (const CadError& error) {
    return error.what();
  }
  return "made";
}

TEST(CrossingBorders, AFishtailIsRefusedWithFaceAndPlace) {
  const std::string message = refusal_of(shapes::prism(fishtail, 3));
  for (const char* const word : {"crosses itself", "face '", "near (5, ", "Remedy"})
    EXPECT_NE(message.find(word), std::string::npos) << message;
}

TEST(CrossingBorders, ProfilesThatTouchAlmostAreNot) {
  const std::vector<std::pair<double, double>> thin{{0, 0}, {1, -1}, {5, -0.001}, {6, 0}, {5, 0.001}, {1, 1}};
  EXPECT_EQ(refusal_of(shapes::prism(thin, 3)), "made");
}

TEST(CrossingBorders, AReportedFileIsRefused) {
  if (!real::has("reported/fishtail.step")) GTEST_SKIP() << "no file";
  DomainOptions options;
  options.file = real::file("reported/fishtail.step");
  try {
    prepare_domain(options);
    ADD_FAILURE() << "it was not refused";
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find("crosses itself"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::cad
