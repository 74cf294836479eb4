#include "io/vtk/vtk_files.hpp"
#include "io/vtk/vtk_parts.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "mesh/quality.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace aeroloom::io {

namespace {

/// Enough for a viewer to load parts side by side, little enough for the memory of one rank. Viewers see
/// faces between parts as boundary: meshes of common size are one or two parts.
constexpr mesh::GlobalIndex tetrahedra_per_part = 1'000'000;

/// The cell arrays of a part.
struct TetrahedronArrays {
  std::vector<PartIndex> connectivity;
  std::vector<std::int32_t> piece, region;
  std::vector<float> mean_ratio, min_dihedral;

  void reserve(std::size_t cells) {
    connectivity.reserve(4 * cells);
    piece.reserve(cells), region.reserve(cells);
    mean_ratio.reserve(cells), min_dihedral.reserve(cells);
  }
};

void append_cells(const PartPiece& piece, const std::vector<PartIndex>& places, TetrahedronArrays& arrays) {
  for (std::size_t c = 0; c + 3 < piece.cells.size(); c += 4) {
    const mesh::LocalIndex* v = piece.cells.data() + c;
    const geometry::Vec3 p[4] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])};
    for (int k = 0; k < 4; ++k) arrays.connectivity.push_back(places[v[k]]);
    arrays.piece.push_back(piece.id);
    arrays.region.push_back(piece.region);
    arrays.mean_ratio.push_back(static_cast<float>(mesh::mean_ratio(p[0], p[1], p[2], p[3])));
    arrays.min_dihedral.push_back(static_cast<float>(mesh::dihedral_range(p[0], p[1], p[2], p[3]).smallest));
  }
}

void write_part(const std::vector<PartPiece>& pieces, const std::vector<std::string>& regions,
                const std::string& path, Compression compression) {
  const PartPoints points = merge_points(pieces);
  TetrahedronArrays arrays;
  std::size_t cells = 0;
  for (const PartPiece& piece : pieces) cells += piece.cells.size() / 4;
  arrays.reserve(cells);
  for (std::size_t i = 0; i < pieces.size(); ++i) append_cells(pieces[i], points.of_piece[i], arrays);
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(make_points(points.coordinates));
  grid->SetCells(VTK_TETRA, make_cells(arrays.connectivity, 4));
  grid->GetPointData()->AddArray(make_array<vtkTypeInt64Array>("global_id", points.numbers));
  grid->GetCellData()->AddArray(make_array<vtkIntArray>("piece", arrays.piece));
  grid->GetCellData()->AddArray(make_array<vtkIntArray>("region", arrays.region));
  grid->GetCellData()->AddArray(make_array<vtkFloatArray>("mean_ratio", arrays.mean_ratio));
  grid->GetCellData()->AddArray(make_array<vtkFloatArray>("min_dihedral", arrays.min_dihedral));
  grid->GetFieldData()->AddArray(make_array<vtkStringArray>("region_names", regions));
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  write_vtk_file(*writer, *grid, path, compression);
}

}  // namespace

void write_volume(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                  const mesh::Numbering& numbering, const std::string& directory, const std::string& name,
                  Compression compression) {
  const PartFiles files{directory, name, "pvtu", "vtu"};
  const std::size_t parts = write_parts(communicator, mesh, numbering, tetrahedra_per_part, files,
                                        [&](const std::vector<PartPiece>& pieces, const std::string& path) {
                                          write_part(pieces, mesh.regions, path, compression);
                                        });
  constexpr IndexArray point_arrays[] = {{"Int64", "global_id"}};
  constexpr IndexArray cell_arrays[] = {
      {"Int32", "piece"}, {"Int32", "region"}, {"Float32", "mean_ratio"}, {"Float32", "min_dihedral"}};
  std::vector<std::string> sources;
  for (std::size_t i = 0; i < parts; ++i) sources.push_back(files.part_source(i));
  write_index(communicator, files.index_path(),
              index_text("PUnstructuredGrid", point_arrays, cell_arrays, sources));
}

}  // namespace aeroloom::io
