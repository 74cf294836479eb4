#include "io/vtk/vtk_reader.hpp"

#include "io/raw_mesh.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/io/vtk_grids.hpp"

#include <functional>
#include <string>
#include <vector>

namespace aeroloom::io {
namespace {

using examples::FileForm;
using examples::GridChoice;
using examples::make_grid;
using examples::write_grid;
using mesh::GlobalIndex;
using parallel::Communicator;

class VtkReader : public examples::ScratchFolder {
protected:
  /// Rank 0 writes files, all wait.
  void on_root(const std::function<void()>& work) {
    if (world.is_root()) work();
    world.barrier();
  }
  void write_index(const std::string& name, const std::vector<std::string>& sources) {
    std::ofstream stream(path(name));
    stream
        << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" "
           "version=\"0.1\">\n<PUnstructuredGrid "
           "GhostLevel=\"0\">\n<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>\n";
    for (const std::string& source : sources) stream << "<Piece Source=\"" << source << "\"/>\n";
    stream << "</PUnstructuredGrid>\n</VTKFile>\n";
  }
  void write_parts(const std::string& index, int parts, const GridChoice& choice) {
    std::vector<std::string> sources;
    for (GridChoice part = choice; ++part.part < parts;) {
      sources.push_back("part_" + std::to_string(part.part) + ".vtu");
      write_grid(*make_grid(whole, part), path(sources.back()));
    }
    write_index(index, sources);
  }
  Assembled read(const std::string& name, int parts = 2) {
    return assemble(read_vtk({world, path(name)}), parts);
  }
  void expect_error(const std::string& name, parallel::FailureKind kind, const std::string& reason) {
    try {
      read(name);
      ADD_FAILURE() << "accepted: " << reason;
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  /// Columns of cells in four parts.
  const examples::MixedMesh whole = examples::MixedMesh(4, 4);
};

/// The fixture, whatever its ids were.
void expect_whole(const Assembled& read, const examples::MixedMesh& whole) {
  EXPECT_EQ(read.mesh.vertex_count, static_cast<GlobalIndex>(whole.points.size()));
  EXPECT_EQ(read.turned_cells, 0);
  EXPECT_EQ(read.dropped_points, 0);
  ASSERT_EQ(read.mesh.regions.size(), 2U);
  EXPECT_EQ(read.mesh.region_cells[0], (std::array<GlobalIndex, 4>{8, 20, 32, 4}));
  EXPECT_EQ(read.mesh.region_cells[1], (std::array<GlobalIndex, 4>{96, 0, 0, 0}));
}

void expect_patches(const Assembled& read) {
  ASSERT_EQ(read.mesh.patches.size(), 4U);
  EXPECT_EQ(read.mesh.patches[0].name, "patch_100");
  EXPECT_EQ(read.mesh.patches[2].name, "patch_102");
  EXPECT_EQ(read.mesh.patches[3].type, mesh::PatchType::interior) << "found, not in the file";
  EXPECT_EQ(read.mesh.patch_faces[0], (std::array<GlobalIndex, 2>{32, 8}));
  EXPECT_EQ(read.unnamed_faces, read.mesh.patch_faces[3][0]);
}

TEST_F(VtkReader, TakesCellsAndFacesOfAllForms) {
  for (const char* label : {"CellEntityIds", "gmsh:physical", "medit:ref"}) {
    for (const char* name : {"whole.vtu", "whole.vtk"}) {
      for (const FileForm form : {FileForm::raw, FileForm::packed, FileForm::encoded, FileForm::text}) {
        on_root([&] { write_grid(*make_grid(whole, {.label = label}), path(name), form); });
        const Assembled result = read(name);
        expect_whole(result, whole);
        expect_patches(result);
        EXPECT_EQ(result.mesh.regions, (std::vector<std::string>{"volume_10", "volume_11"}));
        world.barrier();
      }
    }
  }
}

TEST_F(VtkReader, WithoutLabelsThereIsOneRegionAndOnePatch) {
  on_root([&] { write_grid(*make_grid(whole, {}), path("plain.vtu")); });
  const Assembled result = read("plain.vtu");
  EXPECT_EQ(result.mesh.regions, (std::vector<std::string>{"volume"}));
  ASSERT_EQ(result.mesh.patches.size(), 1U);
  EXPECT_EQ(result.mesh.patches[0].name, "boundary");
  EXPECT_EQ(result.unnamed_faces, 0);
}

TEST_F(VtkReader, JoinsPartsByIdsOrByPlace) {
  for (const bool with_ids : {true, false}) {
    on_root([&] { write_parts("parts.pvtu", 4, {.label = "CellEntityIds", .with_ids = with_ids}); });
    const Assembled result = read("parts.pvtu");
    expect_whole(result, whole);
    expect_patches(result);
    world.barrier();
  }
}

TEST_F(VtkReader, APartWithoutPointsHasFacesOfOthers) {
  on_root([&] {
    write_parts("parts.pvtu", 4, {.label = "CellEntityIds", .with_faces = false, .with_ids = true});
    write_grid(*examples::faces_without_points(whole), path("faces.vtu"));
    write_index("parts.pvtu", {"part_0.vtu", "part_1.vtu", "part_2.vtu", "part_3.vtu", "faces.vtu"});
  });
  const Assembled result = read("parts.pvtu");
  expect_whole(result, whole);
  ASSERT_EQ(result.mesh.patches.size(), 4U);
  EXPECT_EQ(result.mesh.patches[0].name, "shell_0");
  EXPECT_EQ(result.mesh.patch_faces[0], (std::array<GlobalIndex, 2>{32, 8}));
  EXPECT_EQ(result.left_out_faces, 0);
}

TEST_F(VtkReader, MakesOneMeshWhateverTheRanks) {
  on_root([&] { write_parts("parts.pvtu", 4, {.label = "CellEntityIds"}); });
  const RawMesh mine = read_vtk({world, path("parts.pvtu")});
  const RawMesh all = read_vtk({Communicator::self(), path("parts.pvtu")});
  EXPECT_EQ(world.all_gather_items(std::span(mine.point_ids)), all.point_ids);
  EXPECT_EQ(world.all_gather_items(std::span(mine.coordinates)), all.coordinates);
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    EXPECT_EQ(world.all_gather_items(std::span(mine.cells[s])), all.cells[s]);
    EXPECT_EQ(world.all_gather_items(std::span(mine.cell_regions[s])), all.cell_regions[s]);
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    EXPECT_EQ(world.all_gather_items(std::span(mine.faces[s])), all.faces[s]);
    EXPECT_EQ(world.all_gather_items(std::span(mine.face_patches[s])), all.face_patches[s]);
  }
  EXPECT_EQ(mine.patches, all.patches);
  EXPECT_EQ(mine.regions, all.regions);
  if (world.size() == 3) {
    EXPECT_LT(mine.point_ids.size(), all.point_ids.size() / 2) << "each reads its share";
  }
}

TEST_F(VtkReader, LeavesOutGhostsPointsAndLines) {
  on_root([&] {
    const auto grid = make_grid(whole, {.with_faces = false});
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName("vtkGhostType");
    for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) ghosts->InsertNextValue(0);
    const vtkIdType first[] = {0, 1, 2, 3, 4, 5};
    for (const vtkIdType c : {5, 6, 7}) {  // once more what other parts have
      vtkNew<vtkIdList> corners;
      grid->GetCellPoints(c, corners);
      grid->InsertNextCell(grid->GetCellType(c), corners);
      ghosts->InsertNextValue(1);
    }
    grid->InsertNextCell(VTK_VERTEX, 1, first);
    grid->InsertNextCell(VTK_LINE, 2, first);
    grid->InsertNextCell(VTK_POLY_LINE, 4, first);
    for (int i = 0; i < 3; ++i) ghosts->InsertNextValue(0);
    grid->GetCellData()->AddArray(ghosts);
    write_grid(*grid, path("ghosts.vtu"));
  });
  EXPECT_EQ(read("ghosts.vtu").mesh.cell_count(), static_cast<GlobalIndex>(whole.cells.size()));
}

TEST_F(VtkReader, SaysWhichKindOfCellItCannotTake) {
  const std::vector<std::pair<int, int>> others = {{VTK_PENTAGONAL_PRISM, 10},
                                                   {VTK_VOXEL, 8},
                                                   {VTK_QUADRATIC_TETRA, 10},
                                                   {VTK_POLYGON, 5},
                                                   {VTK_TRIANGLE_STRIP, 5}};
  for (const auto& [type, corners] : others) {
    on_root([&, type = type, corners = corners] {
      const auto grid = make_grid(whole, {});
      const vtkIdType all[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
      grid->InsertNextCell(type, corners, all);
      write_grid(*grid, path("other.vtu"));
    });
    expect_error("other.vtu", parallel::FailureKind::input, "is of type " + std::to_string(type) + " (vtk");
    world.barrier();
  }
}

TEST_F(VtkReader, NamesTheFileAndThePlaceOfWhatIsWrong) {
  using parallel::FailureKind;
  expect_error("missing.vtu", FailureKind::files, "No such file");
  expect_error("missing.pvtu", FailureKind::files, "No such file");
  on_root([&] {
    std::ofstream(path("text.vtu")) << "this is no XML";
    std::ofstream(path("text.xml.vtu")) << "<VTKFile type=\"ImageData\"></VTKFile>";
    std::ofstream(path("text.vtk")) << "this is no VTK";
    std::ofstream(path("text.pvtu")) << "<VTKFile type=\"PPolyData\"><PPolyData/></VTKFile>";
    std::ofstream(path("mesh.stl")) << "solid";
    write_parts("parts.pvtu", 4, {});
    write_index("gap.pvtu", {"part_0.vtu", "part_9.vtu", "part_1.vtu"});
    write_index("bad.pvtu", {"part_0.vtu", "text.vtu"});
    GridChoice with_ids{.part = 1, .with_ids = true};
    write_grid(*make_grid(whole, with_ids), path("ids.vtu"));
    write_index("half.pvtu", {"part_0.vtu", "ids.vtu"});
    const auto grid = make_grid(whole, with_ids);
    vtkTypeInt64Array::SafeDownCast(grid->GetPointData()->GetArray("global_id"))->SetValue(3, -8);
    write_grid(*grid, path("negative.vtu"));
    std::filesystem::create_directory(path("folder.vtu"));
  });
  expect_error("text.vtu", FailureKind::input, "does not end with </VTKFile>");
  expect_error("text.xml.vtu", FailureKind::input, "VTK cannot read it");
  expect_error("text.vtk", FailureKind::input, "VTK cannot read it");
  expect_error("text.pvtu", FailureKind::input, "no index of unstructured grids");
  expect_error("mesh.stl", FailureKind::input, "'.stl' is not among");
  expect_error("gap.pvtu", FailureKind::files, "part_9.vtu");
  expect_error("bad.pvtu", FailureKind::input, "text.vtu");
  expect_error("half.pvtu", FailureKind::input, "1 of its parts have ids of points");
  expect_error("negative.vtu", FailureKind::input, "point 3 has the id -8");
  expect_error("folder.vtu", FailureKind::files, "folder.vtu");
}

}  // namespace
}  // namespace aeroloom::io
