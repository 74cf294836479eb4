// The shared set of faceted files: all sound ones close, the damaged ones are repaired or refused within
// seconds.
#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_facts.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "geometry/angle.hpp"
#include "tests/cad/real_files.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

constexpr double sharp = 40 * geometry::degree;

double total_volume(const FacetComplex& complex) {
  const Vec3 base = complex.points[0];
  double volume = 0;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto& [a, b, c] = complex.triangles[t];
    if (complex.faces[complex.face_of[t]].back != no_entity) continue;
    volume += volume6(base, complex.points[a], complex.points[b], complex.points[c]) / 6;
  }
  return volume;
}

/// What parallel lines have within the surface, by the parity of their crossings: regardless of orientation.
struct ColumnVolume {
  double mean = 0, error = 0;
  int odd = 0;  ///< lines that enter and never leave

  explicit ColumnVolume(const FacetSoup& soup) {
    geometry::Box box;
    for (const Vec3 p : soup.points) box.add(p);
    const Vec3 size = box.high - box.low;
    constexpr int lines = 1000;
    std::mt19937 random(3);
    const auto fraction = [&] { return random() / 4294967296.0; };
    double sum = 0, squares = 0;
    for (int i = 0; i < lines; ++i) {
      const double x = box.low.x + fraction() * size.x;
      const double length = inside(soup, x, box.low.y + fraction() * size.y);
      sum += length, squares += length * length;
    }
    mean = size.x * size.y * sum / lines;
    error = size.x * size.y * std::sqrt((squares - sum * sum / lines) / lines / lines);
  }

private:
  double inside(const FacetSoup& soup, double x, double y) {
    std::vector<double> heights;
    for (const auto& [i, j, k] : soup.triangles) {
      const Vec3 a = soup.points[i], b = soup.points[j], c = soup.points[k];
      const auto turn = [&](Vec3 p, Vec3 q) { return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x); };
      const double ab = turn(a, b), bc = turn(b, c), ca = turn(c, a);
      if (!((ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0))) continue;
      heights.push_back((bc * a.z + ca * b.z + ab * c.z) / (ab + bc + ca));
    }
    std::sort(heights.begin(), heights.end());
    odd += heights.size() % 2 != 0;
    double length = 0;
    for (std::size_t i = 0; i + 1 < heights.size(); i += 2) length += heights[i + 1] - heights[i];
    return length;
  }
};

/// Sound files whose triangles agree on what is outwards.
TEST(FacetFiles, RegionsHaveTheVolumeOfTheFile) {
  const std::vector<std::string> files = {
      "axom_aatbase3.stl",     "cgal_anchor_dense.off", "cgal_blob-closed.off",
      "cgal_couplingdown.off", "cgal_fandisk.off",      "cgal_handle.off",
      "cgal_helmet.off",       "cgal_pinion.off",       "cgal_rotor.off",
      "cgal_spool.off",        "cgal_u_arch.off",       "flow360_airplane.stl",
      "ftetwild_bunny.off",    "netgen_hinge.stl",      "netgen_part1.stl",
      "netgen_plane.stl",      "occt_TR12J.stl",        "queso_cube_with_cavity.stl",
      "queso_elephant.stl"};
  for (const std::string& name : files) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    SCOPED_TRACE(name);
    const FacetSoup soup = read_facets(real::file("faceted/" + name));
    const FacetFacts facts = look_at_facets(soup);
    EXPECT_EQ(facts.misoriented_sides, 0);
    Changes changes;
    const FacetComplex complex = make_facet_complex(soup, sharp, changes);
    EXPECT_EQ(complex.regions.size(), 1U);
    EXPECT_NEAR(total_volume(complex), facts.volume, 1e-12 * facts.volume);
    EXPECT_LT(complex.faces.size(), soup.triangles.size() / 20 + 60);
  }
}

/// Triangles of these look either way, so that the file's own divergence sum means nothing.
TEST(FacetFiles, OrientedFilesHaveTheVolumeOfColumns) {
  for (const std::string name :
       {"cgal_boeing.off", "occt_propeller.stl", "tetgendrafts_slit-1.smesh", "tetgendrafts_slit-10.smesh",
        "tetgendrafts_spike-1-10.smesh", "tetgendrafts_spike-10-10.smesh"}) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    SCOPED_TRACE(name);
    const FacetSoup soup = read_facets(real::file("faceted/" + name));
    EXPECT_GT(look_at_facets(soup).misoriented_sides, 0);
    Changes changes;
    const FacetComplex complex = make_facet_complex(soup, sharp, changes);
    const ColumnVolume columns(soup);
    EXPECT_LE(columns.odd, 2);  // lines that run along a side
    EXPECT_NEAR(total_volume(complex), columns.mean, 4 * columns.error);
    EXPECT_LT(columns.error, 0.2 * columns.mean);
  }
}

/// The wedge between two unit squares that meet at an angle of as many degrees.
TEST(FacetFiles, WedgesHaveHalfTheSineOfTheirAngle) {
  for (const auto& [name, angle] : {std::pair<std::string, double>("tetgendrafts_wedge-1.smesh", 1),
                                    std::pair<std::string, double>("tetgendrafts_wedge-10.smesh", 10)}) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    Changes changes;
    const FacetComplex complex =
        make_facet_complex(read_facets(real::file("faceted/" + name)), sharp, changes);
    EXPECT_NEAR(total_volume(complex), std::sin(angle * geometry::degree) / 2, 1e-9) << name;
  }
}

/// Two regions with holes, that share inner facets.
TEST(FacetFiles, TheSamplePlcOfTetgenHasItsTwoRegions) {
  if (!real::has("faceted/tetgen_example.poly")) GTEST_SKIP() << "no tetgen_example.poly";
  const FacetSoup soup = read_facets(real::file("faceted/tetgen_example.poly"));
  EXPECT_EQ(soup.holes.size(), 2U);
  Changes changes;
  const FacetComplex complex = make_facet_complex(soup, sharp, changes);
  EXPECT_EQ(complex.regions, (std::vector<std::string>{"region_10", "region_20"}));
  const auto shared = std::count_if(complex.faces.begin(), complex.faces.end(),
                                    [](const FacetComplex::Face& face) { return face.back != no_entity; });
  EXPECT_GT(shared, 0);
  EXPECT_NEAR(total_volume(complex), 17.9375, 1e-9);
}

struct Damaged {
  std::string name, refusal;  ///< empty where it is repaired
};

TEST(FacetFiles, DamagedOnesAreRepairedOrNamedWithinSeconds) {
  const std::vector<Damaged> files = {{"aegmesher_viggen_jet.stl", "not closed"},
                                      {"ansys_f1_rear_wing_endplates.stl", ""},
                                      {"ansys_f1_rear_wing_main.stl", ""},
                                      {"attene_bust.off", "not closed"},
                                      {"bladex_propeller_and_shaft.stl", "not closed"},
                                      {"firefish_martlet2_rocket.stl", "overlap"},
                                      {"firefish_martlet3_rocket.stl", "not closed"},
                                      {"manifold_Generic_Twin_7081.1.t0_left.obj", "crosses or touches"},
                                      {"manifold_openscad-nonmanifold-crash.obj", "not closed"},
                                      {"manifold_self_intersectA.obj", "crosses or touches"},
                                      {"mdolab_c172_wing.stl", ""},
                                      {"occt_motor.stl", "not closed"},
                                      {"openfoam_propeller.obj", "not closed"}};
  for (const auto& [name, refusal] : files) {
    if (!real::has("faceted/" + name)) GTEST_SKIP() << "no " << name;
    SCOPED_TRACE(name);
    Changes changes;
    const std::clock_t begin = std::clock();
    std::string message;
    try {
      const FacetComplex complex =
          make_facet_complex(read_facets(real::file("faceted/" + name)), sharp, changes);
      EXPECT_FALSE(changes.empty());
      EXPECT_GT(total_volume(complex), 0);
    } catch (const CadError& error) {
      message = error.what();
      EXPECT_NE(message.find(name), std::string::npos);
    }
    EXPECT_EQ(message.empty(), refusal.empty()) << message;
    EXPECT_NE(message.find(refusal), std::string::npos) << message;
    const double taken = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_LT(taken, 60);  // 4 s at most; under sanitizers ten times that
  }
}

}  // namespace
}  // namespace aeroloom::cad
