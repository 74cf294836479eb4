#include "io/read_mesh.hpp"

#include "io/gmsh/gmsh_reader.hpp"
#include "io/medit/medit_reader.hpp"
#include "io/su2/su2_reader.hpp"
#include "io/ugrid/ugrid_reader.hpp"
#include "io/vtk/vtk_reader.hpp"
#include "io/vtkhdf/vtkhdf_reader.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using Reader = RawMesh (*)(const parallel::Communicator&, const std::string&);

/// Who reads files with this end of their name.
struct NamedReader {
  std::string_view extension;
  Reader read;
};

constexpr NamedReader readers[] = {
    {".vtu", read_vtk},     {".pvtu", read_vtk},      {".vtk", read_vtk},     {".vtkhdf", read_vtkhdf},
    {".ugrid", read_ugrid}, {".ugrid64", read_ugrid}, {".su2", read_su2},     {".msh", read_msh},
    {".su2b", read_su2b},   {".mesh", read_medit},    {".meshb", read_medit},
};

}  // namespace

Assembled read_mesh(const parallel::Communicator& communicator, const std::string& path, std::int32_t parts) {
  const auto found = std::find_if(std::begin(readers), std::end(readers), [&](const NamedReader& reader) {
    return path.ends_with(reader.extension);
  });
  if (found == std::end(readers)) {
    std::string known;
    for (const NamedReader& reader : readers)
      known += fmt::format("{}{}", known.empty() ? "" : ", ", reader.extension);
    throw parallel::CollectiveError(
        parallel::FailureKind::files,
        fmt::format("'{}': no format of meshes that is read here ends like this; known are {}", path, known));
  }
  parallel::agree(communicator, [&] {
    if (communicator.is_root() && path.find('*') == std::string::npos && !std::filesystem::exists(path))
      throw std::filesystem::filesystem_error("cannot read", path,
                                              std::make_error_code(std::errc::no_such_file_or_directory));
  });
  return assemble(communicator, found->read(communicator, path), path, parts);
}

std::vector<std::string> readable_extensions() {
  std::vector<std::string> extensions;
  for (const NamedReader& reader : readers) extensions.emplace_back(reader.extension);
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
  add(file.left_out_faces, "boundary faces inside a region or beside all cells left out");
  return text.empty() ? "nothing to mend" : text;
}

}  // namespace aeroloom::io
