/// Builds the VTK objects of a file and writes it. Only io/vtk/*.cpp include this header.
#pragma once

#include "io/vtk/vtk_writer.hpp"
#include "mesh/data/patch.hpp"

#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <vtkCellArray.h>
#include <vtkFieldData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkXMLWriter.h>

namespace aeroloom::io {

/// Writes a file in binary appended form, with 64-bit offsets. Throws std::filesystem::filesystem_error with
/// the reason.
void write_vtk_file(vtkXMLWriter& writer, vtkDataObject& data, const std::string& path,
                    Compression compression);

/// Points in double precision from (n,3) coordinates.
vtkSmartPointer<vtkPoints> make_points(const std::vector<double>& coordinates);

/// Cells with different numbers of corners, with 32-bit offsets.
struct CellsOfShapes {
  std::vector<std::int32_t> connectivity;
  std::vector<std::int32_t> offsets = {0};

  /// Ends the cell whose corners were appended last. Throws std::length_error above 2^31 - 1 corners.
  void close_cell() {
    if (connectivity.size() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
      throw std::length_error("a file would get more corners than its 32-bit offsets can count");
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
};
vtkSmartPointer<vtkCellArray> make_cells(const CellsOfShapes& cells);

/// Adds the field arrays `patch_names` and `patch_types`.
void add_patches(vtkFieldData& fields, const std::vector<mesh::Patch>& patches);

/// A VTK array of type `Array` that holds a copy of `values`.
template <class Array, class Value>
vtkSmartPointer<Array> make_array(const char* name, const std::vector<Value>& values) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  if constexpr (std::is_arithmetic_v<Value>) {
    static_assert(sizeof(Value) == sizeof(typename Array::ValueType));
    if (!values.empty()) std::memcpy(array->GetPointer(0), values.data(), values.size() * sizeof(Value));
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) array->SetValue(static_cast<vtkIdType>(i), values[i]);
  }
  return array;
}

/// The VTK type and the name of an array in an index file.
struct IndexArray {
  const char* type;
  const char* name;
};

/// The XML of an index file: .pvtu (`grid_type` PUnstructuredGrid) or .pvtp (PPolyData).
std::string index_text(const char* grid_type, std::span<const IndexArray> point_arrays,
                       std::span<const IndexArray> cell_arrays, const std::vector<std::string>& sources);

}  // namespace aeroloom::io
