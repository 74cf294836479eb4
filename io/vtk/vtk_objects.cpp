#include "io/vtk/vtk_objects.hpp"

#include "io/vtk/vtk_errors.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <vtkDataObject.h>
#include <vtkErrorCode.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>

namespace aeroloom::io {

namespace {

std::string escaped_xml(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

std::string array_lines(std::span<const IndexArray> arrays) {
  std::string lines;
  for (const auto& [type, name] : arrays) {
    lines += std::string("      <PDataArray type=\"") + type + "\" Name=\"" + name + "\"/>\n";
  }
  return lines;
}

}  // namespace

void write_vtk_file(vtkXMLWriter& writer, vtkDataObject& data, const std::string& path,
                    Compression compression) {
  const VtkErrors kept_from_the_terminal;  // the exception has the reason
  writer.SetInputDataObject(&data);
  writer.SetFileName(path.c_str());
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetHeaderTypeToUInt64();
  writer.SetByteOrderToLittleEndian();
  switch (compression) {
    case Compression::none:
      writer.SetCompressorTypeToNone();
      break;
    case Compression::lz4:
      writer.SetCompressorTypeToLZ4();
      break;
    case Compression::zlib:
      writer.SetCompressorTypeToZLib();
      break;
  }
  errno = 0;
  if (writer.Write() == 1 && writer.GetErrorCode() == vtkErrorCode::NoError) return;
  const int reason = errno != 0 ? errno : EIO;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  throw std::filesystem::filesystem_error("cannot write", path,
                                          std::error_code(reason, std::generic_category()));
}

vtkSmartPointer<vtkPoints> make_points(const std::vector<double>& coordinates) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(coordinates.size() / 3));
  if (!coordinates.empty())
    std::memcpy(points->GetVoidPointer(0), coordinates.data(), coordinates.size() * sizeof(double));
  return points;
}

vtkSmartPointer<vtkCellArray> make_cells(const CellsOfShapes& cells) {
  auto result = vtkSmartPointer<vtkCellArray>::New();
  result->SetData(make_array<vtkTypeInt32Array>("offsets", cells.offsets),
                  make_array<vtkTypeInt32Array>("connectivity", cells.connectivity));
  return result;
}

void add_patches(vtkFieldData& fields, const std::vector<mesh::Patch>& patches) {
  std::vector<std::string> names, types;
  for (const mesh::Patch& patch : patches) {
    names.push_back(patch.name);
    types.emplace_back(name_of(patch.type));
  }
  fields.AddArray(make_array<vtkStringArray>("patch_names", names));
  fields.AddArray(make_array<vtkStringArray>("patch_types", types));
}

std::string index_text(const char* grid_type, std::span<const IndexArray> point_arrays,
                       std::span<const IndexArray> cell_arrays, const std::vector<std::string>& sources) {
  const std::string grid = grid_type;
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + grid +
                     "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <" + grid +
                     " GhostLevel=\"0\">\n    <PPointData>\n" + array_lines(point_arrays) +
                     "    </PPointData>\n    <PCellData>\n" + array_lines(cell_arrays) +
                     "    </PCellData>\n    <PPoints>\n"
                     "      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n"
                     "    </PPoints>\n";
  for (const std::string& source : sources) text += "    <Piece Source=\"" + escaped_xml(source) + "\"/>\n";
  return text + "  </" + grid + ">\n</VTKFile>\n";
}

}  // namespace aeroloom::io
