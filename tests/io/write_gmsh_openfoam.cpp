/// Writes the mixed mesh of tests/io for what other programs make of it:
/// write_gmsh_openfoam FOLDER gives FOLDER/mixed.msh, FOLDER/mixed_N.msh and the cases FOLDER/binary, text,
/// wide (64-bit labels), whole (one part) and regions (four parts that end at the interface). Larger ones, as
/// FOLDER/moved.msh and the case FOLDER/moved with moved points, and FOLDER/flat.msh and FOLDER/flat, the
/// same made flat.
#include "io/gmsh/gmsh_writer.hpp"
#include "io/openfoam/openfoam_writer.hpp"
#include "parallel/communication/environment.hpp"
#include "tests/io/mixed_mesh.hpp"

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

namespace {

/// Each point is moved by a fifth of the smallest edge at most, in a direction of its own; then all of it is
/// made this many times lower.
aeroloom::io::FileMesh moved(const aeroloom::parallel::Communicator& communicator, double flatness) {
  aeroloom::io::examples::MixedMesh whole(8, 1);
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    const double at = 1.7 * static_cast<double>(v);
    aeroloom::geometry::Vec3& p = whole.points[v];
    p += 0.1 * aeroloom::geometry::Vec3{std::sin(at), std::cos(2.3 * at), std::sin(3.1 * at)};
    p.z /= flatness;
  }
  return aeroloom::io::examples::distribute(communicator, whole, 1);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace aeroloom;
  const parallel::Environment environment(argc, argv);
  if (argc != 2) return 2;
  try {
    const auto world = parallel::Communicator::world();
    const std::string folder = argv[1];
    const io::FileMesh mesh = io::examples::mixed_mesh(world, 4, 3);
    io::write_msh(mesh, folder + "/mixed.msh");
    io::write_msh_parts(mesh, folder + "/mixed.msh");
    io::write_openfoam(mesh, folder + "/binary");
    io::write_openfoam(mesh, folder + "/text", {false, 0});
    io::write_openfoam(mesh, folder + "/wide", {true, 64});
    io::write_openfoam(io::examples::mixed_mesh(world, 4, 1), folder + "/whole");
    for (const auto& [name, flatness] : {std::pair("/moved", 1.0), std::pair("/flat", 500.0)}) {
      const io::FileMesh changed = moved(world, flatness);
      io::write_msh(changed, folder + name + ".msh");
      io::write_openfoam(changed, folder + name);
    }
    io::write_openfoam(io::repartition(mesh, 4, mesh::PieceRegions::one), folder + "/regions");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
