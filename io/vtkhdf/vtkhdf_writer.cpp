#include "io/vtkhdf/vtkhdf_writer.hpp"

#include "geometry/sort_unique.hpp"
#include "io/streams/range_writer.hpp"
#include "io/vtk_order.hpp"
#include "io/vtkhdf/vtkhdf_layout.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>

namespace aeroloom::io {

using hdf5::FileLayout;
using parallel::SharedFile;
using vtkhdf::GridCounts;

namespace {

constexpr auto item_bytes = static_cast<std::int64_t>(sizeof(std::int64_t));

template <std::size_t N>
GridCounts counts_of_grid(std::int64_t points, const std::array<Block, N>& blocks) {
  GridCounts counts{points, 0, 0};
  for (const Block& block : blocks) {
    counts.cells += block.count();
    counts.corners += static_cast<std::int64_t>(block.connectivity.size());
  }
  return counts;
}

/// One row per part of the whole mesh, by its id.
std::vector<GridCounts> gather_counts(const FileMesh& mesh, const std::vector<GridCounts>& mine) {
  struct PartCounts {
    std::int64_t part;
    GridCounts counts;
  };
  std::vector<PartCounts> rows;
  for (std::size_t i = 0; i < mine.size(); ++i) rows.push_back({mesh.parts[i].id, mine[i]});
  std::vector<GridCounts> all(static_cast<std::size_t>(mesh.part_count));
  for (const PartCounts& row : mesh.communicator().all_gather_items(std::span<const PartCounts>(rows)))
    all[static_cast<std::size_t>(row.part)] = row.counts;
  return all;
}

/// One partition on its way into the arrays of a grid.
class PartitionWriter {
public:
  PartitionWriter(SharedFile& file, const vtkhdf::GridPlaces& places, const GridCounts& before,
                  std::int32_t part)
      : _part(part),
        _connectivity(file, places.connectivity + before.corners * item_bytes),
        _offsets(file, places.offsets + (before.cells + part) * item_bytes),
        _types(file, places.types + before.cells),
        _parts(file, places.parts + before.cells * static_cast<std::int64_t>(sizeof(std::int32_t))),
        _ids(file, places.ids + before.cells * static_cast<std::int64_t>(sizeof(std::int32_t))) {
    _offsets.put(std::int64_t{0});
  }

  /// The cells of a block; `corner(cell, k)` is the k-th in VTK's order, as an index of the partition.
  template <class Corner>
  void add(const Block& block, std::uint8_t type, const Corner& corner) {
    for (const Run& run : block.runs) {
      for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
        for (int k = 0; k < block.corners; ++k) _connectivity.put(corner(block.item(i), k));
        _offsets.put(_corners += block.corners);
        _types.put(type);
        _parts.put(_part);
        _ids.put(run.id);
      }
    }
  }

  void finish() {
    _connectivity.flush();
    _offsets.flush();
    _types.flush();
    _parts.flush();
    _ids.flush();
  }

private:
  std::int32_t _part;
  std::int64_t _corners = 0;
  RangeWriter _connectivity, _offsets, _types, _parts, _ids;
};

void write_grid_cells(SharedFile& file, const vtkhdf::GridPlaces& places, const GridCounts& before,
                      const MeshPart& part) {
  file.write_items(places.points + 3 * before.points * item_bytes, part.coordinates);
  file.write_items(places.numbers + before.points * item_bytes, part.numbers);
  PartitionWriter writer(file, places, before, part.id);
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    const auto& order = to_vtk[s];
    writer.add(part.cells[s], vtk_cell_type[s],
               [&](const mesh::LocalIndex* cell, int k) { return std::int64_t{cell[order[k]]}; });
  }
  writer.finish();
}

void write_boundary(SharedFile& file, const vtkhdf::BoundaryPlaces& places, const GridCounts& before,
                    const MeshPart& part) {
  RangeWriter connectivity(file, places.connectivity + before.corners * item_bytes);
  RangeWriter offsets(file, places.offsets + (before.cells + 1) * item_bytes);
  RangeWriter types(file, places.types + before.cells);
  RangeWriter patches(file, places.patches + before.cells * static_cast<std::int64_t>(sizeof(std::int32_t)));
  std::int64_t corners = before.corners;
  for (const FaceShape shape : face_shapes) {
    const Block& block = part.faces[static_cast<std::size_t>(shape)];
    for (const Run& run : block.runs) {
      for (mesh::LocalIndex i = run.begin; i < run.end; ++i) {
        for (int k = 0; k < block.corners; ++k)
          connectivity.put(part.numbers[static_cast<std::size_t>(block.item(i)[k])]);
        offsets.put(corners += block.corners);
        types.put(vtk_face_type[static_cast<std::size_t>(shape)]);
        patches.put(run.id);
      }
    }
  }
  connectivity.flush();
  offsets.flush();
  types.flush();
  patches.flush();
}

/// The vertices of a part's faces, ascending.
std::vector<mesh::LocalIndex> vertices_of_faces(const MeshPart& part) {
  std::vector<mesh::LocalIndex> used;
  for (const Block& block : part.faces)
    used.insert(used.end(), block.connectivity.begin(), block.connectivity.end());
  geometry::sort_unique(used);
  return used;
}

void write_grid_faces(SharedFile& file, const vtkhdf::GridPlaces& places, const GridCounts& before,
                      const MeshPart& part) {
  const std::vector<mesh::LocalIndex> used = vertices_of_faces(part);
  RangeWriter points(file, places.points + 3 * before.points * item_bytes);
  RangeWriter numbers(file, places.numbers + before.points * item_bytes);
  for (const mesh::LocalIndex v : used) {
    const geometry::Vec3 p = part.point(v);
    for (const double x : {p.x, p.y, p.z}) points.put(x);
    numbers.put(part.numbers[static_cast<std::size_t>(v)]);
  }
  points.flush();
  numbers.flush();
  PartitionWriter writer(file, places, before, part.id);
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    writer.add(part.faces[s], vtk_face_type[s], [&](const mesh::LocalIndex* face, int k) {
      return static_cast<std::int64_t>(std::lower_bound(used.begin(), used.end(), face[k]) - used.begin());
    });
  }
  writer.finish();
}

}  // namespace

void write_vtkhdf(const FileMesh& mesh, const std::string& path) {
  const parallel::Communicator& communicator = mesh.communicator();
  std::vector<GridCounts> cells, faces;
  for (const MeshPart& part : mesh.parts) {
    cells.push_back(counts_of_grid(part.vertex_count(), part.cells));
    faces.push_back(counts_of_grid(0, part.faces));
  }
  const std::vector<GridCounts> rows = gather_counts(mesh, cells);
  const std::vector<GridCounts> before = vtkhdf::sums_before(rows);
  const std::vector<GridCounts> faces_before = vtkhdf::sums_before(gather_counts(mesh, faces));
  vtkhdf::GridPlaces grid;
  vtkhdf::BoundaryPlaces boundary;
  std::vector<hdf5::Extent> structure;
  parallel::agree(communicator, [&] {
    FileLayout layout;
    grid = vtkhdf::lay_out_grid(layout, rows, "region");
    layout.store_texts("/VTKHDF/FieldData/region_names", mesh.regions);
    boundary = vtkhdf::lay_out_boundary(layout, faces_before.back().cells, faces_before.back().corners,
                                        mesh.patches);
    structure = layout.finish();
  });
  hdf5::write_laid_out({communicator, path}, structure, [&](SharedFile& file) {
    const std::int64_t none = 0;
    if (communicator.is_root()) file.write_items(boundary.offsets, std::span(&none, 1));
    for (const MeshPart& part : mesh.parts) {
      const auto p = static_cast<std::size_t>(part.id);
      write_grid_cells(file, grid, before[p], part);
      write_boundary(file, boundary, faces_before[p], part);
    }
  });
}

void write_vtkhdf_surface(const FileMesh& mesh, const std::string& path) {
  std::vector<GridCounts> faces;
  for (const MeshPart& part : mesh.parts) {
    faces.push_back(counts_of_grid(static_cast<std::int64_t>(vertices_of_faces(part).size()), part.faces));
  }
  const std::vector<GridCounts> rows = gather_counts(mesh, faces);
  const std::vector<GridCounts> before = vtkhdf::sums_before(rows);
  vtkhdf::GridPlaces grid;
  std::vector<hdf5::Extent> structure;
  parallel::agree(mesh.communicator(), [&] {
    FileLayout layout;
    grid = vtkhdf::lay_out_grid(layout, rows, "patch");
    vtkhdf::store_patches(layout, "/VTKHDF/FieldData/patch_names", "/VTKHDF/FieldData/patch_types",
                          mesh.patches);
    structure = layout.finish();
  });
  hdf5::write_laid_out({mesh.communicator(), path}, structure, [&](SharedFile& file) {
    for (const MeshPart& part : mesh.parts)
      write_grid_faces(file, grid, before[static_cast<std::size_t>(part.id)], part);
  });
}

}  // namespace aeroloom::io
