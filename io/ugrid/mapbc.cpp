#include "io/ugrid/mapbc.hpp"

#include "io/streams/text_lines.hpp"
#include "io/ugrid/ugrid_format.hpp"
#include "parallel/communication/collective_error.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using Table = std::map<std::int64_t, mesh::Patch>;

/// Goes to the next line that says something; false at the end.
bool next_line(TextLines& lines) {
  while (lines.next()) {
    const std::string_view text = trimmed(lines.line());
    if (!text.empty() && text.front() != '#' && text.front() != '!') return true;
  }
  return false;
}

Table parse_mapbc(const std::string& path) {
  TextLines lines(path);
  std::int64_t count = 0;
  if (!next_line(lines) || !parse_number(LineWords(lines.line()).next(), count) || count < 0)
    lines.fail("the number of patches is expected here");
  Table table;
  for (std::int64_t i = 0; i < count; ++i) {
    if (!next_line(lines)) lines.fail(fmt::format("the file ends after {} of {} patches", i, count));
    LineWords words(lines.line());
    std::int64_t id = 0, code = 0;
    if (!parse_number(words.next(), id) || !parse_number(words.next(), code))
      lines.fail("a patch has an id, the number of its condition and a name");
    std::string name(trimmed(words.rest()));
    if (name.empty()) name = fmt::format("patch_{}", id);
    if (!table.try_emplace(id, mesh::Patch{name, patch_type_of_mapbc(code)}).second)
      lines.fail(fmt::format("patch {} comes twice", id));
  }
  return table;
}

}  // namespace

Table read_mapbc(const SharedPath& file) {
  Table table;
  parallel::on_root(file.communicator, [&] {
    std::error_code none;
    if (std::filesystem::exists(file.path, none)) table = parse_mapbc(file.path);
  });
  file.communicator.broadcast_value(table);
  return table;
}

}  // namespace aeroloom::io
