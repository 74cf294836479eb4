/// A solver that meshes in memory: a case becomes a distributed mesh of tetrahedra, pyramids and prisms on
/// the solver's own communicator, and the solver loops over the cells and boundary faces that it holds. No
/// file is written.
///
/// usage: mpirun -n N solver CASE.yaml
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <aeroloom/parallel/communication/host.hpp>
#include <aeroloom/parallel/sandbox/sandbox.hpp>
#include <aeroloom/pipeline/mesh_case.hpp>

namespace {

using namespace aeroloom;

/// Six times the volume between a point and a face, which a diagonal from its first corner divides.
double volume6_below(const mesh::Piece& piece, const mesh::LocalIndex* corners, const mesh::CellFace& face) {
  const geometry::Vec3 from = piece.point(corners[0]), a = piece.point(corners[face[0]]);
  double sum = 0;
  for (int i = 1; i < 3 && face[i + 1] >= 0; ++i)
    sum += geometry::volume6(a, piece.point(corners[face[i]]), piece.point(corners[face[i + 1]]), from);
  return sum;
}

/// What a solver does with its cells; here it adds up their volumes.
double volume_of(const mesh::Piece& piece) {
  double sum = 0;
  for (const mesh::CellShape shape : mesh::cell_shapes) {
    const auto corners = mesh::connectivity_of(piece, shape);
    const std::size_t of_cell = mesh::corners_of(shape);
    for (std::size_t first = 0; first < corners.size(); first += of_cell)
      for (const mesh::CellFace& face : mesh::faces_of(shape))
        sum -= volume6_below(piece, corners.data() + first, face) / 6;
  }
  return sum;
}

/// What it does with its boundary; here it counts the faces of each patch.
void count_faces(const mesh::Piece& piece, std::vector<std::int64_t>& counts) {
  for (const mesh::FaceShape shape : mesh::face_shapes)
    for (const std::int32_t patch : mesh::patches_of(piece, shape)) ++counts.at(patch);
}

void solve(MPI_Comm solver_ranks, const std::string& case_file) {
  const parallel::Communicator ranks = parallel::communicator_of(solver_ranks);
  const cases::Case input = pipeline::read_case(ranks, case_file);
  const pipeline::MeshOfCase made = pipeline::run(input, ranks);
  const mesh::NumberedMesh& mesh = made.mesh;

  double volume = 0;
  std::int64_t cells = 0;
  std::vector<std::int64_t> faces(mesh.patches.size(), 0);
  for (const mesh::Piece& piece : mesh.pieces) {
    volume += volume_of(piece);
    cells += piece.total_cell_count();
    count_faces(piece, faces);
  }
  std::printf("rank %d of %d: %lld cells in %zu pieces\n", ranks.rank(), ranks.size(),
              static_cast<long long>(cells), mesh.pieces.size());
  volume = ranks.sum(volume);
  for (std::int64_t& count : faces) count = ranks.sum(count);
  if (!ranks.is_root()) return;
  for (std::size_t p = 0; p < faces.size(); ++p)
    std::printf("patch %s, %s: %lld faces\n", mesh.patches[p].c_str(),
                mesh::name_of(mesh.patch_types[p]).data(), static_cast<long long>(faces[p]));
  if (!made.missed.empty()) std::printf("gate: %s\n", made.missed.c_str());
  std::printf("%lld cells, volume %.6g, hash %s\n", static_cast<long long>(mesh.numbering.cell_count), volume,
              made.hash.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  // Before MPI, so that a crash in the CAD library or in the mesher of a piece stays there; without it
  // everything works but that.
  const parallel::SandboxServer server;

  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (argc != 2) {
    if (rank == 0) std::fprintf(stderr, "usage: mpirun -n N solver CASE.yaml\n");
    MPI_Finalize();
    return 2;
  }
  MPI_Comm solver_ranks;  // a solver may keep some ranks for other work
  MPI_Comm_split(MPI_COMM_WORLD, 0, rank, &solver_ranks);
  int outcome = 0;
  try {
    solve(solver_ranks, argv[1]);
  } catch (const std::exception& error) {
    // Every rank gets the same error at the same point.
    if (rank == 0) std::fprintf(stderr, "solver: %s\n", error.what());
    outcome = 1;
  }
  MPI_Comm_free(&solver_ranks);
  MPI_Finalize();
  return outcome;
}
