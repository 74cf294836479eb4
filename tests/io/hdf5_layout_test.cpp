#include "io/cgns/cgns_layout.hpp"
#include "io/cgns/cgns_names.hpp"
#include "io/hdf5/file_layout.hpp"
#include "io/hdf5/input_file.hpp"
#include "io/vtkhdf/vtkhdf_layout.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;

/// A file of this test alone, written by one process.
class Hdf5LayoutLocal : public testing::Test {
protected:
  void SetUp() override {
    path = fs::temp_directory_path() / ("aeroloom_layout_" + std::to_string(getpid()) + ".h5");
  }
  void TearDown() override { fs::remove(path); }

  /// The structure with holes for what was reserved: such a file may be far larger than the disk.
  void write(const std::vector<hdf5::Extent>& structure) const {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    for (const hdf5::Extent& extent : structure) {
      file.seekp(extent.offset);
      file.write(reinterpret_cast<const char*>(extent.content.data()),
                 static_cast<std::streamsize>(extent.content.size()));
    }
    ASSERT_TRUE(file.good());
  }
  template <class T>
  void put(std::int64_t offset, T item) const {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(offset);
    file.write(reinterpret_cast<const char*>(&item), sizeof item);
    ASSERT_TRUE(file.good());
  }

  std::string path;
};

TEST_F(Hdf5LayoutLocal, ImagesKeepWhatIsWrittenAndNothingElse) {
  std::mt19937 random(1);
  hdf5::MemoryImage image;
  constexpr std::size_t size = 20000;
  std::vector<std::byte> expected(size);
  std::vector<bool> is_written(size);
  for (int i = 0; i < 60; ++i) {
    const std::size_t begin = random() % (size - 700), length = random() % 700;
    const std::vector<std::byte> bytes(length, static_cast<std::byte>(i + 1));
    image.write(begin, bytes);
    std::copy(bytes.begin(), bytes.end(), expected.begin() + static_cast<std::ptrdiff_t>(begin));
    std::fill_n(is_written.begin() + static_cast<std::ptrdiff_t>(begin), length, true);
  }
  std::vector<std::byte> all(size);
  image.read(0, all);
  EXPECT_TRUE(all == expected);
  std::size_t at = 0;
  for (const hdf5::Extent& extent : image.extents()) {
    const auto begin = static_cast<std::size_t>(extent.offset);
    EXPECT_TRUE(at == 0 || begin > at);  // runs that touch are one
    for (; at < begin; ++at) EXPECT_FALSE(is_written[at]);
    for (const std::byte byte : extent.content) {
      EXPECT_TRUE(is_written[at]);
      EXPECT_EQ(byte, expected[at++]);
    }
  }
  for (; at < size; ++at) EXPECT_FALSE(is_written[at]);
  EXPECT_LE(image.end(), size);
}

TEST_F(Hdf5LayoutLocal, SaysWhatTheLibraryRefuses) {
  hdf5::FileLayout layout;
  try {
    layout.add_group("/missing/group");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/missing/group: "), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find("no reason"), std::string::npos) << error.what();
  }
}

/// Three partitions of a thousand million tetrahedra each.
std::vector<vtkhdf::GridCounts> large_partitions() {
  return std::vector<vtkhdf::GridCounts>(3, {170'000'000, 1'000'000'000, 4'000'000'000});
}

TEST_F(Hdf5LayoutLocal, GridsOfThousandsOfMillionsOfCellsHaveTheirPlaces) {
  hdf5::FileLayout layout;
  const vtkhdf::GridPlaces places = vtkhdf::lay_out_grid(layout, large_partitions(), "region");
  const vtkhdf::BoundaryPlaces boundary = vtkhdf::lay_out_boundary(layout, 2'500'000'000, 7'500'000'000, {});
  const std::vector<hdf5::Extent> structure = layout.finish();
  std::vector<std::pair<std::int64_t, std::int64_t>> arrays = {
      {places.points, 510'000'000LL * 24},     {places.connectivity, 12'000'000'000LL * 8},
      {places.offsets, 3'000'000'003LL * 8},   {places.types, 3'000'000'000LL},
      {places.numbers, 510'000'000LL * 8},     {places.parts, 3'000'000'000LL * 4},
      {places.ids, 3'000'000'000LL * 4},       {boundary.connectivity, 7'500'000'000LL * 8},
      {boundary.offsets, 2'500'000'001LL * 8}, {boundary.types, 2'500'000'000LL},
      {boundary.patches, 2'500'000'000LL * 4}};
  for (const hdf5::Extent& extent : structure)
    arrays.emplace_back(extent.offset, static_cast<std::int64_t>(extent.content.size()));
  std::sort(arrays.begin(), arrays.end());
  for (std::size_t i = 1; i < arrays.size(); ++i)
    EXPECT_LE(arrays[i - 1].first + arrays[i - 1].second, arrays[i].first);

  write(structure);
  put(places.connectivity + 11'999'999'999LL * 8, std::int64_t{169'999'999});
  put(places.offsets + 3'000'000'002LL * 8, std::int64_t{4'000'000'000});
  put(places.points + (510'000'000LL * 3 - 1) * 8, 0.25);
  put(boundary.patches + 2'499'999'999LL * 4, std::int32_t{-7});
  const hdf5::InputFile file(path);
  EXPECT_EQ(file.integers("/VTKHDF/NumberOfConnectivityIds", 0, 3),
            std::vector(3, std::int64_t{4'000'000'000}));
  EXPECT_EQ(file.integers("/VTKHDF/Connectivity", 11'999'999'998, 2),
            (std::vector<std::int64_t>{0, 169'999'999}));
  EXPECT_EQ(file.integers("/VTKHDF/Offsets", 3'000'000'002, 1), std::vector(1, std::int64_t{4'000'000'000}));
  EXPECT_EQ(file.reals("/VTKHDF/Points", 509'999'999, 1), (std::vector<double>{0, 0, 0.25}));
  EXPECT_EQ(file.integers("/Boundary/Patch", 2'499'999'999, 1), std::vector(1, std::int64_t{-7}));
  EXPECT_THROW(file.integers("/Boundary/Patch", 2'499'999'999, 2), std::runtime_error);
}

cgns::Totals totals_of(mesh::GlobalIndex vertices, mesh::GlobalIndex tetrahedra,
                       mesh::GlobalIndex triangles) {
  return {vertices, {{"wall", mesh::PatchType::wall}}, {"fluid"}, {{tetrahedra, 0, 0}}, {{triangles, 0}}};
}

TEST_F(Hdf5LayoutLocal, CgnsTakes64BitsWhere32DoNotDo) {
  using hdf5::ItemType;
  constexpr mesh::GlobalIndex largest = (mesh::GlobalIndex{1} << 31) - 1;
  EXPECT_EQ(cgns::plan_file(totals_of(1000, 100, 100)).index_type, ItemType::int32);
  EXPECT_EQ(cgns::plan_file(totals_of(largest, 100, 100)).index_type, ItemType::int32);
  EXPECT_EQ(cgns::plan_file(totals_of(largest + 1, 100, 100)).index_type, ItemType::int64);
  EXPECT_EQ(cgns::plan_file(totals_of(1000, largest / 4, 100)).index_type, ItemType::int32);
  EXPECT_EQ(cgns::plan_file(totals_of(1000, largest / 4 + 1, 100)).index_type, ItemType::int64);
  cgns::Totals split = totals_of(1000, largest / 4, 100);  // no array is too long, but the last number is
  split.regions = {"a", "b", "c", "d", "e"};
  split.region_cells.assign(5, {largest / 4, 0, 0});
  EXPECT_EQ(cgns::plan_file(split).index_type, ItemType::int64);
}

TEST_F(Hdf5LayoutLocal, CgnsOfThousandsOfMillionsOfCells) {
  cgns::Plan plan = cgns::plan_file(totals_of(510'000'000, 3'000'000'000, 2'500'000'000));
  write(cgns::lay_out(plan));
  ASSERT_EQ(plan.sections.size(), 2U);
  EXPECT_EQ(plan.sections[1].first, 3'000'000'001);
  put(plan.sections[0].offset + 11'999'999'999LL * 8, std::int64_t{510'000'000});
  put(plan.sections[1].offset + 7'499'999'999LL * 8, std::int64_t{509'999'999});
  put(plan.coordinates[2] + 509'999'999LL * 8, -0.5);
  const hdf5::InputFile file(path);
  const std::string zone = "/Base/Zone/";
  EXPECT_EQ(file.integers(zone + " data", 0, 3), (std::vector<std::int64_t>{510'000'000, 3'000'000'000, 0}));
  EXPECT_EQ(file.integers(zone + "fluid/ElementConnectivity/ data", 11'999'999'999, 1),
            std::vector(1, std::int64_t{510'000'000}));
  EXPECT_EQ(file.integers(zone + "wall/ElementConnectivity/ data", 7'499'999'999, 1),
            std::vector(1, std::int64_t{509'999'999}));
  EXPECT_EQ(file.integers(zone + "wall/ElementRange/ data", 0, 2),
            (std::vector<std::int64_t>{3'000'000'001, 5'500'000'000}));
  EXPECT_EQ(file.reals(zone + "GridCoordinates/CoordinateZ/ data", 509'999'999, 1), std::vector(1, -0.5));
  const auto survey = file.survey({{}, {{zone + "wall/ElementConnectivity", "type"}}, "", {}});
  EXPECT_EQ(survey.attributes[0], "I8");
}

TEST_F(Hdf5LayoutLocal, CgnsNamesAreFitAndDifferent) {
  cgns::NodeNames names;
  names.reserve("ZoneBC");
  EXPECT_EQ(names.take("wing", "Patch"), "wing");
  EXPECT_EQ(names.take("wing", "Patch"), "wing_2");
  EXPECT_EQ(names.take("ZoneBC", "Patch"), "ZoneBC_2");
  EXPECT_EQ(names.take("a/b", "Patch"), "a_b");
  EXPECT_EQ(names.take("a_b", "Patch"), "a_b_2");
  EXPECT_EQ(names.take("", "Patch"), "Patch");
  EXPECT_EQ(names.take("..", "Patch"), "__");
  EXPECT_EQ(names.take(" far field ", "Patch"), "_far field_");
  const std::string long_name(40, 'x');
  EXPECT_EQ(names.take(long_name, "Patch"), std::string(32, 'x'));
  EXPECT_EQ(names.take(long_name, "Patch"), std::string(30, 'x') + "_2");
  EXPECT_EQ(names.take(long_name, "Patch", "_TRI_3"), std::string(26, 'x') + "_TRI_3");
  EXPECT_EQ(names.take(std::string(31, 'y') + "\u00e9", "Patch"), std::string(31, 'y'));  // not half a letter
  std::set<std::string> all;
  for (int i = 0; i < 2000; ++i) {
    const std::string name = names.take(long_name, "Patch");
    EXPECT_LE(name.size(), cgns::longest_name);
    EXPECT_TRUE(cgns::is_fit(name)) << name;
    EXPECT_TRUE(all.insert(name).second) << name;
  }
}

TEST_F(Hdf5LayoutLocal, CgnsSectionsFollowEachOther) {
  cgns::Totals totals{100,
                      {{"inner", mesh::PatchType::interior},
                       {"a/b", mesh::PatchType::inlet},
                       {"a_b", mesh::PatchType::farfield},
                       {"unused", mesh::PatchType::wall},
                       {"fluid", mesh::PatchType::slip}},
                      {"fluid", "layer"},
                      {{50, 0, 0, 0}, {1, 2, 3, 4}},
                      {{9, 9}, {4, 0}, {5, 6}, {0, 0}, {0, 7}}};
  cgns::Plan plan = cgns::plan_file(totals);
  std::vector<std::string> names;
  mesh::GlobalIndex next = 1;
  for (const cgns::Section& section : plan.sections) {
    names.push_back(section.name);
    EXPECT_EQ(section.first, next);
    next += section.count;
  }
  EXPECT_EQ(names, (std::vector<std::string>{"fluid_2", "layer_TETRA_4", "layer_PYRA_5", "layer_PENTA_6",
                                             "layer_HEXA_8", "a_b_2", "a_b_TRI_3", "a_b_QUAD_4", "fluid"}));
  EXPECT_EQ(plan.cells, 60);
  ASSERT_EQ(plan.boundaries.size(), 3U);
  EXPECT_EQ(plan.boundaries[0].name, "a_b_2");
  EXPECT_EQ(plan.boundaries[0].full_name, "a/b");
  EXPECT_EQ(plan.boundaries[0].condition, "BCInflow");
  EXPECT_EQ(plan.boundaries[1].name, "a_b");
  EXPECT_EQ(plan.boundaries[1].first, 65);
  EXPECT_EQ(plan.boundaries[1].last, 75);
  EXPECT_EQ(plan.boundaries[2].condition, "BCWallInviscid");
  EXPECT_EQ(plan.section_of_patch[0], (std::array<std::int32_t, 2>{-1, -1}));
  EXPECT_EQ(plan.section_of_patch[4], (std::array<std::int32_t, 2>{-1, 8}));
  EXPECT_NO_THROW(cgns::lay_out(plan));
}

}  // namespace
}  // namespace aeroloom::io
