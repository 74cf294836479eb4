#include "io/vtk/vtk_reader.hpp"

#include "geometry/predicates.hpp"
#include "mesh/piece.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

namespace aeroloom::io {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
  throw std::runtime_error("'" + path + "': " + what);
}

/// Keeps what a reader complains of instead of printing it.
class Complaints : public vtkCommand {
public:
  static Complaints* New() { return new Complaints; }
  void Execute(vtkObject*, unsigned long, void* text) override {
    if (_first.empty() && text != nullptr) _first = static_cast<const char*>(text);
  }
  const std::string& first() const { return _first; }

private:
  std::string _first;
};

template <class Reader>
vtkSmartPointer<vtkUnstructuredGrid> read_with(const std::string& path) {
  vtkNew<Reader> reader;
  vtkNew<Complaints> complaints;
  reader->AddObserver(vtkCommand::ErrorEvent, complaints);
  reader->SetFileName(path.c_str());
  reader->Update();
  if (!complaints->first().empty() || reader->GetOutput() == nullptr)
    refuse(path, "VTK cannot read it: " + complaints->first());
  return reader->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) refuse(path, "there is no such file");
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".vtu") return read_with<vtkXMLUnstructuredGridReader>(path);
  if (extension == ".pvtu") return read_with<vtkXMLPUnstructuredGridReader>(path);
  if (extension == ".vtk") return read_with<vtkUnstructuredGridReader>(path);
  refuse(path, "'" + extension + "' is not among .vtu, .pvtu and .vtk; convert it, e.g. with meshio");
}

/// The number of each point, equal for points with equal global ids.
std::vector<std::int32_t> point_numbers(vtkUnstructuredGrid& grid) {
  std::vector<std::int32_t> number(static_cast<std::size_t>(grid.GetNumberOfPoints()));
  std::iota(number.begin(), number.end(), 0);
  vtkDataArray* ids = grid.GetPointData()->GetArray("global_id");
  if (ids == nullptr) return number;
  std::vector<std::pair<double, std::int32_t>> order(number.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = {ids->GetComponent(static_cast<vtkIdType>(i), 0), static_cast<std::int32_t>(i)};
  std::sort(order.begin(), order.end());
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (order[i].first == order[i - 1].first) number[order[i].second] = number[order[i - 1].second];
  }
  return number;
}

void read_cells(vtkUnstructuredGrid& grid, const std::string& path, TetrahedraFile& file,
                std::vector<vtkIdType>& cells) {
  const std::vector<std::int32_t> number = point_numbers(grid);
  vtkNew<vtkIdList> points;
  for (vtkIdType c = 0; c < grid.GetNumberOfCells(); ++c) {
    const int type = grid.GetCellType(c);
    if (type == VTK_VERTEX || type == VTK_POLY_VERTEX || type == VTK_LINE || type == VTK_TRIANGLE ||
        type == VTK_QUAD || type == VTK_POLYGON || type == VTK_EMPTY_CELL || type == VTK_POLY_LINE) {
      ++file.ignored;
      continue;
    }
    if (type != VTK_TETRA) {
      refuse(path, "cell " + std::to_string(c) + " is of VTK's type " + std::to_string(type) +
                       ", not a tetrahedron of four points; only tetrahedra can be improved");
    }
    grid.GetCellPoints(c, points);
    auto& tet = file.tets.emplace_back();
    for (int k = 0; k < 4; ++k) tet[k] = number[static_cast<std::size_t>(points->GetId(k))];
    cells.push_back(c);
  }
  if (file.tets.empty()) refuse(path, "it has no tetrahedra");
  if (file.tets.size() > mesh::max_cells_per_piece)
    refuse(path, "it has " + std::to_string(file.tets.size()) + " tetrahedra, too many for one rank to read");
}

/// Keeps the points that tetrahedra use, in their order.
void read_points(vtkUnstructuredGrid& grid, const std::string& path, TetrahedraFile& file) {
  std::vector<std::int32_t> renumbered(static_cast<std::size_t>(grid.GetNumberOfPoints()), -1);
  for (const auto& tet : file.tets) {
    for (const std::int32_t v : tet) renumbered[v] = 0;
  }
  std::int32_t count = 0;
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] < 0) continue;
    renumbered[v] = count++;
    double p[3];
    grid.GetPoint(static_cast<vtkIdType>(v), p);
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
      refuse(path, "a coordinate of point " + std::to_string(v) + " is not a number");
    file.coordinates.insert(file.coordinates.end(), p, p + 3);
  }
  for (auto& tet : file.tets) {
    for (std::int32_t& v : tet) v = renumbered[v];
  }
}

void turn_tetrahedra(TetrahedraFile& file) {
  const auto point = [&](std::int32_t v) {
    const double* p = file.coordinates.data() + 3 * static_cast<std::size_t>(v);
    return geometry::Vec3{p[0], p[1], p[2]};
  };
  for (auto& tet : file.tets) {
    if (geometry::orient3d(point(tet[0]), point(tet[1]), point(tet[2]), point(tet[3])) >= 0) continue;
    std::swap(tet[2], tet[3]);
    ++file.turned;
  }
}

void read_regions(vtkUnstructuredGrid& grid, const std::vector<vtkIdType>& cells, TetrahedraFile& file) {
  file.region.assign(file.tets.size(), 0);
  vtkDataArray* labels = nullptr;
  std::string source;
  for (const char* name : {"region", "CellEntityIds", "gmsh:geometrical", "medit:ref"}) {
    if (labels != nullptr || grid.GetCellData()->GetArray(name) == nullptr) continue;
    labels = grid.GetCellData()->GetArray(name);
    source = name;
  }
  if (labels == nullptr) {
    file.region_names = {"volume"};
    return;
  }
  std::vector<double> values;
  values.reserve(cells.size());
  for (const vtkIdType c : cells) values.push_back(labels->GetComponent(c, 0));
  std::vector<double> kinds = values;
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  for (std::size_t i = 0; i < values.size(); ++i)
    file.region[i] =
        static_cast<std::int32_t>(std::lower_bound(kinds.begin(), kinds.end(), values[i]) - kinds.begin());
  auto* names = vtkStringArray::SafeDownCast(grid.GetFieldData()->GetAbstractArray("region_names"));
  for (const double kind : kinds) {
    const auto index = static_cast<vtkIdType>(kind);
    const bool named =
        source == "region" && names != nullptr && index >= 0 && index < names->GetNumberOfValues();
    file.region_names.push_back(named ? std::string(names->GetValue(index))
                                      : "volume_" + std::to_string(index));
  }
}

}  // namespace

TetrahedraFile read_tetrahedra(const std::string& path) {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = read_grid(path);
  TetrahedraFile file;
  std::vector<vtkIdType> cells;
  read_cells(*grid, path, file, cells);
  read_points(*grid, path, file);
  turn_tetrahedra(file);
  read_regions(*grid, cells, file);
  return file;
}

}  // namespace aeroloom::io
