#include "pipeline/convert_file.hpp"

#include "io/read_mesh.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/timers.hpp"

#include <filesystem>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::pipeline {

void convert_file(const parallel::Communicator& communicator, const Conversion& conversion) {
  const std::optional<io::FileFormat> format =
      conversion.format ? conversion.format : io::format_of_path(conversion.to);
  if (!format) {
    throw std::invalid_argument(
        fmt::format("'{}': no format that is written here ends like this; known are {}", conversion.to,
                    io::known_extensions()));
  }
  for (const std::string& target : {conversion.to, io::written_path(*format, conversion.to)}) {
    std::error_code ignored;
    if (std::filesystem::equivalent(conversion.from, target, ignored))
      throw std::invalid_argument(fmt::format("'{}' cannot be converted onto itself", conversion.from));
  }
  const double begin = parallel::wall_seconds();
  io::Assembled file = io::read_mesh({communicator, conversion.from}, 0);
  file.mesh.flow.reynolds = conversion.reynolds;
  file.mesh.flow.length = conversion.length;
  const io::FileMesh& mesh = file.mesh;
  if (communicator.is_root()) {
    parallel::log_info(fmt::format(
        "read {} points, {} tetrahedra, {} pyramids, {} prisms, {} hexahedra, {} region(s), {} patch(es) in "
        "{:.2f} s; {}",
        mesh.vertex_count, mesh.cell_count(io::CellShape::tetrahedron),
        mesh.cell_count(io::CellShape::pyramid), mesh.cell_count(io::CellShape::prism),
        mesh.cell_count(io::CellShape::hexahedron), mesh.regions.size(), mesh.patches.size(),
        parallel::wall_seconds() - begin, io::describe(file)));
  }
  const double read = parallel::wall_seconds();
  io::WriteOptions options = conversion.options;
  options.recut = true;
  options.surface = true;
  io::write_mesh(mesh, *format, conversion.to, options);
  if (communicator.is_root()) {
    parallel::log_info(fmt::format("wrote '{}' ({}) in {:.2f} s", io::written_path(*format, conversion.to),
                                   io::name_of(*format), parallel::wall_seconds() - read));
  }
}

}  // namespace aeroloom::pipeline
