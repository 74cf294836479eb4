#include "io/vtk/indexed_files.hpp"
#include "io/vtk/vtk_objects.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "mesh/quality/quality.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
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

constexpr mesh::GlobalIndex faces_per_part = 50'000;

/// The cell arrays of a part.
struct FaceArrays {
  CellsOfShapes cells;
  std::vector<std::int32_t> piece, face, patch;
  std::vector<float> quality;
};

void append_face(const Block& block, mesh::LocalIndex face, const std::vector<PointIndex>& places,
                 FaceArrays& arrays) {
  for (int k = 0; k < block.corners; ++k) arrays.cells.connectivity.push_back(places[block.item(face)[k]]);
  arrays.cells.close_cell();
}

void append_triangles(const WrittenPart& written, const std::vector<PointIndex>& places, FaceArrays& arrays) {
  const Block& triangles = written.part.faces[0];
  for (mesh::LocalIndex t = 0; t < triangles.count(); ++t) {
    append_face(triangles, t, places, arrays);
    const mesh::LocalIndex* v = triangles.item(t);
    arrays.quality.push_back(static_cast<float>(mesh::triangle_mean_ratio(
        written.part.point(v[0]), written.part.point(v[1]), written.part.point(v[2]))));
  }
  arrays.piece.resize(arrays.quality.size(), written.part.id);
  arrays.face.insert(arrays.face.end(), written.triangle_face.begin(), written.triangle_face.end());
  arrays.patch.insert(arrays.patch.end(), written.triangle_patch.begin(), written.triangle_patch.end());
}

void append_faces(const MeshPart& part, const std::vector<PointIndex>& places, FaceArrays& arrays) {
  for (const Block& block : part.faces) {
    for (const Run& run : block.runs) {
      for (mesh::LocalIndex f = run.begin; f < run.end; ++f) append_face(block, f, places, arrays);
      arrays.patch.resize(arrays.patch.size() + static_cast<std::size_t>(run.end - run.begin), run.id);
    }
  }
  arrays.piece.resize(arrays.patch.size(), part.id);
}

vtkSmartPointer<vtkPolyData> make_surface(const FilePoints& points, const FaceArrays& arrays) {
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(make_points(points.coordinates));
  surface->SetPolys(make_cells(arrays.cells));
  surface->GetPointData()->AddArray(make_array<vtkTypeInt64Array>("global_id", points.numbers));
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("piece", arrays.piece));
  return surface;
}

/// Names go into every part: a reader of the index takes field data from the parts.
void write_triangle_file(const std::vector<WrittenPart>& parts, const mesh::DistributedMesh& mesh,
                         const std::string& path, Compression compression) {
  const FilePoints points = merge_points(parts, FileContent::faces);
  FaceArrays arrays;
  for (std::size_t i = 0; i < parts.size(); ++i) append_triangles(parts[i], points.of_part[i], arrays);
  const auto surface = make_surface(points, arrays);
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("face", arrays.face));
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("patch", arrays.patch));
  surface->GetCellData()->AddArray(make_array<vtkFloatArray>("quality", arrays.quality));
  surface->GetFieldData()->AddArray(make_array<vtkStringArray>("face_names", mesh.faces));
  surface->GetFieldData()->AddArray(make_array<vtkStringArray>("patch_names", mesh.patches));
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_file(*writer, *surface, path, compression);
}

void write_face_file(const std::vector<WrittenPart>& parts, const FileMesh& mesh, const std::string& path,
                     Compression compression) {
  const FilePoints points = merge_points(parts, FileContent::faces);
  FaceArrays arrays;
  for (std::size_t i = 0; i < parts.size(); ++i) append_faces(parts[i].part, points.of_part[i], arrays);
  const auto surface = make_surface(points, arrays);
  surface->GetCellData()->AddArray(make_array<vtkIntArray>("patch", arrays.patch));
  add_patches(*surface->GetFieldData(), mesh.patches);
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_file(*writer, *surface, path, compression);
}

/// The triangles of a surface as faces without runs.
std::vector<WrittenPart> parts_of(const mesh::NumberedMesh& surface) {
  std::vector<WrittenPart> parts;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const mesh::Piece& piece = surface.pieces[i];
    WrittenPart& view = parts.emplace_back();
    view.part.id = piece.id;
    view.part.coordinates = piece.coordinates;
    view.part.numbers = surface.numbering.vertices[i];
    view.part.faces[0] = {3, piece.cells, {}, 0, {}};
    view.triangle_face = piece.triangle_face;
    view.triangle_patch = piece.triangle_patch;
  }
  return parts;
}

/// The parts of a mesh with some of their faces, as views of `corners`.
struct SelectedFaces {
  std::vector<WrittenPart> parts;
  std::vector<std::vector<mesh::LocalIndex>> corners;
};

SelectedFaces select_faces(const FileMesh& mesh, SurfaceFaces faces) {
  SelectedFaces selected;
  selected.parts = parts_of(mesh);
  selected.corners.reserve(face_shape_count * mesh.parts.size());
  for (WrittenPart& written : selected.parts) {
    for (Block& block : written.part.faces) {
      std::vector<mesh::LocalIndex>& corners = selected.corners.emplace_back();
      std::vector<Run> runs;
      for (Run run : block.runs) {
        const bool between = mesh.patches[static_cast<std::size_t>(run.id)].type == mesh::PatchType::interior;
        if (between != (faces == SurfaceFaces::between_regions)) continue;
        for (mesh::LocalIndex f = run.begin; f < run.end; ++f)
          corners.insert(corners.end(), block.item(f), block.item(f) + block.corners);
        run.end -= run.begin;
        run.begin = static_cast<mesh::LocalIndex>(corners.size()) / block.corners - run.end;
        run.end += run.begin;
        runs.push_back(run);
      }
      block.connectivity = corners;
      block.order.clear();
      block.runs = std::move(runs);
    }
  }
  return selected;
}

}  // namespace

void write_surface(const mesh::NumberedMesh& surface, const std::string& directory, const std::string& name,
                   Compression compression) {
  const IndexedFiles files{surface.communicator, directory, name, "pvtp", "vtp"};
  const std::size_t count = write_files(parts_of(surface), FileContent::faces, faces_per_part, files,
                                        [&](const std::vector<WrittenPart>& parts, const std::string& path) {
                                          write_triangle_file(parts, surface, path, compression);
                                        });
  constexpr IndexArray point_arrays[] = {{"Int64", "global_id"}};
  constexpr IndexArray cell_arrays[] = {
      {"Int32", "piece"}, {"Int32", "face"}, {"Int32", "patch"}, {"Float32", "quality"}};
  write_index(files, index_text("PPolyData", point_arrays, cell_arrays, files.file_sources(count)));
}

void write_surface(const FileMesh& mesh, const std::string& directory, const std::string& name,
                   Compression compression, SurfaceFaces faces) {
  const IndexedFiles files{mesh.communicator(), directory, name, "pvtp", "vtp"};
  const SelectedFaces selected = select_faces(mesh, faces);
  const std::size_t count = write_files(selected.parts, FileContent::faces, faces_per_part, files,
                                        [&](const std::vector<WrittenPart>& parts, const std::string& path) {
                                          write_face_file(parts, mesh, path, compression);
                                        });
  constexpr IndexArray point_arrays[] = {{"Int64", "global_id"}};
  constexpr IndexArray cell_arrays[] = {{"Int32", "piece"}, {"Int32", "patch"}};
  write_index(files, index_text("PPolyData", point_arrays, cell_arrays, files.file_sources(count)));
}

void write_triangles(const std::vector<geometry::Vec3>& points,
                     const std::vector<std::array<mesh::LocalIndex, 3>>& triangles, const std::string& file) {
  std::vector<double> coordinates;
  for (const geometry::Vec3 p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  CellsOfShapes cells;
  for (const auto& triangle : triangles) {
    cells.connectivity.insert(cells.connectivity.end(), triangle.begin(), triangle.end());
    cells.close_cell();
  }
  const auto folder = std::filesystem::path(file).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder);
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(make_points(coordinates));
  surface->SetPolys(make_cells(cells));
  vtkNew<vtkXMLPolyDataWriter> writer;
  write_vtk_file(*writer, *surface, file, Compression::none);
}

}  // namespace aeroloom::io
