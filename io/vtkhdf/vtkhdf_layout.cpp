#include "io/vtkhdf/vtkhdf_layout.hpp"

#include <array>

namespace aeroloom::io::vtkhdf {

using hdf5::FileLayout;
using hdf5::ItemType;

namespace {

void store_column(FileLayout& file, const std::string& path, std::span<const GridCounts> partitions,
                  std::int64_t GridCounts::*column) {
  std::vector<std::int64_t> items;
  items.reserve(partitions.size());
  for (const GridCounts& row : partitions) items.push_back(row.*column);
  file.store(path, std::span<const std::int64_t>(items));
}

}  // namespace

std::vector<GridCounts> sums_before(std::span<const GridCounts> partitions) {
  std::vector<GridCounts> before(partitions.size() + 1);
  for (std::size_t i = 0; i < partitions.size(); ++i) {
    before[i + 1] = {before[i].points + partitions[i].points, before[i].cells + partitions[i].cells,
                     before[i].corners + partitions[i].corners};
  }
  return before;
}

GridPlaces lay_out_grid(FileLayout& file, std::span<const GridCounts> partitions,
                        const std::string& id_name) {
  const GridCounts all = sums_before(partitions).back();
  file.add_group("/VTKHDF");
  file.set_integers("/VTKHDF", "Version", std::array<std::int32_t, 2>{1, 0});
  file.set_text("/VTKHDF", "Type", "UnstructuredGrid", 0, hdf5::TextKind::null_padded);
  store_column(file, "/VTKHDF/NumberOfPoints", partitions, &GridCounts::points);
  store_column(file, "/VTKHDF/NumberOfCells", partitions, &GridCounts::cells);
  store_column(file, "/VTKHDF/NumberOfConnectivityIds", partitions, &GridCounts::corners);
  for (const char* group : {"/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"})
    file.add_group(group);
  GridPlaces places;
  places.points =
      file.reserve("/VTKHDF/Points", ItemType::float64, std::array<std::int64_t, 2>{all.points, 3});
  places.connectivity = file.reserve("/VTKHDF/Connectivity", ItemType::int64, all.corners);
  places.offsets = file.reserve("/VTKHDF/Offsets", ItemType::int64,
                                all.cells + static_cast<std::int64_t>(partitions.size()));
  places.types = file.reserve("/VTKHDF/Types", ItemType::uint8, all.cells);
  places.numbers = file.reserve("/VTKHDF/PointData/global_id", ItemType::int64, all.points);
  file.set_text("/VTKHDF/PointData/global_id", "Attribute", "GlobalIds", 0, hdf5::TextKind::null_padded);
  places.parts = file.reserve("/VTKHDF/CellData/part", ItemType::int32, all.cells);
  places.ids = file.reserve("/VTKHDF/CellData/" + id_name, ItemType::int32, all.cells);
  return places;
}

void store_patches(FileLayout& file, const std::string& names_path, const std::string& types_path,
                   std::span<const mesh::Patch> patches) {
  std::vector<std::string> names, types;
  for (const mesh::Patch& patch : patches) {
    names.push_back(patch.name);
    types.emplace_back(name_of(patch.type));
  }
  file.store_texts(names_path, names);
  file.store_texts(types_path, types);
}

BoundaryPlaces lay_out_boundary(FileLayout& file, std::int64_t faces, std::int64_t corners,
                                std::span<const mesh::Patch> patches) {
  file.add_group("/Boundary");
  store_patches(file, "/Boundary/PatchNames", "/Boundary/PatchTypes", patches);
  BoundaryPlaces places;
  places.connectivity = file.reserve("/Boundary/Connectivity", ItemType::int64, corners);
  places.offsets = file.reserve("/Boundary/Offsets", ItemType::int64, faces + 1);
  places.types = file.reserve("/Boundary/Types", ItemType::uint8, faces);
  places.patches = file.reserve("/Boundary/Patch", ItemType::int32, faces);
  return places;
}

}  // namespace aeroloom::io::vtkhdf
