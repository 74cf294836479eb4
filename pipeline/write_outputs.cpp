#include "pipeline/write_outputs.hpp"

#include "geometry/input_file.hpp"
#include "io/file_formats.hpp"
#include "io/shared_path.hpp"
#include "io/staged_files.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "io/write_mesh.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

bool wants_vtk(const cases::OutputOptions& output) {
  return std::find(output.formats.begin(), output.formats.end(), io::FileFormat::vtu) != output.formats.end();
}

std::string path_of(const cases::OutputOptions& output, io::FileFormat format) {
  const io::FormatRow& row = io::row_of(format);
  return fmt::format("{}{}{}/mesh{}", output.directory, row.folder.empty() ? "" : "/", row.folder,
                     row.ends.front());
}

namespace {

/// What a format writes beside the file of the mesh.
std::vector<std::string> companions_of(io::FileFormat format) {
  switch (format) {
    case io::FileFormat::vtu:
      return {"surface.pvtp", "interfaces.pvtp"};
    case io::FileFormat::vtkhdf:
      return {"mesh_surface.vtkhdf"};
    case io::FileFormat::ugrid:
    case io::FileFormat::ugrid64:
      return {"mesh.mapbc"};
    case io::FileFormat::su2:
    case io::FileFormat::su2b:
      return {"mesh_markers.cfg"};
    case io::FileFormat::meshb:
      return {"mesh.names"};
    default:
      return {};
  }
}

}  // namespace

void require_free_places(const cases::OutputOptions& output) {
  using io::Arrival, io::require_replaceable;
  const std::string folder = output.directory + "/";
  for (const char* const name : {"report.json", "report.html", "tasks.csv"})
    require_replaceable(folder + name, Arrival::file);
  for (const io::FileFormat format : output.formats) {
    const std::string_view own = io::row_of(format).folder;
    if (!own.empty()) require_replaceable(folder + std::string(own), Arrival::folder);
    require_replaceable(path_of(output, format), Arrival::file);
    for (const std::string& name : companions_of(format)) require_replaceable(folder + name, Arrival::file);
  }
  if (wants_vtk(output))
    for (const char* const name : {"mesh", "surface", "interfaces"})
      require_replaceable(folder + name, Arrival::folder);
}

EarlierFiles::EarlierFiles(const cases::OutputOptions& output) {
  namespace fs = std::filesystem;
  std::vector<fs::path> places{output.directory + "/surface.pvtp", output.directory + "/interfaces.pvtp"};
  for (const io::FormatRow& row : io::file_formats()) places.emplace_back(path_of(output, row.format));
  for (const fs::path& place : places) {
    std::error_code ignored;  // what cannot be looked at is not there
    const fs::file_time_type written = fs::last_write_time(place, ignored);
    if (!ignored) _files.emplace_back(place, written);
  }
  const std::string report = output.directory + "/report.json";
  if (geometry::refusal_of(report)) return;
  const auto earlier = nlohmann::json::parse(geometry::read_whole(report), nullptr, false);
  if (!earlier.is_object() || !earlier.contains("mesh") || !earlier["mesh"].is_object()) return;
  _hash = earlier["mesh"].value("hash", "");
  for (const auto& name : earlier.value("older_files", nlohmann::json::array()))
    if (name.is_string()) _of_others.insert(name.get<std::string>());
}

std::vector<std::string> EarlierFiles::left(const std::string& hash) const {
  std::vector<std::string> names;
  for (const auto& [place, written] : _files) {
    std::error_code ignored;
    if (std::filesystem::last_write_time(place, ignored) != written || ignored) continue;
    const std::string name = place.filename().string();
    const bool is_this_mesh = !hash.empty() && hash == _hash && _of_others.count(name) == 0;
    if (!is_this_mesh) names.push_back(name);
  }
  return names;
}

namespace {

void write_volume(const io::FileMesh& mesh, io::FileFormat format, const cases::OutputOptions& output,
                  const std::string& path) {
  const parallel::Communicator& communicator = mesh.pieces->communicator;
  const double begin = parallel::wall_seconds();
  io::write_mesh(mesh, format, path, {static_cast<std::int32_t>(output.parts), output.compression});
  if (communicator.is_root() && output.formats.size() > 1) {
    parallel::log_info(
        fmt::format("wrote '{}' in {:.2f} s", path_of(output, format), parallel::wall_seconds() - begin));
  }
}

/// Writes surface.pvtp, the boundary of the domain, and interfaces.pvtp with what lies between regions.
void write_surfaces(const mesh::NumberedMesh* surface, const io::FileMesh& volume, const std::string& folder,
                    io::Compression compression) {
  const bool has_inner_faces = volume.pieces->has_inner_faces();
  if (surface == nullptr) {
    io::write_surface(volume, folder, "surface", compression);
    if (has_inner_faces)
      io::write_surface(volume, folder, "interfaces", compression, io::SurfaceFaces::between_regions);
    return;
  }
  if (!has_inner_faces) return io::write_surface(*surface, folder, "surface", compression);
  for (const bool inner : {false, true}) {
    mesh::DistributedMesh part = mesh::part_of_surface(
        *surface, inner ? mesh::SurfacePart::between_regions : mesh::SurfacePart::outside);
    io::write_surface(mesh::number_mesh(std::move(part)), folder, inner ? "interfaces" : "surface",
                      compression);
  }
}

}  // namespace

void write_outputs(const mesh::NumberedMesh& volume, const mesh::NumberedMesh* surface,
                   const cases::OutputOptions& output, const io::FlowReference& flow) {
  const parallel::Communicator& communicator = volume.communicator;
  io::FileMesh mesh = io::file_mesh_of(volume);
  mesh.flow = flow;
  io::write_together(communicator, output.directory, "mesh", [&](const std::string& staging) {
    cases::OutputOptions staged = output;
    staged.directory = staging;
    for (const io::FileFormat format : output.formats) {
      if (io::row_of(format).folder.empty()) write_volume(mesh, format, output, path_of(staged, format));
    }
    if (wants_vtk(output)) write_surfaces(surface, mesh, staging, output.compression);
    // Last, for what may fail has not: these folders are their user's, too.
    for (const io::FileFormat format : output.formats) {
      if (!io::row_of(format).folder.empty()) write_volume(mesh, format, output, path_of(output, format));
    }
  });
  const auto parts = static_cast<std::int32_t>(output.parts > 0 ? output.parts : mesh.part_count);
  for (const io::FileFormat format : output.formats) {
    const io::FormatRow& row = io::row_of(format);
    if (row.remove_later_parts != nullptr)
      row.remove_later_parts({communicator, path_of(output, format)}, parts);
  }
}

}  // namespace aeroloom::pipeline
