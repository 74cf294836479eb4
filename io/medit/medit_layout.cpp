#include "io/medit/medit_layout.hpp"

#include "io/streams/byte_order.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

/// A coordinate of a text file, "-1.2345678901234567e-100", with a blank after it.
constexpr int text_coordinate = 25;

GlobalIndex largest_number(const MeditCounts& counts) {
  GlobalIndex largest = std::max(counts.vertices, counts.largest_reference);
  for (const GlobalIndex count : counts.faces) largest = std::max(largest, count);
  for (const GlobalIndex count : counts.cells) largest = std::max(largest, count);
  return largest;
}

std::string binary_header(const MeditLayout& layout) {
  std::string bytes;
  append_bytes<std::int32_t>(bytes, 1);
  append_bytes<std::int32_t>(bytes, layout.version);
  append_bytes<std::int32_t>(bytes, static_cast<std::int32_t>(MeditKeyword::dimension));
  append_bytes<std::int64_t>(bytes, 24);
  append_bytes<std::int32_t>(bytes, 3);
  return bytes;
}

std::string section_header(const MeditLayout& layout, const MeditSection& section) {
  if (layout.encoding == MeditEncoding::text)
    return fmt::format("\n{}\n{}\n", name_of(section.keyword), section.count);
  std::string bytes;
  append_bytes(bytes, static_cast<std::int32_t>(section.keyword));
  const std::int64_t header_bytes = 4 + 8 + layout.integer_width;
  append_bytes<std::int64_t>(bytes, section.begin + header_bytes + section.count * section.line_bytes);
  if (layout.version < 4) {
    append_bytes(bytes, static_cast<std::int32_t>(section.count));
  } else {
    append_bytes<std::int64_t>(bytes, section.count);
  }
  return bytes;
}

void add_section(MeditLayout& layout, MeditKeyword keyword, int corners, GlobalIndex count) {
  if (count == 0 && keyword != MeditKeyword::vertices) return;
  const bool text = layout.encoding == MeditEncoding::text;
  MeditSection section;
  section.keyword = keyword;
  section.count = count;
  section.begin = layout.size;
  section.numbers = corners + 1;
  section.line_bytes = keyword == MeditKeyword::vertices
                           ? (text ? 3 * text_coordinate + 2 : 3 * 8 + layout.integer_width)
                           : std::int64_t{section.numbers} * (layout.integer_width + (text ? 1 : 0));
  section.header = section_header(layout, section);
  section.lines = section.begin + static_cast<std::int64_t>(section.header.size());
  layout.size = section.end();
  layout.sections.push_back(std::move(section));
}

}  // namespace

std::string_view name_of(MeditKeyword keyword) {
  constexpr std::array<std::pair<MeditKeyword, std::string_view>, 9> names = {
      {{MeditKeyword::dimension, "Dimension"},
       {MeditKeyword::vertices, "Vertices"},
       {MeditKeyword::triangles, "Triangles"},
       {MeditKeyword::quadrilaterals, "Quadrilaterals"},
       {MeditKeyword::tetrahedra, "Tetrahedra"},
       {MeditKeyword::prisms, "Prisms"},
       {MeditKeyword::hexahedra, "Hexahedra"},
       {MeditKeyword::pyramids, "Pyramids"},
       {MeditKeyword::end, "End"}}};
  for (const auto& [of_name, name] : names)
    if (of_name == keyword) return name;
  throw std::logic_error("no such keyword");
}

const MeditSection* MeditLayout::find(MeditKeyword keyword) const {
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [&](const MeditSection& section) { return section.keyword == keyword; });
  return found == sections.end() ? nullptr : &*found;
}

MeditLayout medit_layout(const MeditCounts& counts, MeditEncoding encoding, bool wide) {
  MeditLayout layout;
  layout.encoding = encoding;
  const bool text = encoding == MeditEncoding::text;
  const GlobalIndex largest = largest_number(counts);
  if (text) {
    layout.version = 2;
    layout.integer_width = static_cast<int>(fmt::formatted_size("{}", largest));
    layout.header = "MeshVersionFormatted 2\nDimension 3\n";
    layout.footer = "\nEnd\n";
  } else {
    layout.version = wide || largest > std::numeric_limits<std::int32_t>::max() ? 4 : 3;
    layout.integer_width = layout.version < 4 ? 4 : 8;
    layout.header = binary_header(layout);
    append_bytes(layout.footer, static_cast<std::int32_t>(MeditKeyword::end));
    append_bytes<std::int64_t>(layout.footer, 0);
  }
  layout.size = static_cast<std::int64_t>(layout.header.size());
  add_section(layout, MeditKeyword::vertices, 3, counts.vertices);
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    add_section(layout, medit_faces[s], corners_of(shape), counts.faces[s]);
  }
  for (const CellShape shape : cell_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    add_section(layout, medit_cells[s], corners_of(shape), counts.cells[s]);
  }
  layout.footer_begin = layout.size;
  layout.size += static_cast<std::int64_t>(layout.footer.size());
  return layout;
}

}  // namespace aeroloom::io
