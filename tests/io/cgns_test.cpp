#include "io/cgns/cgns_writer.hpp"
#include "io/hdf5/input_file.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/damage.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::io {
namespace {

using parallel::Communicator;

class Cgns : public examples::ScratchFolder {};

/// Vertices and sections as they stand in a file.
class File {
public:
  explicit File(const std::string& path) : _file(path) {
    const std::int64_t vertices = _file.integers("/Base/Zone/ data", 0, 1)[0];
    for (const char axis : {'X', 'Y', 'Z'}) {
      _coordinates.push_back(
          _file.reals(std::string("/Base/Zone/GridCoordinates/Coordinate") + axis + "/ data", 0, vertices));
    }
  }
  std::vector<std::int64_t> corners(const std::string& section, int per_element) const {
    const std::string path = "/Base/Zone/" + section;
    const auto range = _file.integers(path + "/ElementRange/ data", 0, 2);
    return _file.integers(path + "/ElementConnectivity/ data", 0, (range[1] - range[0] + 1) * per_element);
  }
  geometry::Vec3 point(std::int64_t number) const {
    const auto v = static_cast<std::size_t>(number - 1);
    return {_coordinates[0][v], _coordinates[1][v], _coordinates[2][v]};
  }
  /// Six times the volume between a face and the origin.
  double volume6(const std::int64_t* face, int corners) const {
    double volume = 0;
    for (int k = 1; k + 1 < corners; ++k)
      volume += dot(cross(point(face[0]), point(face[k])), point(face[k + 1]));
    return volume;
  }

private:
  hdf5::InputFile _file;
  std::vector<std::vector<double>> _coordinates;
};

/// The faces of elements, outward, as the SIDS number them (from 1), section 3.3.
const std::vector<std::vector<int>> tetra_faces = {{1, 3, 2}, {1, 2, 4}, {2, 3, 4}, {3, 1, 4}};
const std::vector<std::vector<int>> pyra_faces = {{1, 4, 3, 2}, {1, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5}};
const std::vector<std::vector<int>> penta_faces = {
    {1, 2, 5, 4}, {2, 3, 6, 5}, {3, 1, 4, 6}, {1, 3, 2}, {4, 5, 6}};
const std::vector<std::vector<int>> hexa_faces = {{1, 4, 3, 2}, {1, 2, 6, 5}, {2, 3, 7, 6},
                                                  {3, 4, 8, 7}, {1, 5, 8, 4}, {5, 6, 7, 8}};

TEST_F(Cgns, CellsHaveThePositiveVolumeThatTheBoundaryEncloses) {
  write_cgns(examples::mixed_mesh(world, 4, 5), folder / "mesh.cgns");
  const File file(folder / "mesh.cgns");
  double cells = 0;
  const auto add_cells = [&](const std::string& section, int corners, const auto& faces) {
    const auto items = file.corners(section, corners);
    for (std::size_t first = 0; first < items.size(); first += static_cast<std::size_t>(corners)) {
      double volume = 0;
      for (const std::vector<int>& face : faces) {
        std::vector<std::int64_t> numbers;
        for (const int k : face) numbers.push_back(items[first + static_cast<std::size_t>(k) - 1]);
        volume += file.volume6(numbers.data(), static_cast<int>(numbers.size()));
      }
      EXPECT_GT(volume, 0) << section;
      cells += volume;
    }
  };
  add_cells("lower layer_TETRA_4", 4, tetra_faces);
  add_cells("lower layer_PYRA_5", 5, pyra_faces);
  add_cells("lower layer_PENTA_6", 6, penta_faces);
  add_cells("lower layer_HEXA_8", 8, hexa_faces);
  add_cells("upper", 4, tetra_faces);
  double boundary = 0;
  for (const std::string name : {"wing _ lower side", "symmetry", "far field"}) {
    for (const int corners : {3, 4}) {
      const auto items = file.corners(name + (corners == 3 ? "_TRI_3" : "_QUAD_4"), corners);
      for (std::size_t first = 0; first < items.size(); first += static_cast<std::size_t>(corners))
        boundary += file.volume6(&items[first], corners);
    }
  }
  EXPECT_NEAR(boundary, cells, 1e-9 * cells);
}

TEST_F(Cgns, WritesTheSameBytesOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  write_cgns(examples::mixed_mesh(world, 3, 7), folder / "here");
  if (!world.is_root()) return;
  write_cgns(examples::mixed_mesh(Communicator::self(), 3, 7), folder / "alone");
  EXPECT_TRUE(examples::bytes_of(folder / "here") == examples::bytes_of(folder / "alone"));
}

TEST_F(Cgns, NamesThePathItCannotWriteOnAllRanks) {
  if (world.is_root()) std::ofstream(folder / "file") << "where the folder should be";
  world.barrier();
  try {
    write_cgns(examples::mixed_mesh(world, 2, 2), folder / "file" / "mesh.cgns");
    FAIL() << "no rank may go on";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
    EXPECT_NE(std::string(error.what()).find((folder / "file").string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace aeroloom::io
