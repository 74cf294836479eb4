#include "io/raw_mesh.hpp"
#include "io/vtk/vtk_content.hpp"
#include "io/vtk/vtk_grid.hpp"
#include "io/vtk/vtk_labels.hpp"
#include "io/vtk_order.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCellTypes.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

/// The ids of points; nothing without an array of them.
std::optional<std::vector<GlobalIndex>> read_ids(vtkUnstructuredGrid& grid) {
  vtkPointData& data = *grid.GetPointData();
  vtkDataArray* array = data.GetArray("global_id");
  if (array == nullptr) array = data.GetGlobalIds();
  if (array == nullptr) return std::nullopt;
  const std::string name = array->GetName() != nullptr ? array->GetName() : "global ids";
  std::optional<std::vector<std::int64_t>> ids = integers_of(*array, grid.GetNumberOfPoints());
  if (!ids)
    throw std::runtime_error(
        fmt::format("point array '{}' does not hold one whole number for each point", name));
  const auto bad =
      std::find_if(ids->begin(), ids->end(), [](std::int64_t id) { return id < 0 || id > largest_id; });
  if (bad != ids->end())
    throw std::runtime_error(
        fmt::format("point array '{}': point {} has the id {}", name, bad - ids->begin(), *bad));
  return ids;
}

std::vector<double> read_coordinates(vtkUnstructuredGrid& grid) {
  std::vector<double> coordinates;
  if (grid.GetNumberOfPoints() == 0) return coordinates;
  vtkDataArray& data = *grid.GetPoints()->GetData();
  if (data.GetNumberOfComponents() != 3)
    throw std::runtime_error(
        fmt::format("points have {} coordinates instead of 3", data.GetNumberOfComponents()));
  coordinates.resize(3 * static_cast<std::size_t>(grid.GetNumberOfPoints()));
  for (vtkIdType i = 0; i < grid.GetNumberOfPoints(); ++i) data.GetTuple(i, coordinates.data() + 3 * i);
  return coordinates;
}

/// The use that is made of a cell of the file.
enum class Use { cell, face, none };
struct Kind {
  Use use = Use::none;
  int shape = 0;
};

Kind kind_of(int type, std::size_t corners, vtkIdType cell) {
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    if (type == vtk_cell_type[s] && corners == static_cast<std::size_t>(corners_of(shape)))
      return {Use::cell, static_cast<int>(s)};
  }
  const bool flat = type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON || type == VTK_PIXEL;
  if (flat && (corners == 3 || corners == 4)) return {Use::face, static_cast<int>(corners) - 3};
  switch (type) {
    case VTK_EMPTY_CELL:
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
    case VTK_LINE:
    case VTK_POLY_LINE:
    case VTK_QUADRATIC_EDGE:
    case VTK_CUBIC_LINE:
    case VTK_LAGRANGE_CURVE:
      return {};
    default:
      throw std::runtime_error(
          fmt::format("cell {} is of type {} ({}) with {} points; what can be read are tetrahedra, "
                      "pyramids, prisms and hexahedra of 4, 5, 6 and 8 points, and triangles and "
                      "quadrilaterals as their faces",
                      cell, type, vtkCellTypes::GetClassNameFromTypeId(type), corners));
  }
}

/// The cells of a grid.
class Cells {
public:
  /// VTK does not look whether the arrays of a file fit together.
  explicit Cells(vtkUnstructuredGrid& grid) : _cells(*grid.GetCells()), _types(*grid.GetCellTypesArray()) {
    if (_types.GetNumberOfTuples() != grid.GetNumberOfCells() || _cells.GetNumberOfCells() != count())
      throw std::runtime_error(fmt::format("{} cells have {} types", _cells.GetNumberOfCells(), count()));
    vtkDataArray& offsets = *_cells.GetOffsetsArray();
    vtkDataArray& corners = *_cells.GetConnectivityArray();
    if (offsets.GetNumberOfTuples() != count() + 1 || offsets.GetComponent(0, 0) != 0 ||
        offsets.GetComponent(count(), 0) != static_cast<double>(corners.GetNumberOfTuples()))
      throw std::runtime_error(
          fmt::format("the offsets of cells do not run from 0 to the number of their "
                      "corners, {}",
                      corners.GetNumberOfTuples()));
    for (vtkIdType c = 0; c < count(); ++c) {
      if (offsets.GetComponent(c, 0) > offsets.GetComponent(c + 1, 0))
        throw std::runtime_error(fmt::format("cell {} ends before it begins (offsets)", c));
    }
    const auto points = static_cast<double>(grid.GetNumberOfPoints());
    for (vtkIdType i = 0; i < corners.GetNumberOfTuples(); ++i) {
      const double v = corners.GetComponent(i, 0);
      if (!(v >= 0 && v < points))
        throw std::runtime_error(fmt::format(
            "corner {} of the list of all corners is point {:.0f}, but there are {:.0f}", i, v, points));
    }
    if (vtkDataArray* ghosts = grid.GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName()))
      _ghosts = integers_of(*ghosts, count()).value_or(std::vector<std::int64_t>());
  }
  vtkIdType count() const { return _types.GetNumberOfTuples(); }
  int type(vtkIdType c) const { return _types.GetValue(c); }
  /// Until the next call.
  std::span<const vtkIdType> corners(vtkIdType c) {
    vtkIdType size = 0;
    const vtkIdType* first = nullptr;
    _cells.GetCellAtId(c, size, first);
    return {first, static_cast<std::size_t>(size)};
  }
  /// A copy of a cell of another part, or one that was taken out.
  bool is_ghost(vtkIdType c) const {
    constexpr int copied_or_out = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    return !_ghosts.empty() && (_ghosts[static_cast<std::size_t>(c)] & copied_or_out) != 0;
  }

private:
  vtkCellArray& _cells;
  vtkUnsignedCharArray& _types;
  std::vector<std::int64_t> _ghosts;  // empty: there are none
};

/// Where cells and faces stand in the file, by shape.
struct Places {
  std::array<std::vector<vtkIdType>, cell_shape_count> cells;
  std::array<std::vector<vtkIdType>, face_shape_count> faces;
};

void append_item_corners(std::span<const vtkIdType> corners, Kind kind, int type, VtkContent& content) {
  if (kind.use == Use::cell) {
    std::vector<GlobalIndex>& items = content.cells[kind.shape];
    for (std::size_t k = 0; k < corners.size(); ++k) items.push_back(corners[to_vtk[kind.shape][k]]);
    return;
  }
  std::vector<GlobalIndex>& items = content.faces[kind.shape];
  items.insert(items.end(), corners.begin(), corners.end());
  if (type == VTK_PIXEL) std::swap(items.back(), items[items.size() - 2]);
}

/// Sorts cells by shape; corners are points of the file.
Places read_cells(vtkUnstructuredGrid& grid, bool faces_too, VtkContent& content) {
  Places places;
  if (grid.GetNumberOfCells() == 0) return places;
  Cells cells(grid);
  for (vtkIdType c = 0; c < cells.count(); ++c) {
    const std::span<const vtkIdType> corners = cells.corners(c);
    const Kind kind = kind_of(cells.type(c), corners.size(), c);
    if (kind.use == Use::none || cells.is_ghost(c) || (kind.use == Use::face && !faces_too)) continue;
    append_item_corners(corners, kind, cells.type(c), content);
    (kind.use == Use::cell ? places.cells[kind.shape] : places.faces[kind.shape]).push_back(c);
  }
  return places;
}

void use_ids(const std::vector<GlobalIndex>& ids, VtkContent& content) {
  const auto replace = [&](std::vector<GlobalIndex>& items) {
    for (GlobalIndex& v : items) v = ids[static_cast<std::size_t>(v)];
  };
  for (auto& items : content.cells) replace(items);
  for (auto& items : content.faces) replace(items);
}

}  // namespace

VtkContent extract_vtk_content(const std::string& path) {
  const vtkSmartPointer<vtkUnstructuredGrid> grid = read_vtk_grid(path);
  VtkContent content;
  content.coordinates = read_coordinates(*grid);
  std::optional<std::vector<GlobalIndex>> ids = read_ids(*grid);
  const bool has_fields = ids && has_boundary_fields(*grid->GetFieldData());
  const Places places = read_cells(*grid, !has_fields, content);
  CellLabels regions = read_regions(*grid, places.cells);
  std::move(regions.of_cells.begin(), regions.of_cells.end(), content.cell_labels.begin());
  content.regions = std::move(regions.table);
  if (ids) use_ids(*ids, content);
  if (has_fields) {
    read_boundary_fields(*grid->GetFieldData(), content);
  } else {
    CellLabels patches = read_patches(*grid, places.faces);
    std::move(patches.of_cells.begin(), patches.of_cells.end(), content.face_labels.begin());
    content.patches = std::move(patches.table);
  }
  content.has_ids = ids.has_value();
  if (ids) content.ids = std::move(*ids);
  return content;
}

}  // namespace aeroloom::io
