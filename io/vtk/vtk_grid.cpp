#include "io/vtk/vtk_grid.hpp"

#include "io/vtk/vtk_content.hpp"
#include "io/vtk/vtk_errors.hpp"
#include "io/vtk/vtk_labels.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSetAttributes.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUtilities.h>

namespace aeroloom::io {

namespace {

void require_silence(const VtkErrors& errors) {
  if (errors.any()) throw std::runtime_error("VTK cannot read it: " + errors.first());
}

/// VTK does not say everywhere that an array was too short.
class XmlGridReader : public vtkXMLUnstructuredGridReader {
public:
  vtkTypeMacro(XmlGridReader, vtkXMLUnstructuredGridReader) static XmlGridReader* New();
  bool has_failed() const { return this->DataError != 0 || this->InformationError != 0; }
};
vtkStandardNewMacro(XmlGridReader);

/// VTK reads a file whose end is missing as far as it goes, without a word: the last bytes tell.
void require_xml_end(const std::string& path) {
  constexpr std::int64_t enough = 1024;
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::int64_t>(stream.tellg());
  std::string tail(static_cast<std::size_t>(std::min(size, enough)), ' ');
  stream.seekg(size - static_cast<std::int64_t>(tail.size()));
  stream.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  tail.erase(tail.find_last_not_of(" \t\r\n") + 1);
  if (!tail.ends_with("</VTKFile>"))
    throw std::runtime_error(
        fmt::format("it does not end with </VTKFile> after {} bytes: it is no such file, or cut off", size));
}

/// Others are not read at all.
void select_arrays(vtkXMLUnstructuredGridReader& reader) {
  vtkDataArraySelection& arrays = *reader.GetCellDataArraySelection();
  arrays.DisableAllArrays();
  arrays.EnableArray(vtkDataSetAttributes::GhostArrayName());
  for (const char* name : region_arrays) arrays.EnableArray(name);
  for (const char* name : patch_arrays) arrays.EnableArray(name);
}

void find_sources(vtkXMLDataElement& grid, std::vector<std::string>& sources) {
  for (int i = 0; i < grid.GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& piece = *grid.GetNestedElement(i);
    if (piece.GetName() == nullptr || std::string(piece.GetName()) != "Piece") continue;
    const char* source = piece.GetAttribute("Source");
    if (source == nullptr || *source == '\0')
      throw std::runtime_error(fmt::format("piece {} names no file (attribute Source)", sources.size()));
    sources.emplace_back(source);
  }
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> read_vtk_grid(const std::string& path) {
  const VtkErrors errors;
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vtk") {
    vtkNew<vtkUnstructuredGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->Update();
    grid = reader->GetOutput();
  } else {
    require_xml_end(path);
    vtkNew<XmlGridReader> reader;
    reader->SetFileName(path.c_str());
    reader->UpdateInformation();
    require_silence(errors);
    select_arrays(*reader);
    reader->Update();
    require_silence(errors);
    if (reader->has_failed())
      throw std::runtime_error("an array is too short, or its data cannot be taken out");
    grid = reader->GetOutput();
  }
  require_silence(errors);
  if (grid == nullptr) throw std::runtime_error("it holds no unstructured grid");
  return grid;
}

std::vector<std::string> extract_vtk_sources(const std::string& path) {
  const VtkErrors errors;
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(path.c_str()));
  require_silence(errors);
  vtkXMLDataElement* grid = root != nullptr ? root->FindNestedElementWithName("PUnstructuredGrid") : nullptr;
  if (grid == nullptr) throw std::runtime_error("it is no index of unstructured grids (PUnstructuredGrid)");
  std::vector<std::string> sources;
  find_sources(*grid, sources);
  return sources;
}

}  // namespace aeroloom::io
