/// The hand-made mesh as grids that other programs might write: cells and faces side by side, without ids.
#pragma once

#include "io/vtk_order.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <vtkCellData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace aeroloom::io::examples {

/// What a grid gets.
struct GridChoice {
  int part = -1;           ///< cells of this part alone, and their faces; -1: all
  const char* label = "";  ///< name of a cell array: 10 + region, 100 + patch; empty: none
  bool with_faces = true;  ///< not those between regions
  bool with_ids = false;   ///< point array `global_id`: 3 times the place in the whole mesh, and 2^61
};

inline void add_cell(vtkUnstructuredGrid& grid, int type, const std::vector<vtkIdType>& corners) {
  grid.InsertNextCell(type, static_cast<vtkIdType>(corners.size()), corners.data());
}

inline vtkSmartPointer<vtkUnstructuredGrid> make_grid(const MixedMesh& whole, const GridChoice& choice) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->Allocate(100);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkIntArray> labels;
  labels->SetName(choice.label);
  vtkNew<vtkTypeInt64Array> ids;
  ids->SetName("global_id");
  std::vector<vtkIdType> place(whole.points.size(), -1);
  const auto use = [&](int v) {
    if (place[v] < 0) {
      place[v] = points->InsertNextPoint(whole.points[v].x, whole.points[v].y, whole.points[v].z);
      ids->InsertNextValue((std::int64_t{1} << 61) + 3 * v);
    }
    return place[v];
  };
  for (const WholeCell& cell : whole.cells) {
    if (choice.part >= 0 && cell.piece != choice.part) continue;
    const auto s = static_cast<std::size_t>(cell.shape);
    std::vector<vtkIdType> corners;
    for (std::size_t k = 0; k < cell.corners.size(); ++k) corners.push_back(use(cell.corners[to_vtk[s][k]]));
    add_cell(*grid, vtk_cell_type[s], corners);
    labels->InsertNextValue(10 + cell.region);
  }
  for (const WholeFace& face : whole.faces) {
    const bool outside = face.patch != MixedMesh::interface;
    if (!choice.with_faces || !outside || (choice.part >= 0 && whole.cells[face.cell].piece != choice.part))
      continue;
    std::vector<vtkIdType> corners;
    for (const int v : face.corners) corners.push_back(use(v));
    add_cell(*grid, vtk_face_type[corners.size() - 3], corners);
    labels->InsertNextValue(100 + face.patch);
  }
  grid->SetPoints(points);
  if (*choice.label != '\0') grid->GetCellData()->AddArray(labels);
  if (choice.with_ids) grid->GetPointData()->AddArray(ids);
  return grid;
}

/// A part of no cells, nor points but their array of ids, with the boundary faces of the whole as field
/// arrays.
inline vtkSmartPointer<vtkUnstructuredGrid> faces_without_points(const MixedMesh& whole) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  grid->SetPoints(points);
  const auto add = [](vtkFieldData& data, const char* name) {
    vtkNew<vtkTypeInt64Array> array;
    array->SetName(name);
    data.AddArray(array);
    return vtkTypeInt64Array::SafeDownCast(data.GetAbstractArray(name));
  };
  add(*grid->GetPointData(), "global_id");
  vtkFieldData& fields = *grid->GetFieldData();
  auto *corners = add(fields, "boundary_corners"), *offsets = add(fields, "boundary_offsets"),
       *patch = add(fields, "boundary_patch");
  vtkNew<vtkStringArray> names;
  names->SetName("patch_names");
  for (int p = 0; p < 3; ++p) names->InsertNextValue("shell_" + std::to_string(p));
  fields.AddArray(names);
  offsets->InsertNextValue(0);
  for (const WholeFace& face : whole.faces) {
    if (face.patch == MixedMesh::interface) continue;
    for (const int v : face.corners) corners->InsertNextValue((std::int64_t{1} << 61) + 3 * v);
    offsets->InsertNextValue(corners->GetNumberOfValues());
    patch->InsertNextValue(face.patch);
  }
  return grid;
}

/// How a .vtu or .vtk file is written.
enum class FileForm { raw, packed, encoded, text };

inline void write_grid(vtkUnstructuredGrid& grid, const std::string& path, FileForm form = FileForm::raw) {
  if (path.ends_with(".vtk")) {
    vtkNew<vtkUnstructuredGridWriter> writer;
    writer->SetInputData(&grid);
    writer->SetFileName(path.c_str());
    if (form == FileForm::text) {
      writer->SetFileTypeToASCII();
    } else {
      writer->SetFileTypeToBinary();
    }
    writer->Write();
    return;
  }
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(&grid);
  writer->SetFileName(path.c_str());
  if (form == FileForm::text) writer->SetDataModeToAscii();
  if (form == FileForm::encoded) writer->SetDataModeToBinary();
  if (form == FileForm::raw) writer->EncodeAppendedDataOff();
  if (form == FileForm::raw) writer->SetCompressorTypeToNone();
  writer->Write();
}

}  // namespace aeroloom::io::examples
