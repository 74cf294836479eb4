#include "io/vtkhdf/vtkhdf_items.hpp"

#include "io/hdf5/input_file.hpp"
#include "io/vtk_order.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io::vtkhdf {

using hdf5::InputFile;

namespace {

/// The name of a kind of cells that cannot be read; nothing for those that are left out.
std::string name_of_cell_type(std::int64_t type) {
  switch (type) {
    case 11:
      return "a voxel";
    case 42:
      return "a polyhedron";
    default:
      return type > 20 ? "of higher order" : "of another shape";
  }
}

constexpr std::int64_t cells_at_a_time = std::int64_t{1} << 20;
constexpr std::int64_t duplicate_cell = 1;  ///< of vtkGhostType

/// Cells or faces of a range of the file: what each is and where its corners are.
struct Elements {
  std::int64_t first = 0;                  ///< in the file
  std::vector<std::int64_t> types;         ///< VTK's
  std::vector<std::int64_t> corner_begin;  ///< in `corners`
  std::vector<std::int64_t> corners;       ///< as they stand in the file
};

class Reader {
public:
  Reader(const FileFacts& facts, const std::string& path) : _facts(facts), _file(path) {}

  void read_points(RawMesh& raw) const {
    const LocalRange mine = raw.file.local_range(_facts.all().points);
    raw.coordinates = _file.reals("/VTKHDF/Points", mine.begin, mine.end - mine.begin);
    if (_facts.id_array.empty()) {
      for (std::int64_t i = mine.begin; i < mine.end; ++i) raw.point_ids.push_back(i);
      return;
    }
    raw.point_ids = _file.integers(_facts.id_array, mine.begin, mine.end - mine.begin);
    for (std::size_t i = 0; i < raw.point_ids.size(); ++i) {
      if (raw.point_ids[i] < 0 || raw.point_ids[i] > largest_id) {
        fail(fmt::format("point {} has the id {} in {}", mine.begin + static_cast<std::int64_t>(i),
                         raw.point_ids[i], _facts.id_array));
      }
    }
  }

  /// Corners become places among the points of all partitions.
  void read_cells(RawMesh& raw) {
    const LocalRange mine = raw.file.local_range(_facts.all().cells);
    for (std::int64_t begin = mine.begin; begin < mine.end; begin += cells_at_a_time)
      read_cells(raw, {begin, std::min(mine.end, begin + cells_at_a_time)});
  }

  /// Corners are ids of points.
  void read_boundary(RawMesh& raw) const {
    if (!_facts.has_boundary) return;
    const LocalRange mine = raw.file.local_range(_facts.boundary_faces);
    for (std::int64_t begin = mine.begin; begin < mine.end; begin += cells_at_a_time) {
      const std::int64_t count = std::min(mine.end - begin, cells_at_a_time);
      Elements faces;
      faces.first = begin;
      faces.types = _file.integers("/Boundary/Types", begin, count);
      faces.corner_begin = _file.integers("/Boundary/Offsets", begin, count + 1);
      take_corners(faces, "/Boundary/Connectivity", _facts.boundary_corners);
      const std::vector<std::int64_t> patches = _file.integers("/Boundary/Patch", begin, count);
      for (std::size_t i = 0; i < faces.types.size(); ++i) {
        const std::optional<std::size_t> shape = face_shape(faces.types[i]);
        if (!shape)
          fail(fmt::format("face {} of /Boundary has the type {}", place(faces, i), faces.types[i]));
        add_face(raw, faces, i, *shape, patches[i]);
      }
    }
  }

private:
  [[noreturn]] void fail(const std::string& text) const {
    throw std::runtime_error(_file.path() + ": " + text);
  }
  static std::int64_t place(const Elements& elements, std::size_t i) {
    return elements.first + static_cast<std::int64_t>(i);
  }

  static std::optional<std::size_t> face_shape(std::int64_t type) {
    const auto found = std::find(vtk_face_type.begin(), vtk_face_type.end(), type);
    if (found == vtk_face_type.end()) return std::nullopt;
    return static_cast<std::size_t>(found - vtk_face_type.begin());
  }
  static std::optional<std::size_t> cell_shape(std::int64_t type) {
    const auto found = std::find(vtk_cell_type.begin(), vtk_cell_type.end(), type);
    if (found == vtk_cell_type.end()) return std::nullopt;
    return static_cast<std::size_t>(found - vtk_cell_type.begin());
  }

  /// Reads the corners from the first to the last offset, and counts offsets from the first.
  void take_corners(Elements& elements, const char* array, std::int64_t all) const {
    std::vector<std::int64_t>& offsets = elements.corner_begin;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      if (offsets[i] < 0 || offsets[i] > all || (i > 0 && offsets[i] < offsets[i - 1])) {
        fail(fmt::format("offset {} of {} is {}: less than the one before it, or more than the {} corners",
                         place(elements, i), array, offsets[i], all));
      }
    }
    const std::int64_t first = offsets.front();
    elements.corners = _file.integers(array, first, offsets.back() - first);
    for (std::int64_t& offset : offsets) offset -= first;
  }

  std::size_t partition_of(std::int64_t cell) const {
    const auto above = std::upper_bound(_facts.before.begin(), _facts.before.end(), cell,
                                        [](std::int64_t c, const auto& row) { return c < row.cells; });
    return static_cast<std::size_t>(above - _facts.before.begin()) - 1;
  }

  /// The cells of a partition take its corners from the first to the last. Whoever reads the cell asks, so
  /// that the answer does not depend on where the ranges of ranks end.
  void require_all_corners(std::int64_t cell, std::size_t p, std::int64_t begin, std::int64_t end) const {
    const GridCounts &before = _facts.before[p], &after = _facts.before[p + 1];
    const std::int64_t corners = after.corners - before.corners;
    if (cell == before.cells && begin != 0)
      fail(fmt::format("the corners of cell {}, the first of partition {}, begin at {}", cell, p, begin));
    if (cell + 1 == after.cells && end != corners) {
      fail(fmt::format("the corners of cell {}, the last of partition {}, end at {} of {}", cell, p, end,
                       corners));
    }
  }

  /// The cells of a range with offsets into all corners of the file: each partition has one offset more than
  /// cells, and counts from 0.
  Elements elements_of(LocalRange range) {
    Elements cells;
    cells.first = range.begin;
    cells.types = _file.integers("/VTKHDF/Types", range.begin, range.end - range.begin);
    for (std::size_t i = 0; i < cells.types.size(); ++i) check_type(cells.types[i], place(cells, i));
    const auto first_partition = static_cast<std::int64_t>(partition_of(range.begin));
    const auto last_partition = static_cast<std::int64_t>(partition_of(range.end - 1));
    const std::int64_t first_offset = range.begin + first_partition;
    const std::vector<std::int64_t> offsets =
        _file.integers("/VTKHDF/Offsets", first_offset, range.end + last_partition + 1 - first_offset);
    _partition.clear();
    std::size_t p = static_cast<std::size_t>(first_partition);
    for (std::int64_t cell = range.begin; cell < range.end; ++cell) {
      while (_facts.before[p + 1].cells <= cell) ++p;
      _partition.push_back(p);
      const auto at = static_cast<std::size_t>(cell + static_cast<std::int64_t>(p) - first_offset);
      const std::int64_t in_partition = _facts.before[p + 1].corners - _facts.before[p].corners;
      for (const std::size_t end : {at, at + 1}) {
        if (offsets[end] < 0 || offsets[end] > in_partition) {
          fail(fmt::format("the corners of cell {} begin or end at {} of the {} in partition {}", cell,
                           offsets[end], in_partition, p));
        }
      }
      require_all_corners(cell, p, offsets[at], offsets[at + 1]);
      if (cells.corner_begin.empty()) cells.corner_begin.push_back(_facts.before[p].corners + offsets[at]);
      cells.corner_begin.push_back(_facts.before[p].corners + offsets[at + 1]);
    }
    take_corners(cells, "/VTKHDF/Connectivity", _facts.all().corners);
    return cells;
  }

  void check_type(std::int64_t type, std::int64_t cell) const {
    const bool is_left_out = type >= 0 && type <= 4;  // nothing, points and lines
    if (is_left_out || cell_shape(type) || face_shape(type)) return;
    fail(fmt::format(
        "cell {} is {} (VTK's type {}); only tetrahedra, pyramids, prisms and hexahedra can be read", cell,
        name_of_cell_type(type), type));
  }

  void read_cells(RawMesh& raw, LocalRange range) {
    Elements cells = elements_of(range);
    const std::int64_t count = range.end - range.begin;
    const auto column = [&](bool exists, const char* name) {
      return exists ? _file.integers(name, range.begin, count)
                    : std::vector<std::int64_t>(static_cast<std::size_t>(count));
    };
    const auto regions = column(_facts.has_regions, "/VTKHDF/CellData/region");
    const auto ghosts = column(_facts.has_ghosts, "/VTKHDF/CellData/vtkGhostType");
    const bool takes_faces = _facts.has_patches && !_facts.has_boundary;
    const auto patches = column(takes_faces, "/VTKHDF/CellData/patch");
    for (std::size_t i = 0; i < cells.types.size(); ++i) {
      if ((ghosts[i] & duplicate_cell) != 0) continue;
      const std::optional<std::size_t> shape = cell_shape(cells.types[i]), face = face_shape(cells.types[i]);
      if (!shape && !(face && takes_faces)) continue;
      globalize(cells, i);
      if (shape) {
        add_cell(raw, cells, i, *shape, regions[i]);
      } else {
        add_face(raw, cells, i, *face, patches[i]);
      }
    }
  }

  /// From points of a partition to those of all.
  void globalize(Elements& cells, std::size_t i) const {
    const GridCounts& before = _facts.before[_partition[i]];
    const std::int64_t points = _facts.before[_partition[i] + 1].points - before.points;
    for (std::int64_t k = cells.corner_begin[i]; k < cells.corner_begin[i + 1]; ++k) {
      std::int64_t& corner = cells.corners[static_cast<std::size_t>(k)];
      if (corner < 0 || corner >= points) {
        fail(fmt::format("cell {} has the corner {}, but partition {} has {} points", place(cells, i), corner,
                         _partition[i], points));
      }
      corner += before.points;
    }
  }

  void require_corners(const Elements& elements, std::size_t i, int expected) const {
    const std::int64_t corners = elements.corner_begin[i + 1] - elements.corner_begin[i];
    if (corners != expected) {
      fail(fmt::format("cell or face {} of VTK's type {} has {} corners, not {}", place(elements, i),
                       elements.types[i], corners, expected));
    }
  }
  std::int32_t id_of(std::int64_t value, const char* what) const {
    if (value < std::numeric_limits<std::int32_t>::min() || value > std::numeric_limits<std::int32_t>::max())
      fail(fmt::format("{} has the value {}, which needs more than 32 bits", what, value));
    return static_cast<std::int32_t>(value);
  }

  void add_cell(RawMesh& raw, const Elements& cells, std::size_t i, std::size_t shape,
                std::int64_t region) const {
    const int corners = corners_of(cell_shapes[shape]);
    require_corners(cells, i, corners);
    for (int k = 0; k < corners; ++k) {
      raw.cells[shape].push_back(
          cells.corners[static_cast<std::size_t>(cells.corner_begin[i] + to_vtk[shape][k])]);
    }
    raw.cell_regions[shape].push_back(id_of(region, "region"));
  }

  void add_face(RawMesh& raw, const Elements& faces, std::size_t i, std::size_t shape,
                std::int64_t patch) const {
    const int corners = corners_of(face_shapes[shape]);
    require_corners(faces, i, corners);
    const auto first = faces.corners.begin() + faces.corner_begin[i];
    raw.faces[shape].insert(raw.faces[shape].end(), first, first + corners);
    raw.face_patches[shape].push_back(id_of(patch, "patch"));
  }

  const FileFacts& _facts;
  InputFile _file;
  std::vector<std::size_t> _partition;  ///< of the cells being read
};

}  // namespace

void read_local_items(const FileFacts& facts, RawMesh& grid, RawMesh& boundary) {
  Reader reader(facts, grid.file.path);
  reader.read_points(grid);
  reader.read_cells(grid);
  reader.read_boundary(boundary);
}

}  // namespace aeroloom::io::vtkhdf
