/// A solver that meshes in memory: the built-in aircraft, or a CAD file, becomes a distributed mesh of
/// tetrahedra on the solver's own communicator, and the solver loops over the tetrahedra it holds. No file is
/// written.
///
/// usage: mpirun -n N solver [FILE.step]
#include <cstdio>
#include <exception>
#include <string>

#include <aeroloom/improve/improve.hpp>
#include <aeroloom/mesh/data/distributed_mesh.hpp>
#include <aeroloom/parallel/communication/host.hpp>
#include <aeroloom/parallel/sandbox/sandbox.hpp>
#include <aeroloom/pipeline/domain/load_domain.hpp>
#include <aeroloom/sizing/sizing.hpp>
#include <aeroloom/surface/surface.hpp>
#include <aeroloom/volume/volume.hpp>

namespace {

using namespace aeroloom;

/// The domain around the aircraft: one rank reads and heals, all build the same model.
cad::Model load(const parallel::Communicator& ranks, const std::string& file) {
  cad::DomainOptions options;
  options.file = file;
  if (file.empty()) options.transport.emplace();
  cad::DomainReport report;
  return domain::load_domain(ranks, options, report);
}

/// From CAD to improved tetrahedra, stage by stage.
mesh::DistributedMesh make_mesh(const parallel::Communicator& ranks, const cad::Model& model) {
  constexpr double wanted_tetrahedra = 60'000;
  const sizing::SizingOptions sizes = sizing::choose_sizes(ranks, model, wanted_tetrahedra);
  const sizing::SizeField field = sizing::build_size_field(ranks, model, sizes);

  const surface::SurfaceMesh surface = surface::mesh_surface(model, field, {});

  volume::VolumeOptions pieces;
  pieces.piece_tets = 20'000;
  const volume::VolumeInput input{surface, pieces};
  volume::VolumeReport report;
  mesh::DistributedMesh volume = volume::fill_zones(input, volume::decompose(input), report);

  cad::PointLocator locator(model);
  improve::improve_mesh(volume, {}, {&locator, &surface.field});
  return volume;
}

/// What a solver does with its cells; here it adds up their volumes.
double volume_of(const mesh::Piece& piece) {
  double sum = 0;
  for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
    const mesh::LocalIndex* v = piece.cell(c);
    sum += geometry::volume6(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])) / 6;
  }
  return sum;
}

void solve(MPI_Comm solver_ranks, const std::string& file) {
  const parallel::Communicator ranks = parallel::communicator_of(solver_ranks);
  const cad::Model model = load(ranks, file);
  const mesh::DistributedMesh mesh = make_mesh(ranks, model);
  std::int64_t cells = 0;
  double volume = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    cells += piece.cell_count();
    volume += volume_of(piece);
  }
  std::printf("rank %d of %d: %lld tetrahedra in %zu pieces\n", ranks.rank(), ranks.size(),
              static_cast<long long>(cells), mesh.pieces.size());
  cells = ranks.sum(cells);
  volume = ranks.sum(volume);
  const std::string hash = mesh::hash_mesh(mesh::number_mesh(mesh));
  if (ranks.is_root()) {
    std::printf("%lld tetrahedra, volume %.9g, hash %s\n", static_cast<long long>(cells), volume,
                hash.c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Before MPI, so that a crash in the CAD library or in the mesher of a piece stays there; without it
  // everything works but that.
  const parallel::SandboxServer server;

  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm solver_ranks;  // a solver may keep some ranks for other work
  MPI_Comm_split(MPI_COMM_WORLD, 0, rank, &solver_ranks);
  int outcome = 0;
  try {
    solve(solver_ranks, argc > 1 ? argv[1] : "");
  } catch (const std::exception& error) {
    // Every rank gets the same error at the same point.
    if (rank == 0) std::fprintf(stderr, "solver: %s\n", error.what());
    outcome = 1;
  }
  MPI_Comm_free(&solver_ranks);
  MPI_Finalize();
  return outcome;
}
