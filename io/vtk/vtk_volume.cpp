#include "io/vtk/cell_quality.hpp"
#include "io/vtk/indexed_files.hpp"
#include "io/vtk/vtk_objects.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "io/vtk_order.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace aeroloom::io {

namespace {

/// The cell arrays of a part.
struct CellArrays {
  CellsOfShapes cells;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> piece, region;
  std::vector<float> mean_ratio, min_dihedral;
  std::vector<std::int16_t> layer;  // 0 off the layers

  void reserve(std::size_t count) {
    types.reserve(count), piece.reserve(count), region.reserve(count);
    mean_ratio.reserve(count), min_dihedral.reserve(count);
  }
};

void append_cell(const MeshPart& part, CellShape shape, const mesh::LocalIndex* corners,
                 const std::vector<PointIndex>& places, CellArrays& arrays) {
  const auto s = static_cast<std::size_t>(shape);
  const int count = corners_of(shape);
  std::array<geometry::Vec3, mesh::most_corners> p;
  for (int k = 0; k < count; ++k) {
    p[k] = part.point(corners[k]);
    arrays.cells.connectivity.push_back(places[corners[to_vtk[s][k]]]);
  }
  arrays.cells.close_cell();
  arrays.types.push_back(vtk_cell_type[s]);
  const std::span<const geometry::Vec3> points(p.data(), static_cast<std::size_t>(count));
  arrays.mean_ratio.push_back(static_cast<float>(mean_ratio(shape, points)));
  arrays.min_dihedral.push_back(static_cast<float>(smallest_dihedral(shape, points)));
}

void append_cells(const MeshPart& part, const std::vector<PointIndex>& places, CellArrays& arrays) {
  for (const CellShape shape : cell_shapes) {
    const Block& block = part.cells[static_cast<std::size_t>(shape)];
    for (const Run& run : block.runs) {
      for (mesh::LocalIndex c = run.begin; c < run.end; ++c) {
        append_cell(part, shape, block.item(c), places, arrays);
        arrays.region.push_back(run.id);
      }
    }
  }
  arrays.piece.resize(arrays.region.size(), part.id);
  arrays.layer.insert(arrays.layer.end(), part.layers.begin(), part.layers.end());
  arrays.layer.resize(arrays.region.size(), 0);
}

/// The boundary faces of a part by the numbers of their vertices.
struct BoundaryArrays {
  std::vector<mesh::GlobalIndex> corners, offsets = {0};
  std::vector<std::int32_t> patch;
};

void append_boundary(const MeshPart& part, BoundaryArrays& arrays) {
  for (const Block& block : part.faces) {
    for (const Run& run : block.runs) {
      for (mesh::LocalIndex f = run.begin; f < run.end; ++f) {
        for (int k = 0; k < block.corners; ++k) arrays.corners.push_back(part.numbers[block.item(f)[k]]);
        arrays.offsets.push_back(static_cast<mesh::GlobalIndex>(arrays.corners.size()));
        arrays.patch.push_back(run.id);
      }
    }
  }
}

/// Names go into every part: a reader of the index takes field data from the parts.
void add_fields(vtkUnstructuredGrid& grid, const std::vector<WrittenPart>& parts, const FileMesh& mesh) {
  BoundaryArrays boundary;
  for (const WrittenPart& written : parts) append_boundary(written.part, boundary);
  vtkFieldData& fields = *grid.GetFieldData();
  fields.AddArray(make_array<vtkStringArray>("region_names", mesh.regions));
  add_patches(fields, mesh.patches);
  fields.AddArray(make_array<vtkTypeInt64Array>("boundary_corners", boundary.corners));
  fields.AddArray(make_array<vtkTypeInt64Array>("boundary_offsets", boundary.offsets));
  fields.AddArray(make_array<vtkIntArray>("boundary_patch", boundary.patch));
}

void write_volume_file(const std::vector<WrittenPart>& parts, const FileMesh& mesh, const std::string& path,
                       Compression compression) {
  const FilePoints points = merge_points(parts, FileContent::cells);
  CellArrays arrays;
  std::size_t count = 0;
  for (const WrittenPart& written : parts) count += static_cast<std::size_t>(written.part.cell_count());
  arrays.reserve(count);
  for (std::size_t i = 0; i < parts.size(); ++i) append_cells(parts[i].part, points.of_part[i], arrays);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(make_points(points.coordinates));
  grid->SetCells(make_array<vtkUnsignedCharArray>("types", arrays.types), make_cells(arrays.cells));
  grid->GetPointData()->AddArray(make_array<vtkTypeInt64Array>("global_id", points.numbers));
  grid->GetCellData()->AddArray(make_array<vtkIntArray>("piece", arrays.piece));
  grid->GetCellData()->AddArray(make_array<vtkIntArray>("region", arrays.region));
  grid->GetCellData()->AddArray(make_array<vtkFloatArray>("mean_ratio", arrays.mean_ratio));
  grid->GetCellData()->AddArray(make_array<vtkFloatArray>("min_dihedral", arrays.min_dihedral));
  if (mesh.has_layers) grid->GetCellData()->AddArray(make_array<vtkShortArray>("layer", arrays.layer));
  add_fields(*grid, parts, mesh);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  write_vtk_file(*writer, *grid, path, compression);
}

}  // namespace

void write_volume(const FileMesh& mesh, const std::string& directory, const std::string& name,
                  Compression compression) {
  const IndexedFiles files{mesh.communicator(), directory, name, "pvtu", "vtu"};
  const std::size_t count =
      write_files(parts_of(mesh), FileContent::cells, cells_per_vtk_file(mesh.cell_count()), files,
                  [&](const std::vector<WrittenPart>& parts, const std::string& path) {
                    write_volume_file(parts, mesh, path, compression);
                  });
  constexpr IndexArray point_arrays[] = {{"Int64", "global_id"}};
  std::vector<IndexArray> cell_arrays = {
      {"Int32", "piece"}, {"Int32", "region"}, {"Float32", "mean_ratio"}, {"Float32", "min_dihedral"}};
  if (mesh.has_layers) cell_arrays.push_back({"Int16", "layer"});
  write_index(files, index_text("PUnstructuredGrid", point_arrays, cell_arrays, files.file_sources(count)));
}

}  // namespace aeroloom::io
