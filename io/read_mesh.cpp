#include "io/read_mesh.hpp"

#include "geometry/input_file.hpp"
#include "geometry/name_text.hpp"
#include "io/file_formats.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::io {

namespace {

/// What a file or its companion says in bytes of some encoding becomes UTF-8, on every rank alike.
void decode_names_of(RawMesh& raw) {
  std::vector<std::string> names = raw.regions;
  for (const mesh::Patch& patch : raw.patches) names.push_back(patch.name);
  const std::vector<geometry::DecodedName> decoded = geometry::decode_names(names);
  for (std::size_t i = 0; i < decoded.size(); ++i) {
    const bool is_region = i < raw.regions.size();
    (is_region ? raw.regions[i] : raw.patches[i - raw.regions.size()].name) = decoded[i].text;
    if (!decoded[i].change.empty() && raw.file.communicator.is_root())
      parallel::log_info(fmt::format("'{}': {}", raw.file.path, decoded[i].change));
  }
}

}  // namespace

Assembled read_mesh(const SharedPath& file, std::int32_t parts) {
  const std::string& path = file.path;
  const ReadableFile found = readable_file(path);
  if (found.row == nullptr) {
    throw parallel::CollectiveError(
        parallel::FailureKind::files,
        fmt::format("'{}': no format of meshes that is read here ends like this; known are {}", path,
                    fmt::join(readable_extensions(), ", ")));
  }
  parallel::on_root(file.communicator, [&] {
    if (path.find('*') == std::string::npos) geometry::require_readable(path);
  });
  RawMesh raw = found.row->read(file);
  decode_names_of(raw);
  return assemble(std::move(raw), parts);
}

std::vector<std::string> readable_extensions() {
  std::vector<std::string> extensions;
  for (const FormatRow& row : file_formats()) {
    for (const ReadableEnd& end : row.readable_ends)
      if (!end.text.empty()) extensions.emplace_back(end.text);
  }
  return extensions;
}

std::string describe(const Assembled& file) {
  std::string text;
  const auto add = [&](mesh::GlobalIndex count, std::string_view what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(file.turned_cells, "cells turned over");
  add(file.dropped_points, "points without a cell dropped");
  add(file.unnamed_faces, "boundary faces without a patch");
  add(file.left_out_faces, "boundary faces given twice or beside all cells left out");
  return text.empty() ? "nothing to mend" : text;
}

}  // namespace aeroloom::io
