#include "pipeline/write_outputs.hpp"

#include "mesh/boundary_mesh.hpp"
#include "parallel/log.hpp"
#include "parallel/timers.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {

bool wants_vtk(const OutputOptions& output) {
  return std::find(output.formats.begin(), output.formats.end(), io::FileFormat::vtu) != output.formats.end();
}

std::string path_of(const OutputOptions& output, io::FileFormat format) {
  const auto name = std::find_if(io::format_names.begin(), io::format_names.end(),
                                 [&](const io::FormatName& known) { return known.format == format; });
  const std::string folder = format == io::FileFormat::openfoam ? "/openfoam" : "";
  return fmt::format("{}{}/mesh{}", output.directory, folder, name->extension);
}

EarlierFiles::EarlierFiles(const OutputOptions& output) {
  namespace fs = std::filesystem;
  std::vector<fs::path> places{output.directory + "/surface.pvtp", output.directory + "/interfaces.pvtp"};
  for (const io::FormatName& known : io::format_names) places.emplace_back(path_of(output, known.format));
  for (const fs::path& place : places) {
    std::error_code ignored;  // what cannot be looked at is not there
    const fs::file_time_type written = fs::last_write_time(place, ignored);
    if (!ignored) _files.emplace_back(place, written);
  }
}

std::vector<std::string> EarlierFiles::left() const {
  std::vector<std::string> names;
  for (const auto& [place, written] : _files) {
    std::error_code ignored;
    if (std::filesystem::last_write_time(place, ignored) == written && !ignored)
      names.push_back(place.filename().string());
  }
  return names;
}

void write_outputs(const parallel::Communicator& communicator, const mesh::DistributedMesh& volume,
                   const mesh::Numbering& numbering, const OutputOptions& output) {
  const io::FileMesh mesh = io::file_mesh_of(communicator, volume, numbering);
  for (const io::FileFormat format : output.formats) {
    const double begin = parallel::wall_seconds();
    const std::string path = path_of(output, format);
    io::write_mesh(communicator, mesh, format, path,
                   {static_cast<std::int32_t>(output.parts), output.compression});
    if (communicator.is_root() && output.formats.size() > 1)
      parallel::log_info(fmt::format("wrote '{}' in {:.2f} s", path, parallel::wall_seconds() - begin));
  }
}

void write_surfaces(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                    const mesh::Numbering& numbering, const OutputOptions& output) {
  if (!surface.has_inner_faces()) {
    io::write_surface(communicator, surface, numbering, output.directory, "surface", output.compression);
    return;
  }
  for (const bool inner : {false, true}) {
    const mesh::DistributedMesh part = mesh::part_of_surface(
        surface, inner ? mesh::SurfacePart::between_regions : mesh::SurfacePart::outside);
    io::write_surface(communicator, part, mesh::number_mesh(communicator, part), output.directory,
                      inner ? "interfaces" : "surface", output.compression);
  }
}

}  // namespace aeroloom::pipeline
