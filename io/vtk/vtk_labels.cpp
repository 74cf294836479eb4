#include "io/vtk/vtk_labels.hpp"

#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkSetGet.h>
#include <vtkStringArray.h>

namespace aeroloom::io {

namespace {

/// Nothing where a value is not whole.
template <class Value>
std::optional<std::vector<std::int64_t>> whole_numbers(const Value* values, vtkIdType count) {
  std::vector<std::int64_t> result;
  result.reserve(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i) {
    if constexpr (std::is_floating_point_v<Value>) {
      constexpr double largest = 9007199254740992.0;  // up to here doubles hold each whole number
      const double value = values[i];
      if (!(std::abs(value) <= largest) || std::trunc(value) != value) return std::nullopt;
    }
    result.push_back(static_cast<std::int64_t>(values[i]));
  }
  return result;
}

/// The first array of whole numbers among these.
std::optional<std::vector<std::int64_t>> first_of(vtkUnstructuredGrid& grid,
                                                  std::span<const char* const> candidates,
                                                  std::string& name) {
  for (const char* candidate : candidates) {
    vtkDataArray* array = grid.GetCellData()->GetArray(candidate);
    if (array == nullptr) continue;
    std::optional<std::vector<std::int64_t>> values = integers_of(*array, grid.GetNumberOfCells());
    if (!values) continue;
    name = candidate;
    return values;
  }
  return std::nullopt;
}

std::vector<std::string> texts_of(vtkFieldData& fields, const char* name) {
  std::vector<std::string> texts;
  auto* array = vtkStringArray::SafeDownCast(fields.GetAbstractArray(name));
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfValues(); ++i)
    texts.push_back(array->GetValue(i));
  return texts;
}

std::vector<mesh::Patch> patches_of(vtkFieldData& fields) {
  const std::vector<std::string> names = texts_of(fields, "patch_names"),
                                 types = texts_of(fields, "patch_types");
  std::vector<mesh::Patch> patches;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto type = i < types.size() ? mesh::patch_type_of(types[i]) : mesh::patch_type_by_name(names[i]);
    patches.push_back({names[i], type.value_or(mesh::PatchType::wall)});
  }
  return patches;
}

/// A field array of whole numbers, which must be there.
std::vector<std::int64_t> field_of(vtkFieldData& fields, const char* name) {
  vtkDataArray* array = fields.GetArray(name);
  std::optional<std::vector<std::int64_t>> values;
  if (array != nullptr) values = integers_of(*array, array->GetNumberOfTuples());
  if (!values)
    throw std::runtime_error(
        fmt::format("field array '{}' does not hold one whole number after another", name));
  return std::move(*values);
}

/// How cells are called: by `names` where they go by value, STEM_value beyond these; `single` without values.
struct Naming {
  std::vector<mesh::Patch> names;
  const char* single;
  const char* stem;
};

/// The table has all names, and all values of the cells in the lists, ascending.
CellLabels label(const std::optional<std::vector<std::int64_t>>& values, const Naming& naming,
                 std::span<const std::vector<vtkIdType>> lists) {
  CellLabels labels;
  std::vector<std::int64_t> used(naming.names.size());
  for (std::size_t i = 0; i < used.size(); ++i) used[i] = static_cast<std::int64_t>(i);
  const auto value_of = [&](vtkIdType cell) {
    return values ? (*values)[static_cast<std::size_t>(cell)] : 0;
  };
  for (const auto& list : lists) {
    for (const vtkIdType cell : list) used.push_back(value_of(cell));
  }
  geometry::sort_unique(used);
  for (const auto& list : lists) {
    std::vector<std::int32_t>& places = labels.of_cells.emplace_back();
    places.reserve(list.size());
    for (const vtkIdType cell : list)
      places.push_back(static_cast<std::int32_t>(std::lower_bound(used.begin(), used.end(), value_of(cell)) -
                                                 used.begin()));
  }
  for (const std::int64_t value : used) {
    const bool named = value >= 0 && static_cast<std::uint64_t>(value) < naming.names.size();
    const std::string other = values ? fmt::format("{}_{}", naming.stem, value) : naming.single;
    labels.table.push_back({value, named ? naming.names[static_cast<std::size_t>(value)]
                                         : mesh::Patch{other, mesh::PatchType::wall}});
  }
  return labels;
}

}  // namespace

std::optional<std::vector<std::int64_t>> integers_of(vtkDataArray& array, vtkIdType count) {
  if (array.GetNumberOfComponents() != 1 || array.GetNumberOfTuples() != count ||
      !array.HasStandardMemoryLayout())
    return std::nullopt;
  if (count == 0) return std::vector<std::int64_t>();
  switch (array.GetDataType()) {
    vtkTemplateMacro(return whole_numbers(static_cast<const VTK_TT*>(array.GetVoidPointer(0)), count));
    default:
      return std::nullopt;
  }
}

CellLabels read_regions(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists) {
  std::string name;
  const auto values = first_of(grid, region_arrays, name);
  Naming naming{{}, "volume", "volume"};
  if (name == region_arrays[0]) {
    for (const std::string& text : texts_of(*grid.GetFieldData(), "region_names"))
      naming.names.push_back({text, mesh::PatchType::wall});
  }
  return label(values, naming, lists);
}

CellLabels read_patches(vtkUnstructuredGrid& grid, std::span<const std::vector<vtkIdType>> lists) {
  std::string name;
  const auto values = first_of(grid, patch_arrays, name);
  Naming naming{{}, "boundary", "patch"};
  if (name == patch_arrays[0]) naming.names = patches_of(*grid.GetFieldData());
  return label(values, naming, lists);
}

bool has_boundary_fields(vtkFieldData& fields) {
  return fields.GetArray("boundary_corners") != nullptr && fields.GetArray("boundary_offsets") != nullptr &&
         fields.GetArray("boundary_patch") != nullptr;
}

void read_boundary_fields(vtkFieldData& fields, VtkContent& content) {
  const std::vector<std::int64_t> corners = field_of(fields, "boundary_corners"),
                                  offsets = field_of(fields, "boundary_offsets"),
                                  patch = field_of(fields, "boundary_patch");
  const std::vector<mesh::Patch> patches = patches_of(fields);
  for (std::size_t i = 0; i < patches.size(); ++i)
    content.patches.push_back({static_cast<std::int64_t>(i), patches[i]});
  if (offsets.size() != patch.size() + 1)
    throw std::runtime_error(fmt::format("{} boundary faces have {} offsets (field array 'boundary_offsets')",
                                         patch.size(), offsets.size()));
  std::int64_t begin = 0;
  for (std::size_t f = 0; f < patch.size(); ++f) {
    const std::int64_t end = offsets[f + 1];
    if (offsets[f] != begin || (end != begin + 3 && end != begin + 4) ||
        end > static_cast<std::int64_t>(corners.size()))
      throw std::runtime_error(fmt::format(
          "boundary face {} is no triangle or quadrilateral (offsets {}, {})", f, offsets[f], end));
    if (patch[f] < 0 || patch[f] >= static_cast<std::int64_t>(patches.size()))
      throw std::runtime_error(
          fmt::format("boundary face {} is of patch {}, of {}", f, patch[f], patches.size()));
    const auto shape = static_cast<std::size_t>(end - begin - 3);
    content.faces[shape].insert(content.faces[shape].end(), corners.begin() + begin, corners.begin() + end);
    content.face_labels[shape].push_back(static_cast<std::int32_t>(patch[f]));
    begin = end;
  }
}

}  // namespace aeroloom::io
