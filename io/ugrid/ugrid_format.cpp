#include "io/ugrid/ugrid_format.hpp"

#include <limits>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

struct Suffix {
  std::string_view text;
  ByteOrder order;
  int integer_bytes;
};
constexpr std::array<Suffix, 6> suffixes = {{{".lb8.ugrid", ByteOrder::little, 4},
                                             {".b8.ugrid", ByteOrder::big, 4},
                                             {".lb8l.ugrid", ByteOrder::little, 8},
                                             {".b8l.ugrid", ByteOrder::big, 8},
                                             {".lb8.ugrid64", ByteOrder::little, 8},
                                             {".b8.ugrid64", ByteOrder::big, 8}}};
constexpr std::array<const char*, 7> count_names = {
    "points", "boundary triangles", "boundary quadrilaterals", "tetrahedra", "pyramids",
    "prisms", "hexahedra"};

}  // namespace

UgridKind ugrid_kind_of(const std::string& path) {
  for (const Suffix& suffix : suffixes) {
    if (path.size() > suffix.text.size() && path.ends_with(suffix.text))
      return {suffix.order, suffix.integer_bytes, path.substr(0, path.size() - suffix.text.size())};
  }
  throw std::runtime_error(fmt::format(
      "{}: the name of a UGRID file tells its kind: .lb8.ugrid or .b8.ugrid (little- or big-endian), "
      ".lb8l.ugrid or .b8l.ugrid (64-bit integers); other kinds are not supported",
      path));
}

std::string mapbc_path_of(const std::string& path) {
  return ugrid_kind_of(path).stem + ".mapbc";
}

std::array<mesh::GlobalIndex, 7> in_ugrid_order(const ShapeCounts& counts) {
  const auto& [points, faces, cells] = counts;
  return {points, faces[0], faces[1], cells[0], cells[1], cells[2], cells[3]};
}

UgridLayout ugrid_layout(const ShapeCounts& counts, int integer_bytes) {
  UgridLayout layout;
  std::int64_t at = 7 * static_cast<std::int64_t>(integer_bytes);
  layout.points = at;
  at += 24 * counts.vertices;
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    layout.faces[s] = at;
    at += integer_bytes * corners_of(shape) * counts.faces[s];
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    layout.patch_ids[s] = at;
    at += integer_bytes * counts.faces[s];
  }
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    layout.cells[s] = at;
    at += integer_bytes * corners_of(shape) * counts.cells[s];
  }
  layout.end = at;
  return layout;
}

void require_ugrid_fits(const ShapeCounts& counts, const UgridKind& kind, const std::string& path) {
  if (kind.integer_bytes > 4) return;
  const auto values = in_ugrid_order(counts);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] <= std::numeric_limits<std::int32_t>::max()) continue;
    throw std::runtime_error(fmt::format(
        "{}: {} {} are too many for its 32-bit integers; use {}.{}.ugrid, which has 64 bits", path, values[i],
        count_names[i], kind.stem, kind.order == ByteOrder::little ? "lb8l" : "b8l"));
  }
}

int mapbc_code_of(mesh::PatchType type, NormalAxis axis) {
  switch (type) {
    case mesh::PatchType::wall:
      return 4000;
    case mesh::PatchType::slip:
      return 3000;
    case mesh::PatchType::symmetry:
      return axis == NormalAxis::none ? 3000 : 6661 + static_cast<int>(axis);
    case mesh::PatchType::farfield:
      return 5000;
    case mesh::PatchType::inlet:
      return 7011;
    case mesh::PatchType::outlet:
      return 7012;
    case mesh::PatchType::interior:
      break;
  }
  throw std::logic_error("faces between regions have no boundary condition");
}

mesh::PatchType patch_type_of_mapbc(std::int64_t code) {
  switch (code) {
    case 5:
    case 3000:
      return mesh::PatchType::slip;
    case 1:
    case 6661:
    case 6662:
    case 6663:
      return mesh::PatchType::symmetry;
    case 0:
    case 3:
    case 5000:
    case 5005:
    case 5025:
    case 5050:
      return mesh::PatchType::farfield;
    case 1001:
    case 7011:
    case 7036:
    case 7100:
      return mesh::PatchType::inlet;
    case 2:
    case 1002:
    case 5026:
    case 5051:
    case 5052:
    case 7012:
    case 7031:
      return mesh::PatchType::outlet;
    default:
      return mesh::PatchType::wall;
  }
}

}  // namespace aeroloom::io
