// Regions of triangles from the file to the mesh: solids that touch in unequal triangles, and nested ones.
#include "tests/cad/faceted_shapes.hpp"
#include "tests/pipeline/command_line.hpp"

#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::json;
using cad::FacetSoup;
using geometry::Vec3;

std::string box(const std::string& name, Vec3 low, Vec3 high) {
  return cad::faceted::ascii_stl(cad::faceted::box_soup(low, high), name);
}

/// With the other diagonal in each side.
std::string other_box(const std::string& name, Vec3 low, Vec3 high) {
  FacetSoup soup = cad::faceted::box_soup(low, high);
  for (std::size_t t = 0; t < soup.triangles.size(); t += 2) {
    const auto [a, b, c] = soup.triangles[t];
    const std::int32_t d = soup.triangles[t + 1][2];
    soup.triangles[t] = {b, c, d}, soup.triangles[t + 1] = {b, d, a};
  }
  return cad::faceted::ascii_stl(soup, name);
}

class FacetedRegions : public CommandLine {
protected:
  /// Volumes of the mesh's regions by name, of a run that ends well.
  std::map<std::string, double> volumes(const std::string& geometry) const {
    write("case.yaml", "geometry: {file: " + path("solids.stl") + geometry +
                           "}\nsizing: {minimum: 0.5, maximum: 0.5}\noutput: {pictures: false}\n");
    expect(0, "run case.yaml");
    std::map<std::string, double> found;
    const Json report = read_json("out/report.json");
    for (const Json& region : report["regions"])
      found[region["name"].get<std::string>()] = region["volume"].get<double>();
    return found;
  }
};

void expect_volumes(const std::map<std::string, double>& found, const std::map<std::string, double>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (const auto& [name, volume] : wanted) {
    ASSERT_EQ(found.count(name), 1u) << name;
    EXPECT_NEAR(found.at(name), volume, 1e-9) << name;
  }
}

TEST_F(FacetedRegions, TouchingSolidsConformAtTheirInterface) {
  write("solids.stl", box("left", {0, 0, 0}, {1, 1, 1}) + other_box("right", {1, 0, 0}, {2, 1, 1}));
  expect_volumes(volumes(", domain: fluid"), {{"left", 1}, {"right", 1}});
  const Json facts = Json::parse(expect(0, "info --json " + mesh()).out);
  std::map<std::string, std::string> types;
  for (const Json& patch : facts["patches"]) types[patch["name"]] = patch["type"];
  EXPECT_EQ(types["interface_left_right"], "interior") << facts["patches"];
  EXPECT_EQ(types["left"], "wall") << facts["patches"];
  EXPECT_EQ(facts["doubled_nodes"]["nodes"], 0);
}

TEST_F(FacetedRegions, ASingleSolidHasItsName) {
  write("solids.stl", box("room", {0, 0, 0}, {2, 1, 1}));
  expect_volumes(volumes(", domain: fluid"), {{"room", 2}});
}

TEST_F(FacetedRegions, NestedSolidsAreRegionsOrVoids) {
  write("solids.stl", box("skull", {0, 0, 0}, {3, 3, 3}) + box("brain", {1, 1, 1}, {2, 2, 2}));
  expect_volumes(volumes(""), {{"skull", 26}, {"brain", 1}});
  expect(0, "check case.yaml", {"a region of its own (geometry.voids makes it a void)"});
  const std::map<std::string, double> hollow = volumes(", domain: fluid, voids: brain");
  ASSERT_EQ(hollow.size(), 1u);
  EXPECT_NEAR(hollow.begin()->second, 26, 1e-9);
  write("case.yaml", "geometry: {file: " + path("solids.stl") + ", voids: brian}\n");
  expect(3, "check case.yaml", {"geometry.voids", "'brian'", "'skull', 'brain'"});
}

}  // namespace
}  // namespace aeroloom::pipeline
