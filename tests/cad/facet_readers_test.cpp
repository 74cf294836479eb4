// Faceted files of all formats, and damaged ones.
#include "cad/faceted/facet_facts.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/make_facet_complex.hpp"
#include "cad/model/model.hpp"
#include "tests/cad/faceted_shapes.hpp"
#include "tests/cad/real_files.hpp"

#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using faceted::box_soup;
using real::TemporaryFile;

FacetSoup read_text(const std::string& name, const std::string& content) {
  const TemporaryFile file(name, content);
  return read_facets(file.path());
}

std::string refusal(const std::string& name, const std::string& content) {
  try {
    read_text(name, content);
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    return error.what();
  }
  return "read";
}

void expect_box(const FacetSoup& soup) {
  const FacetFacts facts = look_at_facets(soup);
  EXPECT_EQ(facts.points, 8);
  EXPECT_EQ(facts.triangles, 12);
  EXPECT_EQ(facts.open_sides, 0);
  EXPECT_EQ(facts.misoriented_sides, 0);
  EXPECT_EQ(facts.components, 1);
  EXPECT_NEAR(facts.volume, 6, 1e-12);
  EXPECT_NEAR(facts.area, 22, 1e-12);
}

const FacetSoup box = box_soup({-1, 0, 0.5}, {0, 2, 3.5});

TEST(FacetReaders, AllFormatsGiveTheSameBox) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.stl", faceted::ascii_stl(box)},       {"b.stl", faceted::binary_stl(box)},
      {"c.off", faceted::off_text(box)},        {"d.obj", faceted::obj_text(box)},
      {"e.ply", faceted::ply_text(box)},        {"f.ply", faceted::ply_bytes(box, true)},
      {"g.PLY", faceted::ply_bytes(box, false)}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    const TemporaryFile file(name, content);
    EXPECT_TRUE(is_faceted_file(file.path()));
    expect_box(read_facets(file.path()));
  }
}

TEST(FacetReaders, BlanksAndAMarkMayStandBeforeTheText) {
  const std::string mark = "\xEF\xBB\xBF", blanks = " \r\n\n\t\n", many(3000, '\n');
  for (const std::string& before : {mark, blanks, mark + blanks, many}) {
    for (const auto& [name, content] : {std::pair<std::string, std::string>{"a.stl", faceted::ascii_stl(box)},
                                        {"b.off", faceted::off_text(box)},
                                        {"c.obj", faceted::obj_text(box)}}) {
      SCOPED_TRACE(name);
      const TemporaryFile file(name, before + content);
      EXPECT_TRUE(is_faceted_file(file.path()));
      expect_box(read_facets(file.path()));
    }
  }
  expect_box(read_text("d.ply", mark + faceted::ply_text(box)));
  expect_box(read_text("e.ply", mark + faceted::ply_bytes(box, true)));
  EXPECT_EQ(read_text("f.poly", mark + faceted::poly_text()).regions.size(), 2U);
}

TEST(FacetReaders, BinaryFilesEndWhereTheirCountsSay) {
  for (const std::size_t from_end : {0, 7}) {
    std::string stl = faceted::binary_stl(box), ply = faceted::ply_bytes(box, false);
    stl.insert(stl.size() - from_end, 1, '\0');
    ply.insert(ply.size() - from_end, 1, '\0');
    EXPECT_NE(refusal("a.stl", stl).find("12 triangles, but 1 bytes follow"), std::string::npos);
    EXPECT_NE(refusal("b.ply", ply), "read");
  }
  EXPECT_NE(refusal("c.ply", faceted::ply_bytes(box, true) + "x").find("but 1 bytes follow"),
            std::string::npos);
}

TEST(FacetReaders, LongNamesAreCutAndStayDifferent) {
  const std::string same(200'000, 'n');
  const FacetSoup soup =
      read_text("long.stl", faceted::ascii_stl(box, same + "a") +
                                faceted::ascii_stl(box_soup({5, 0, 0}, {6, 1, 1}), same + "b"));
  ASSERT_EQ(soup.groups.size(), 2U);
  EXPECT_EQ(soup.cut_names, 2U);
  for (const FacetSoup::Group& group : soup.groups) EXPECT_LE(group.name.size(), 4096U);
  EXPECT_NE(soup.groups[0].name, soup.groups[1].name);
  Changes changes;
  make_facet_complex(soup, 0.5, changes, CrossingFacets::join);
  ASSERT_FALSE(changes.empty());
  EXPECT_EQ(changes.front().what, "2 names are longer than 4096 bytes: only their beginnings are read");
  EXPECT_TRUE(changes.front().is_warning);
  std::string letters;
  for (int i = 0; i < 3000; ++i) letters += "\xC3\xBC";
  const std::string cut = read_text("letters.stl", faceted::ascii_stl(box, letters)).groups[0].name;
  EXPECT_EQ(cut.find('~') % 2, 0U) << "cut within a letter";
}

TEST(FacetReaders, CoordinatesBeyondArithmeticAreZeroOrRefused) {
  std::string text = faceted::off_text(box);
  const auto with = [&](const std::string& value) {
    std::string changed = text;
    const std::size_t at = changed.find(" 0 ");
    return at == std::string::npos ? changed : changed.replace(at + 1, 1, value);
  };
  ASSERT_NE(with("1e-320"), text);
  for (const char* tiny : {"1e-320", "-4e-310", "1e-40"}) {
    const FacetSoup soup = read_text("tiny.off", with(tiny));
    EXPECT_EQ(soup.zeroed, 1U) << tiny;
    expect_box(soup);
  }
  EXPECT_EQ(read_text("noise.off", with("1e-17")).zeroed, 0U);
  EXPECT_NE(refusal("huge.off", with("1e35")).find("the largest coordinate is 1e+35"), std::string::npos);
  EXPECT_NE(refusal("dust.off", "OFF\n3 1 0\n0 0 0\n1e-35 0 0\n0 1e-35 0\n3 0 1 2\n")
                .find("the largest coordinate is 1e-35"),
            std::string::npos);
}

TEST(FacetReaders, WhatIsNoFacetedFileIsTold) {
  const TemporaryFile step("model.step", "ISO-10303-21;");
  EXPECT_FALSE(is_faceted_file(step.path()));
  EXPECT_FALSE(is_faceted_file("absent.stl"));
  EXPECT_THROW(read_facets(step.path()), CadError);
  EXPECT_THROW(read_facets("absent.stl"), std::ios_base::failure);
}

TEST(FacetReaders, SolidsOfAnStlAreGroups) {
  const FacetSoup other = box_soup({5, 0, 0}, {6, 1, 1});
  const FacetSoup soup =
      read_text("two.stl", faceted::ascii_stl(box, "left wing") + faceted::ascii_stl(other, "right"));
  ASSERT_EQ(soup.groups.size(), 2U);
  EXPECT_EQ(soup.groups[0].name, "left wing");
  EXPECT_EQ(soup.groups[1].name, "right");
  EXPECT_EQ(soup.group_of.front(), 0);
  EXPECT_EQ(soup.group_of.back(), 1);
  EXPECT_EQ(look_at_facets(soup).components, 2);
}

TEST(FacetReaders, ObjKnowsPolygonsGroupsAndNumbersFromTheEnd) {
  const FacetSoup soup = read_text("quads.obj",
                                   "# a comment\r\no body\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0 1.0\r\n"
                                   "vt 0 0\r\nvn 0 0 1\r\ng floor\r\nf 1/1/1 2/1/1 3//1 4\r\nv 0 0 1e0\r\n"
                                   "g\r\nusemtl steel\r\nf -5 \\\r\n -1 -4\r\n");
  EXPECT_EQ(soup.triangles.size(), 3U);
  ASSERT_EQ(soup.groups.size(), 2U);
  EXPECT_EQ(soup.groups[0], (FacetSoup::Group{"floor", "body"}));
  EXPECT_EQ(soup.groups[1], (FacetSoup::Group{"steel", "body"}));
  EXPECT_EQ(soup.triangles.back(), (std::array<std::int32_t, 3>{0, 4, 1}));
}

TEST(FacetReaders, OffMayHaveNormalsColoursAndConcavePolygons) {
  const FacetSoup soup =
      read_text("arrow.off",
                "CNOFF 4 1 0 # counts may stand here\n0 0 0  0 0 1  .5 .5 .5\n4 0 0  0 0 1  1 1 1\n"
                "1 1 0  0 0 1  0 0 0\n0 4 0  0 0 1  0 0 0\n4  0 1 2 3  0.1 0.2 0.3\n");
  const FacetFacts facts = look_at_facets(soup);
  EXPECT_EQ(facts.triangles, 2);
  EXPECT_NEAR(facts.area, 4, 1e-12);  // less than the quarter square: the polygon is concave
}

TEST(FacetReaders, PolyHasFacetsOfSeveralPolygonsMarkersAndRegions) {
  const FacetSoup soup = read_text("cube.poly", faceted::poly_text());
  EXPECT_EQ(soup.filling, Filling::all);
  ASSERT_EQ(soup.regions.size(), 2U);
  EXPECT_EQ(soup.regions[1].name, "region_20");
  ASSERT_EQ(soup.groups.size(), 4U);
  const FacetFacts facts = look_at_facets(soup);
  EXPECT_EQ(facts.groups[2].name, "marker_3");
  EXPECT_EQ(facts.groups[2].triangles, 10);
  EXPECT_NEAR(facts.groups[2].area, 4, 1e-12);
  EXPECT_NEAR(facts.area, 4 * 3 + 16, 1e-12);
  EXPECT_EQ(facts.junction_sides, 4);
}

TEST(FacetReaders, DamageIsNamedWithItsPlace) {
  EXPECT_NE(refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n").find("line 5"),
            std::string::npos);
  EXPECT_NE(refusal("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n").find("line 6"), std::string::npos);
  EXPECT_NE(refusal("c.off", "OFF\n3000000000 1 0\n0 0 0\n").find("room"), std::string::npos);
  EXPECT_NE(refusal("d.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n").find("line 6"), std::string::npos);
  EXPECT_NE(refusal("e.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").find("line 4"), std::string::npos);
  EXPECT_NE(refusal("f.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n").find("line 4"),
            std::string::npos);
  EXPECT_NE(refusal("g.stl", faceted::binary_stl(box).substr(0, 300)).find("byte 300"), std::string::npos);
  std::string infinite = faceted::binary_stl(box);
  infinite.replace(96 + 50, 4, std::string("\0\0\x80\x7f", 4));
  EXPECT_NE(refusal("h.stl", infinite).find("byte 146"), std::string::npos);
  EXPECT_NE(
      refusal("i.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n")
          .find("room"),
      std::string::npos);
  EXPECT_NE(refusal("j.stl", "solid nothing\nendsolid nothing\n").find("no triangles"), std::string::npos);
  EXPECT_NE(refusal("k.poly", "3 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n1 0\n1 0\n3 1 2 7\n").find("no point 7"),
            std::string::npos);
}

/// Bytes are changed, taken out, or cut off at the end: the reader refuses with CadError, or reads something.
void damage(const std::string& name, const std::string& good, int cases) {
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  int refused = 0;
  for (int i = 0; i < cases; ++i) {
    std::string bytes = good;
    const int kind = i % 4;
    if (kind == 0) bytes.resize(below(bytes.size()));
    if (kind == 1) bytes[below(bytes.size())] = static_cast<char>(random());
    if (kind == 2) bytes.erase(below(bytes.size()), 1 + below(9));
    if (kind == 3) {
      for (int k = 0; k < 8; ++k)
        bytes[below(std::min<std::size_t>(bytes.size(), 400))] ^= static_cast<char>(1U << below(8));
    }
    SCOPED_TRACE(name + ", case " + std::to_string(i));
    try {
      const FacetFacts facts = look_at_facets(read_text(name, bytes));
      EXPECT_GT(facts.triangles, 0);
    } catch (const CadError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, cases / 8);
  EXPECT_LT(refused, cases);
}

TEST(FacetReaders, DamagedFilesNeverCrash) {
  damage("a.stl", faceted::ascii_stl(box), 200);
  damage("b.stl", faceted::binary_stl(box), 200);
  damage("c.off", faceted::off_text(box), 200);
  damage("d.obj", faceted::obj_text(box), 200);
  damage("e.ply", faceted::ply_text(box), 200);
  damage("f.ply", faceted::ply_bytes(box, false), 200);
  damage("g.poly", faceted::poly_text(), 200);
  damage("h.smesh",
         "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n4 0\n3 1 2 3\n3 1 2 4\n3 2 3 4\n3 1 3 4\n0\n0\n", 200);
}

}  // namespace
}  // namespace aeroloom::cad
