#include "pipeline/report/library_versions.hpp"

#include "cad/library_version.hpp"
#include "geometry/library_version.hpp"
#include "io/library_versions.hpp"
#include "parallel/observation/library_versions.hpp"
#include "sizing/sources/size_expression.hpp"
#include "surface/division/metis_version.hpp"
#include "volume/lattice/p4est_version.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::report {

std::string program_version() {
  return AEROLOOM_VERSION;
}

std::vector<std::pair<std::string, std::string>> library_versions() {
  return {{"OpenCASCADE", cad::opencascade_version()},
          {"TetGen", AEROLOOM_TETGEN_VERSION},
          {"VTK", io::vtk_version()},
          {"HDF5", io::hdf5_version()},
          {"METIS", partition::metis_version()},
          {"p4est", forest::p4est_version()},
          {"muparser", sizing::muparser_version()},
          {"CGAL", geometry::cgal_version()},
          {"Eigen", AEROLOOM_EIGEN_VERSION},
          {"MPI", parallel::mpi_version()},
          {"yaml-cpp", AEROLOOM_YAML_VERSION},
          {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                        NLOHMANN_JSON_VERSION_PATCH)},
          {"CLI11", AEROLOOM_CLI11_VERSION},
          {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
          {"spdlog", parallel::spdlog_version()}};
}

std::string version_text() {
  std::string text = fmt::format("aeroloom {}\n", program_version());
  for (const auto& [name, version] : library_versions()) text += fmt::format("  {:<14} {}\n", name, version);
  return text +
         "AGPL-3.0-or-later: free software, without any warranty; see the file LICENSE and\n"
         "https://www.gnu.org/licenses/agpl-3.0.html";
}

}  // namespace aeroloom::report
