#include "io/raw_mesh.hpp"
#include "io/vtk/cell_quality.hpp"
#include "io/vtk/vtk_reader.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "io/vtk_order.hpp"
#include "mesh/quality/quality.hpp"
#include "tests/io/mesh_volumes.hpp"
#include "tests/io/mixed_mesh.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/several_ranks.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPPolyDataReader.h>
#include <vtkXMLPUnstructuredGridReader.h>

namespace aeroloom::io {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using parallel::Communicator;

class VtkMixed : public examples::ScratchFolder {};

TEST_F(VtkMixed, ComesBackTheSame) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 5);
  for (const Compression compression : {Compression::none, Compression::lz4, Compression::zlib}) {
    write_volume(mesh, folder, "mesh", compression);
    const Assembled read = assemble(read_vtk({world, path("mesh.pvtu")}), 4);
    EXPECT_EQ(read.turned_cells, 0);
    EXPECT_EQ(read.dropped_points, 0);
    EXPECT_EQ(read.unnamed_faces, 0);
    EXPECT_EQ(read.left_out_faces, 0);
    EXPECT_EQ(read.mesh.vertex_count, mesh.vertex_count);
    EXPECT_EQ(read.mesh.patches, mesh.patches);
    EXPECT_EQ(read.mesh.regions, mesh.regions);
    EXPECT_EQ(read.mesh.patch_faces, mesh.patch_faces);
    EXPECT_EQ(read.mesh.region_cells, mesh.region_cells);
    const auto there = examples::volumes_of(mesh), back = examples::volumes_of(read.mesh);
    for (std::size_t s = 0; s < cell_shape_count; ++s) EXPECT_NEAR(back[s], there[s], 1e-12 * there[s]);
  }
}

TEST_F(VtkMixed, IsTheSameBytesOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const FileMesh mesh = examples::mixed_mesh(world, 5, 7);
  write_volume(mesh, folder / "all", "mesh");
  write_surface(mesh, folder / "all", "surface");
  if (!world.is_root()) return;
  const Communicator self = Communicator::self();
  const FileMesh alone = examples::mixed_mesh(self, 5, 7);
  write_volume(alone, folder / "alone", "mesh");
  write_surface(alone, folder / "alone", "surface");
  const auto here = examples::files_below(folder / "all");
  EXPECT_EQ(here.size(), 4U);
  EXPECT_TRUE(here == examples::files_below(folder / "alone"));
}

TEST_F(VtkMixed, HasVtksOrderAndArrays) {
  const examples::MixedMesh whole(3, 2);
  const FileMesh mesh = examples::mixed_mesh(world, 3, 2);
  write_volume(mesh, folder, "mesh");
  vtkNew<vtkXMLPUnstructuredGridReader> reader;
  reader->SetFileName(path("mesh.pvtu").c_str());
  reader->Update();
  vtkUnstructuredGrid& grid = *reader->GetOutput();
  ASSERT_EQ(grid.GetNumberOfCells(), mesh.cell_count());
  EXPECT_EQ(grid.GetNumberOfPoints(), mesh.vertex_count);
  std::array<GlobalIndex, cell_shape_count> counts{};
  for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
    vtkNew<vtkIdList> corners;
    grid.GetCellPoints(c, corners);
    std::vector<Vec3> p;
    for (vtkIdType k = 0; k < corners->GetNumberOfIds(); ++k) {
      double x[3];
      grid.GetPoint(corners->GetId(k), x);
      p.push_back({x[0], x[1], x[2]});
    }
    ++counts[std::min<std::size_t>(p.size(), 7) - 4];
    // VTK's numerals: the base of a pyramid sees its apex, the first triangle of a prism looks outward.
    const double volume = dot(cross(p[1] - p[0], p[2] - p[0]), p.back() - p[0]);
    EXPECT_GT(p.size() == 6 ? -volume : volume, 0);
    EXPECT_EQ(grid.GetCellType(c), p.size() == 4 ? 10 : p.size() == 5 ? 14 : p.size() == 6 ? 13 : 12);
    const double ratio = grid.GetCellData()->GetArray("mean_ratio")->GetTuple1(c);
    EXPECT_GT(ratio, 0.3);
    EXPECT_LE(ratio, 1);
    EXPECT_GT(grid.GetCellData()->GetArray("min_dihedral")->GetTuple1(c), 15);
  }
  for (const CellShape shape : cell_shapes)
    EXPECT_EQ(counts[static_cast<std::size_t>(shape)], mesh.cell_count(shape));
  vtkFieldData& fields = *grid.GetFieldData();
  ASSERT_NE(fields.GetAbstractArray("patch_types"), nullptr);
  EXPECT_EQ(vtkStringArray::SafeDownCast(fields.GetAbstractArray("patch_names"))->GetValue(0),
            "wing / lower side");
  EXPECT_EQ(vtkStringArray::SafeDownCast(fields.GetAbstractArray("patch_types"))->GetValue(3), "interior");
  EXPECT_EQ(vtkStringArray::SafeDownCast(fields.GetAbstractArray("region_names"))->GetValue(1), "upper");
  EXPECT_EQ(fields.GetArray("boundary_patch")->GetNumberOfTuples(),
            static_cast<vtkIdType>(whole.faces.size()));
}

TEST_F(VtkMixed, ShowsItsBoundaryWithPatches) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  write_surface(mesh, folder, "surface");
  vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName(path("surface.pvtp").c_str());
  reader->Update();
  vtkPolyData& surface = *reader->GetOutput();
  std::vector<std::array<GlobalIndex, face_shape_count>> counts(mesh.patches.size());
  Vec3 closed;
  for (vtkIdType f = 0; f < surface.GetNumberOfCells(); ++f) {
    vtkNew<vtkIdList> corners;
    surface.GetCellPoints(f, corners);
    const auto patch = static_cast<std::size_t>(surface.GetCellData()->GetArray("patch")->GetTuple1(f));
    ++counts.at(patch)[static_cast<std::size_t>(corners->GetNumberOfIds() - 3)];
    const auto p = [&](vtkIdType k) {
      double x[3];
      surface.GetPoint(corners->GetId(k), x);
      return Vec3{x[0], x[1], x[2]};
    };
    for (vtkIdType k = 2; k < corners->GetNumberOfIds(); ++k) closed += cross(p(k - 1) - p(0), p(k) - p(0));
  }
  std::vector<std::array<GlobalIndex, face_shape_count>> outside = mesh.patch_faces;
  outside[examples::MixedMesh::interface] = {};
  EXPECT_EQ(counts, outside);
  EXPECT_NEAR(norm(closed), 0, 1e-11) << "all look outward";
  EXPECT_EQ(surface.GetPointData()->GetArray("global_id")->GetDataTypeSize(), 8);
  EXPECT_EQ(surface.GetFieldData()->GetAbstractArray("patch_types")->GetNumberOfValues(), 4);
}

TEST_F(VtkMixed, ShowsFacesBetweenRegionsByThemselves) {
  const FileMesh mesh = examples::mixed_mesh(world, 4, 3);
  write_surface(mesh, folder, "interfaces", Compression::none, SurfaceFaces::between_regions);
  vtkNew<vtkXMLPPolyDataReader> reader;
  reader->SetFileName(path("interfaces.pvtp").c_str());
  reader->Update();
  vtkPolyData& surface = *reader->GetOutput();
  ASSERT_EQ(surface.GetNumberOfCells(), mesh.patch_faces[examples::MixedMesh::interface][0]);
  for (vtkIdType f = 0; f < surface.GetNumberOfCells(); ++f)
    EXPECT_EQ(surface.GetCellData()->GetArray("patch")->GetTuple1(f), examples::MixedMesh::interface);
}

TEST(CellQualityLocal, IsOneForRegularCells) {
  const double h = std::sqrt(3) / 2;
  const std::vector<Vec3> prism = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, h, 1}};
  const std::vector<Vec3> pyramid = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, std::sqrt(0.5)}};
  const std::vector<Vec3> tet = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0.5, h / 3, std::sqrt(2.0 / 3)}};
  EXPECT_NEAR(mean_ratio(CellShape::prism, prism), 1, 1e-14);
  EXPECT_NEAR(mean_ratio(CellShape::pyramid, pyramid), 1, 1e-14);
  EXPECT_NEAR(mean_ratio(CellShape::tetrahedron, tet), 1, 1e-14);
  EXPECT_NEAR(smallest_dihedral(CellShape::prism, prism), 60, 1e-12);
  EXPECT_NEAR(smallest_dihedral(CellShape::pyramid, pyramid), std::acos(std::sqrt(1.0 / 3)) * 180 / M_PI,
              1e-12);
  EXPECT_NEAR(smallest_dihedral(CellShape::tetrahedron, tet), std::acos(1.0 / 3) * 180 / M_PI, 1e-12);
}

TEST(CellQualityLocal, FallsWithTheWorstCornerAndIsNegativeWhereInverted) {
  std::vector<Vec3> prism = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const double right = mean_ratio(CellShape::prism, prism);
  EXPECT_GT(right, 0.5);
  EXPECT_LT(right, 1);
  EXPECT_NEAR(smallest_dihedral(CellShape::prism, prism), 45, 1e-12);
  prism[3].z = 0.1;
  EXPECT_LT(mean_ratio(CellShape::prism, prism), right);
  prism[3].z = -0.1;
  EXPECT_LT(mean_ratio(CellShape::prism, prism), 0);
  for (int k = 0; k < 3; ++k) prism[k + 3] = prism[k];
  EXPECT_EQ(mean_ratio(CellShape::prism, prism), 0);
  const std::vector<Vec3> mirrored = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}, {0.5, 0.5, 0.7}};
  EXPECT_LT(mean_ratio(CellShape::pyramid, mirrored), 0);
}

}  // namespace
}  // namespace aeroloom::io
