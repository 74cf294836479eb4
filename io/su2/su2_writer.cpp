#include "io/su2/su2_writer.hpp"

#include "io/boundary_patches.hpp"
#include "io/streams/range_writer.hpp"
#include "io/su2/su2_markers.hpp"
#include "io/vtk_order.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/compile.h>
#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// The sections of the file that consist of lines of the parts: points, cells by shape, then faces by marker
/// and shape.
constexpr std::int32_t first_cells = 1;
constexpr std::int32_t first_faces = first_cells + cell_shape_count;

/// What stands before each section.
std::vector<std::string> headings_of(const FileMesh& mesh, const BoundaryPatches& patches,
                                     const std::vector<std::string>& names) {
  std::vector<std::string> headings(first_faces + face_shape_count * patches.size() + 1);
  headings[0] = fmt::format("NDIME= 3\nNPOIN= {}\n", mesh.vertex_count);
  headings[first_cells] = fmt::format("NELEM= {}\n", mesh.cell_count());
  headings[first_faces] = fmt::format("NMARK= {}\n", patches.size());
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto& faces = mesh.patch_faces[patches.ids[i]];
    headings[first_faces + face_shape_count * i] +=
        fmt::format("MARKER_TAG= {}\nMARKER_ELEMS= {}\n", names[i], faces[0] + faces[1]);
  }
  return headings;
}

/// Calls line(text) for each point that the part owns.
template <class Line>
void for_each_point_line(const MeshPart& part, const Line& line) {
  std::array<char, 128> text;
  for (LocalIndex v = 0; v < part.vertex_count(); ++v) {
    if (!part.owned[v]) continue;
    const geometry::Vec3 p = part.point(v);
    const char* end = fmt::format_to(text.data(), FMT_COMPILE("{} {} {}\n"), p.x, p.y, p.z);
    line(std::string_view(text.data(), static_cast<std::size_t>(end - text.data())));
  }
}

/// Elements of one shape, from `begin` to before `end` of a block.
struct ElementRange {
  const Block& block;
  LocalIndex begin, end;
  int type;  ///< VTK's number of the shape
};

/// Calls line(text) for each element: VTK's type and the points; corner k of the file is corner order(k).
template <class Order, class Line>
void for_each_element_line(const MeshPart& part, const ElementRange& elements, const Order& order,
                           const Line& line) {
  std::array<char, 160> text;
  for (LocalIndex i = elements.begin; i < elements.end; ++i) {
    char* at = fmt::format_to(text.data(), FMT_COMPILE("{}"), elements.type);
    for (int k = 0; k < elements.block.corners; ++k)
      at = fmt::format_to(at, FMT_COMPILE(" {}"), part.numbers[elements.block.item(i)[order(k)]]);
    *at++ = '\n';
    line(std::string_view(text.data(), static_cast<std::size_t>(at - text.data())));
  }
}

/// Calls begin(section), then line(text) for each line that a part has in it, section by section.
template <class Begin, class Line>
void for_each_line(const MeshPart& part, const BoundaryPatches& patches, const Begin& begin,
                   const Line& line) {
  begin(0);
  for_each_point_line(part, line);
  for (std::size_t s = 0; s < cell_shape_count; ++s) {
    begin(first_cells + static_cast<std::int32_t>(s));
    const Block& block = part.cells[s];
    for_each_element_line(
        part, {block, 0, block.count(), vtk_cell_type[s]},
        [&](int k) { return to_vtk[s][static_cast<std::size_t>(k)]; }, line);
  }
  for (std::size_t s = 0; s < face_shape_count; ++s) {
    const Block& block = part.faces[s];
    for (const Run& run : block.runs) {
      const std::int32_t place = patches.places[run.id];
      if (place < 0) continue;
      begin(first_faces + face_shape_count * place + static_cast<std::int32_t>(s));
      for_each_element_line(
          part, {block, run.begin, run.end, vtk_face_type[s]},
          [&](int k) { return (block.corners - k) % block.corners; }, line);
    }
  }
}

/// The text that a part has in a section.
struct TextBlock {
  std::int32_t section, part;
  std::int64_t bytes;   ///< its length
  std::int64_t offset;  ///< in the file
};

/// All stretches of this rank's parts with their lengths.
std::vector<TextBlock> measure(const FileMesh& mesh, const BoundaryPatches& patches) {
  std::vector<TextBlock> stretches;
  for (const MeshPart& part : mesh.parts) {
    for_each_line(
        part, patches,
        [&](std::int32_t section) {
          stretches.push_back({section, part.id, 0, 0});
        },
        [&](std::string_view text) { stretches.back().bytes += static_cast<std::int64_t>(text.size()); });
  }
  return stretches;
}

bool stands_before(const TextBlock& a, const TextBlock& b) {
  return a.section != b.section ? a.section < b.section : a.part < b.part;
}

/// Places headings and stretches one behind the other; returns the offsets of headings.
std::vector<std::int64_t> place_stretches(const std::vector<std::string>& headings,
                                          std::vector<TextBlock>& stretches) {
  std::sort(stretches.begin(), stretches.end(), stands_before);
  std::vector<std::int64_t> heading_offsets;
  std::int64_t at = 0;
  std::size_t next = 0;
  for (std::size_t section = 0; section < headings.size(); ++section) {
    heading_offsets.push_back(at);
    at += static_cast<std::int64_t>(headings[section].size());
    for (; next < stretches.size() && stretches[next].section == static_cast<std::int32_t>(section); ++next) {
      stretches[next].offset = at;
      at += stretches[next].bytes;
    }
  }
  return heading_offsets;
}

}  // namespace

void write_su2(const FileMesh& mesh, const std::string& path) {
  const parallel::Communicator& communicator = mesh.communicator();
  const BoundaryPatches patches = boundary_patches(mesh);
  const std::vector<std::string> names = marker_names(mesh, patches);
  const std::vector<std::string> headings = headings_of(mesh, patches, names);
  const std::vector<TextBlock> mine = measure(mesh, patches);
  std::vector<TextBlock> all = communicator.all_gather_items(std::span<const TextBlock>(mine));
  const std::vector<std::int64_t> heading_offsets = place_stretches(headings, all);
  remove_markers({communicator, path});
  parallel::write_shared_file(communicator, path, [&](parallel::SharedFile& file) {
    RangeWriter writer(file);
    for (std::size_t section = 0; communicator.is_root() && section < headings.size(); ++section) {
      writer.move_to(heading_offsets[section]);
      writer.put_text(headings[section]);
    }
    for (const MeshPart& part : mesh.parts) {
      for_each_line(
          part, patches,
          [&](std::int32_t section) {
            const TextBlock wanted{section, part.id, 0, 0};
            writer.move_to(std::lower_bound(all.begin(), all.end(), wanted, stands_before)->offset);
          },
          [&](std::string_view text) { writer.put_text(text); });
    }
    writer.flush();
  });
  write_markers(path, mesh, patches, names);
}

}  // namespace aeroloom::io
