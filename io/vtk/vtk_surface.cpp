#include "io/vtk/vtk_files.hpp"
#include "io/vtk/vtk_parts.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "mesh/quality.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkXMLPolyDataWriter.h>

namespace aeroloom::io {

namespace {

constexpr mesh::GlobalIndex triangles_per_part = 50'000;

/// The cell arrays of a part.
struct TriangleArrays {
  std::vector<PartIndex> connectivity;
  std::vector<std::int32_t> piece, face, patch;
  std::vector<float> quality;
};

void append_cells(const PartPiece& piece, const std::vector<PartIndex>& places, TriangleArrays& arrays) {
  for (std::size_t c = 0; c + 2 < piece.cells.size(); c += 3) {
    const mesh::LocalIndex* v = piece.cells.data() + c;
    for (int k = 0; k < 3; ++k) arrays.connectivity.push_back(places[v[k]]);
    arrays.quality.push_back(static_cast<float>(
        mesh::triangle_mean_ratio(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]))));
  }
  arrays.piece.resize(arrays.piece.size() + piece.cells.size() / 3, piece.id);
  arrays.face.insert(arrays.face.end(), piece.triangle_face.begin(), piece.triangle_face.end());
  arrays.patch.insert(arrays.patch.end(), piece.triangle_patch.begin(), piece.triangle_patch.end());
}

/// Names go into every part: a reader of the index takes field data from the parts.
void write_part(const std::vector<PartPiece>& pieces, const std::vector<std::string>& faces,
                const std::vector<std::string>& patches, const std::string& path, Compression compression) {
  const PartPoints points = merge_points(pieces);
  TriangleArrays arrays;
  for (std::size_t i = 0; i < pieces.size(); ++i) append_cells(pieces[i], points.of_piece[i], arrays);
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(make_points(points.coordinates));
  surface->SetPolys(make_cells(arrays.connectivity, 3));
  surface->GetPointData()->AddArray(make_array<vtkTypeInt64Array>("global_id", points.numbers));
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("piece", arrays.piece));
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("face", arrays.face));
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("patch", arrays.patch));
  surface->GetCellData()->AddArray(make_array<vtkFloatArray>("quality", arrays.quality));
  surface->GetFieldData()->AddArray(make_array<vtkStringArray>("face_names", faces));
  surface->GetFieldData()->AddArray(make_array<vtkStringArray>("patch_names", patches));
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_file(*writer, *surface, path, compression);
}

}  // namespace

void write_surface(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                   const mesh::Numbering& numbering, const std::string& directory, const std::string& name,
                   Compression compression) {
  const PartFiles files{directory, name, "pvtp", "vtp"};
  const std::size_t parts =
      write_parts(communicator, surface, numbering, triangles_per_part, files,
                  [&](const std::vector<PartPiece>& pieces, const std::string& path) {
                    write_part(pieces, surface.faces, surface.patches, path, compression);
                  });
  constexpr IndexArray point_arrays[] = {{"Int64", "global_id"}};
  constexpr IndexArray cell_arrays[] = {
      {"Int32", "piece"}, {"Int32", "face"}, {"Int32", "patch"}, {"Float32", "quality"}};
  std::vector<std::string> sources;
  for (std::size_t i = 0; i < parts; ++i) sources.push_back(files.part_source(i));
  write_index(communicator, files.index_path(), index_text("PPolyData", point_arrays, cell_arrays, sources));
}

void write_triangles(const std::vector<geometry::Vec3>& points,
                     const std::vector<std::array<mesh::LocalIndex, 3>>& triangles, const std::string& file) {
  std::vector<double> coordinates;
  for (const geometry::Vec3 p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  std::vector<std::int32_t> connectivity;
  for (const auto& triangle : triangles)
    connectivity.insert(connectivity.end(), triangle.begin(), triangle.end());
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(make_points(coordinates));
  surface->SetPolys(make_cells(connectivity, 3));
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_file(*writer, *surface, file, Compression::none);
}

}  // namespace aeroloom::io
