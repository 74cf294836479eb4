#include "io/vtk/vtk_writer.hpp"

#include "mesh/quality/quality.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPPolyDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLPolyDataReader.h>

namespace aeroloom::io {
namespace {

namespace fs = std::filesystem;
using parallel::Communicator;

class VtkWriter : public examples::ScratchFolder {
protected:
  void write_cube(const Communicator& communicator, int n, int pieces, const std::string& where) {
    const auto mesh = mesh::examples::cube(communicator, n, pieces);
    write_volume(file_mesh_of(mesh::number_mesh(mesh)), where, "mesh");
    const auto surface = mesh::examples::cube_surface(communicator, n, pieces);
    write_surface(mesh::number_mesh(surface), where, "surface");
  }
};

TEST_F(VtkWriter, WritesTetrahedraThatReadBackTheSame) {
  write_cube(world, 4, 7, folder / "here");
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName((folder / "here" / "mesh.pvtu").c_str());
  reader->Update();
  vtkUnstructuredGrid& grid = *reader->GetOutput();
  ASSERT_EQ(grid.GetNumberOfCells(), 6 * 64);
  EXPECT_EQ(grid.GetNumberOfPoints(), 125);  // one part: shared vertices are merged
  auto& ids = *grid.GetPointData()->GetArray("global_id");
  auto& piece = *grid.GetCellData()->GetArray("piece");
  auto& ratio = *grid.GetCellData()->GetArray("mean_ratio");
  auto& angle = *grid.GetCellData()->GetArray("min_dihedral");
  EXPECT_EQ(ids.GetDataTypeSize(), 8);
  EXPECT_EQ(grid.GetPoints()->GetDataType(), VTK_DOUBLE);
  if (world.is_root()) {
    const std::string part = examples::files_below(folder / "here")["mesh/mesh_000000.vtu"];
    EXPECT_NE(part.find("type=\"Int32\" Name=\"connectivity\""), std::string::npos);
    EXPECT_EQ(part.find("compressor"), std::string::npos);
  }
  const auto mesh = mesh::examples::cube(Communicator::self(), 4, 7);
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const auto& expected = mesh.pieces[i];
    for (mesh::LocalIndex c = 0; c < expected.cell_count(); ++c) {
      const vtkIdType cell = numbered.numbering.first_cell[i] + c;
      ASSERT_EQ(grid.GetCellType(cell), VTK_TETRA);
      vtkNew<vtkIdList> corners;
      grid.GetCellPoints(cell, corners);
      for (int k = 0; k < 4; ++k) {
        const mesh::LocalIndex v = expected.cell(c)[k];
        EXPECT_EQ(ids.GetTuple1(corners->GetId(k)), numbered.numbering.vertices[i][v]);
        double p[3];
        grid.GetPoint(corners->GetId(k), p);
        EXPECT_EQ((geometry::Vec3{p[0], p[1], p[2]}), expected.point(v));
      }
      const auto p = [&](int k) { return expected.point(expected.cell(c)[k]); };
      EXPECT_EQ(piece.GetTuple1(cell), expected.id);
      EXPECT_EQ(ratio.GetTuple1(cell), static_cast<float>(mesh::mean_ratio(p(0), p(1), p(2), p(3))));
      EXPECT_EQ(angle.GetTuple1(cell),
                static_cast<float>(mesh::dihedral_range(p(0), p(1), p(2), p(3)).smallest));
    }
  }
}

TEST_F(VtkWriter, CompressedFilesAreSmallerAndHoldTheSame) {
  const auto mesh = mesh::examples::cube(world, 12, 3);
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  struct Read {
    std::uintmax_t bytes = 0;
    std::vector<double> coordinates, ids, connectivity;
  };
  const auto read = [&](Compression compression, const char* name) {
    write_volume(file_mesh_of(numbered), folder, name, compression);
    vtkNew<vtkXMLPUnstructuredGridReader> reader;
    reader->SetFileName((folder / (std::string(name) + ".pvtu")).c_str());
    reader->Update();
    vtkUnstructuredGrid& grid = *reader->GetOutput();
    Read result;
    for (const auto& [file, bytes] : examples::files_below(folder / name)) result.bytes += bytes.size();
    for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) {
      for (int axis = 0; axis < 3; ++axis) result.coordinates.push_back(grid.GetPoint(i)[axis]);
      result.ids.push_back(grid.GetPointData()->GetArray("global_id")->GetTuple1(i));
    }
    for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
      vtkNew<vtkIdList> corners;
      grid.GetCellPoints(c, corners);
      for (int k = 0; k < 4; ++k) result.connectivity.push_back(static_cast<double>(corners->GetId(k)));
    }
    return result;
  };
  const Read plain = read(Compression::none, "plain");
  ASSERT_EQ(plain.connectivity.size(), 4U * 6 * 12 * 12 * 12);
  for (const auto& [compression, name] : {std::pair(Compression::lz4, "lz4"), {Compression::zlib, "zlib"}}) {
    const Read packed = read(compression, name);
    EXPECT_LT(4 * packed.bytes, 3 * plain.bytes) << name;
    EXPECT_EQ(packed.coordinates, plain.coordinates) << name;
    EXPECT_EQ(packed.ids, plain.ids) << name;
    EXPECT_EQ(packed.connectivity, plain.connectivity) << name;
  }
}

TEST_F(VtkWriter, WritesTrianglesWithTheirNames) {
  write_cube(world, 3, 4, folder / "here");
  vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName((folder / "here" / "surface.pvtp").c_str());
  reader->Update();
  vtkPolyData& surface = *reader->GetOutput();
  EXPECT_EQ(surface.GetNumberOfCells(), 6 * 2 * 9);
  EXPECT_EQ(surface.GetNumberOfPoints(), 56);
  for (vtkIdType t = 0; t < surface.GetNumberOfCells(); ++t) {
    const int face = static_cast<int>(surface.GetCellData()->GetArray("face")->GetTuple1(t));
    EXPECT_EQ(surface.GetCellData()->GetArray("patch")->GetTuple1(t), face / 2);
    double p[3];
    surface.GetPoint(surface.GetCell(t)->GetPointId(0), p);
    EXPECT_EQ(p[face / 2], face % 2);
    EXPECT_NEAR(surface.GetCellData()->GetArray("quality")->GetTuple1(t), std::sqrt(0.75), 1e-6);
  }
  vtkNew<vtkXMLPolyDataReader> part;
  part->SetFileName((folder / "here" / "surface" / "surface_000000.vtp").c_str());
  part->Update();
  auto* faces =
      vtkStringArray::SafeDownCast(part->GetOutput()->GetFieldData()->GetAbstractArray("face_names"));
  auto* patches =
      vtkStringArray::SafeDownCast(part->GetOutput()->GetFieldData()->GetAbstractArray("patch_names"));
  ASSERT_NE(faces, nullptr);
  ASSERT_NE(patches, nullptr);
  ASSERT_EQ(faces->GetNumberOfValues(), 6);
  EXPECT_EQ(faces->GetValue(3), "y+");
  ASSERT_EQ(patches->GetNumberOfValues(), 3);
  EXPECT_EQ(patches->GetValue(2), "z sides");
}

TEST_F(VtkWriter, WritesTheSameBytesOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  write_cube(world, 4, 9, folder / "here");
  if (world.is_root()) {
    write_cube(Communicator::self(), 4, 9, folder / "alone");
    const auto here = examples::files_below(folder / "here");
    EXPECT_EQ(here.size(), 4U);
    EXPECT_TRUE(here == examples::files_below(folder / "alone"));
  }
}

/// A square sheet of 2 n^2 triangles as one piece, beside the others in x; columns of vertices are shared.
mesh::Piece sheet(mesh::PieceId id, int n) {
  mesh::Piece piece;
  piece.id = id;
  piece.kind = mesh::CellKind::triangle;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      piece.coordinates.insert(piece.coordinates.end(),
                               {id + static_cast<double>(i) / n, static_cast<double>(j), 0});
      if (i % n == 0) {
        piece.shared_vertices.push_back(i * (n + 1) + j);
        piece.shared_keys.push_back(static_cast<mesh::SharedVertexKey>(id + i / n) * 1000000 + j);
      }
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const mesh::LocalIndex a = i * (n + 1) + j, b = a + n + 1;
      piece.cells.insert(piece.cells.end(), {a, b, b + 1, a, b + 1, a + 1});
    }
  }
  piece.vertex_dimension.assign(piece.vertex_count(), mesh::CadDimension::face);
  piece.vertex_entity.assign(piece.vertex_count(), 0);
  piece.triangle_face.assign(piece.cell_count(), id);
  piece.triangle_patch.assign(piece.cell_count(), 0);
  return piece;
}

TEST_F(VtkWriter, CutsALargeSurfaceIntoPartsThatReadTogether) {
  constexpr int n = 115, pieces = 5;  // 26,450 triangles each: parts of two pieces, the last of one
  mesh::DistributedMesh surface(world);
  surface.kind = mesh::CellKind::triangle;
  surface.piece_count = pieces;
  surface.faces = {"a", "b", "c", "d", "e"};
  surface.patches = {"wall"};
  for (int p = world.rank(); p < pieces; p += world.size()) surface.pieces.push_back(sheet(p, n));
  write_surface(mesh::number_mesh(surface), folder, "surface");
  if (!world.is_root()) return;
  std::set<std::string> names;
  for (const auto& [name, bytes] : examples::files_below(folder)) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"surface.pvtp", "surface/surface_000000.vtp",
                                          "surface/surface_000001.vtp", "surface/surface_000002.vtp"}));
  vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName((folder / "surface.pvtp").c_str());
  reader->Update();
  vtkPolyData& whole = *reader->GetOutput();
  EXPECT_EQ(whole.GetNumberOfCells(), pieces * 2 * n * n);
  EXPECT_EQ(whole.GetNumberOfPoints(), (pieces * n + 3) * (n + 1));  // the columns between parts twice
  EXPECT_EQ(whole.GetFieldData()->GetAbstractArray("face_names")->GetNumberOfValues(), pieces);
  auto& face = *whole.GetCellData()->GetArray("face");
  for (vtkIdType t = 0; t < whole.GetNumberOfCells(); t += 997) EXPECT_EQ(face.GetTuple1(t), t / (2 * n * n));
}

TEST_F(VtkWriter, LeavesOrphansOut) {
  auto mesh = mesh::examples::two_tets(world);
  for (auto& piece : mesh.pieces) {
    piece.coordinates.insert(piece.coordinates.end(), {9, 9, 9});
    piece.vertex_dimension.push_back(mesh::CadDimension::region);
    piece.vertex_entity.push_back(0);
  }
  write_volume(file_mesh_of(mesh::number_mesh(mesh)), folder, "mesh");
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName((folder / "mesh.pvtu").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 5);
}

TEST_F(VtkWriter, MakesNoMoreFilesHoweverLargeTheMesh) {
  const auto files = [](mesh::GlobalIndex cells) {
    return (cells + cells_per_vtk_file(cells) - 1) / cells_per_vtk_file(cells);
  };
  EXPECT_EQ(files(0), 0);
  EXPECT_EQ(files(900'000), 1);
  EXPECT_EQ(files(1'900'000), 2);
  EXPECT_EQ(files(10'000'000), 50);
  for (mesh::GlobalIndex cells = 1; cells < 100'000'000'000; cells = 2 * cells + 1)
    EXPECT_LE(files(cells), 501);
}

TEST_F(VtkWriter, RemovesPartsOfAnEarlierRunAndNothingElse) {
  write_cube(world, 2, 3, folder);
  if (world.is_root()) {
    std::ofstream(folder / "mesh" / "mesh_000007.vtu") << "old";
    std::ofstream(folder / "mesh" / "notes.txt") << "mine";
  }
  world.barrier();
  write_cube(world, 2, 3, folder);
  EXPECT_FALSE(fs::exists(folder / "mesh" / "mesh_000007.vtu"));
  EXPECT_TRUE(fs::exists(folder / "mesh" / "notes.txt"));
  EXPECT_TRUE(fs::exists(folder / "mesh" / "mesh_000000.vtu"));
}

TEST_F(VtkWriter, EscapesWhatXmlReserves) {
  const auto mesh = mesh::examples::two_tets(world);
  write_volume(file_mesh_of(mesh::number_mesh(mesh)), folder, "a<&\"b");
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName((folder / "a<&\"b.pvtu").c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfCells(), 2);
}

TEST_F(VtkWriter, NamesThePathItCannotCreateOnAllRanks) {
  const std::string file = path("file");
  examples::put_bytes(world, file, "a file where the folder should be");
  try {
    write_cube(world, 2, 2, file + "/out");
    FAIL() << "no rank may go on";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
    EXPECT_NE(std::string(error.what()).find(file), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
  }
}

TEST_F(VtkWriter, SaysWhenAFileCannotGrow) {
  // A limit on the size of files stands for a full disk: the system refuses to write on.
  const auto mesh = mesh::examples::cube(world, 6, 3);
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{20000, before.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  std::string message;
  try {
    write_volume(file_mesh_of(numbered), folder, "mesh");
  } catch (const parallel::CollectiveError& error) {
    message = error.what();
    EXPECT_EQ(error.kind(), parallel::FailureKind::files);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("mesh_000000.vtu"), std::string::npos) << message;
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  world.barrier();
  EXPECT_FALSE(fs::exists(folder / "mesh.pvtu"));
  EXPECT_FALSE(fs::exists(folder / "mesh" / "mesh_000000.vtu"));
}

TEST_F(VtkWriter, WritesAnEmptyMesh) {
  mesh::DistributedMesh mesh(world);
  write_volume(file_mesh_of(mesh::number_mesh(mesh)), folder, "mesh");
  EXPECT_TRUE(fs::exists(folder / "mesh.pvtu"));
}

TEST_F(VtkWriter, WritesSingleTriangles) {
  if (!world.is_root()) return;
  const auto file = folder / "deep" / "offenders.vtp";
  write_triangles({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.1}}, {{0, 1, 2}, {0, 2, 3}}, file);
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPolys(), 2);
  double p[3];
  reader->GetOutput()->GetPoint(3, p);
  EXPECT_EQ(p[2], 0.1);
}

}  // namespace
}  // namespace aeroloom::io
