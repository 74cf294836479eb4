/// A mesh of cells of all shapes through all that a mesh goes through: mpirun -n N
/// mixed_benchmark [SQUARES [FOLDER]] assembles the hand-made mesh of tests/meshes/mixed_mesh.hpp with so
/// many squares along each side (353: a million cells), and prints one RESULT line with the seconds of each
/// step and the hash, the same on any number of ranks. Every check must then find out a mesh that is broken
/// on purpose; exit code 1 otherwise.
#include "io/checkpoint_file.hpp"
#include "io/raw_mesh.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/face_links.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/transfer/repartition.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/timers.hpp"
#include "tests/meshes/mixed_mesh.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

using namespace aeroloom;
using mesh::examples::MixedMesh;
using parallel::Communicator;

namespace {

constexpr mesh::GlobalIndex cells_per_piece = 60'000;

/// Steps and what they took, slowest rank.
class Steps {
public:
  explicit Steps(const Communicator& communicator) : _communicator(communicator) {}

  template <class Work>
  auto time(const char* step, const Work& work) {
    _communicator.barrier();
    const double begin = parallel::wall_seconds();
    auto result = work();
    const double seconds = _communicator.maximum(parallel::wall_seconds() - begin);
    _text += fmt::format(" {}={:.3f}", step, seconds);
    return result;
  }
  const std::string& text() const { return _text; }

private:
  const Communicator& _communicator;
  std::string _text;
};

/// The columns of this rank, without boundary faces: those are found.
io::RawMesh local_columns(const Communicator& communicator, int squares) {
  const auto first_of = [&](int rank) { return rank * (squares + 1) / communicator.size(); };
  const MixedMesh columns(squares, {first_of(communicator.rank()), first_of(communicator.rank() + 1)});
  io::RawMesh raw({communicator, "mixed"});
  raw.regions = columns.regions;
  for (std::size_t v = 0; v < columns.points.size(); ++v) {
    const geometry::Vec3 p = columns.points[v];
    raw.point_ids.push_back(columns.id(static_cast<int>(v)));
    raw.coordinates.insert(raw.coordinates.end(), {p.x, p.y, p.z});
  }
  for (const mesh::examples::WholeCell& cell : columns.cells) {
    const auto s = static_cast<std::size_t>(cell.shape);
    for (const int v : cell.corners) raw.cells[s].push_back(columns.id(v));
    raw.cell_regions[s].push_back(cell.region);
  }
  return raw;
}

void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(what);
}

/// Whether `work` ends in the error of all ranks.
template <class Work>
bool is_refused(const Work& work) {
  try {
    work();
  } catch (const parallel::CollectiveError&) {
    return true;
  }
  return false;
}

/// Writes a checkpoint and reads it; another time with one bit changed in the file, which must not be read.
mesh::DistributedMesh through_checkpoint(const mesh::DistributedMesh& mesh, const std::string& folder) {
  const Communicator& communicator = mesh.communicator;
  const std::string path = (std::filesystem::path(folder) / "mixed.checkpoint").string();
  io::CheckpointDraft draft;
  for (const mesh::Piece& piece : mesh.pieces)
    draft.items.push_back({piece.id, [&piece] { return parallel::to_wire(piece); }});
  io::write_checkpoint({communicator, path}, {}, draft);
  mesh::DistributedMesh result = mesh;
  result.pieces.clear();
  for (const io::CheckpointContent::Item& item : io::read_checkpoint({communicator, path}).items)
    result.pieces.push_back(parallel::from_wire<mesh::Piece>(item.bytes));
  communicator.barrier();
  if (communicator.is_root()) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(std::filesystem::file_size(path) / 2);
    const int byte = file.seekg(at).get();
    file.seekp(at).put(static_cast<char>(byte ^ 4));
  }
  communicator.barrier();
  require(is_refused([&] { io::read_checkpoint({communicator, path}); }), "a damaged checkpoint is read");
  communicator.barrier();
  if (communicator.is_root()) std::filesystem::remove(path);
  return result;
}

/// Breaks one cell, and wants hash, validity and quality to tell.
void require_found_out(mesh::NumberedMesh mesh, const std::string& hash) {
  for (mesh::Piece& piece : mesh.pieces) {
    if (piece.id != 0) continue;
    for (int k = 0; k < 3; ++k) std::swap(piece.prisms[k], piece.prisms[k + 3]);
  }
  require(mesh::hash_mesh(mesh) != hash, "the hash of a broken mesh is the same");
  require(!mesh::check_volume_mesh(mesh, nullptr).valid(), "a prism inside out counts as valid");
  const mesh::MixedQuality quality = mesh::measure_quality(mesh, mesh::link_faces(mesh));
  require(quality.worst_of(mesh::Measure::volume, 0) < 0, "a prism inside out counts as good");
  for (mesh::Piece& piece : mesh.pieces) {
    if (piece.id == 0) piece.coordinates[3 * static_cast<std::size_t>(piece.shared_vertices.at(0))] += 1e-6;
  }
  require(is_refused([&] { mesh::number_mesh(mesh); }), "shared vertices that differ are numbered");
}

/// A piece that a migration loses, or takes along twice, is missed.
void require_all_missed(const mesh::DistributedMesh& mesh) {
  mesh::DistributedMesh other = mesh;
  std::erase_if(other.pieces, [](const mesh::Piece& piece) { return piece.id == 1; });
  require(is_refused([&] { mesh::number_mesh(other); }), "a lost piece is not missed");
  other = mesh;
  for (mesh::Piece& piece : other.pieces) piece.id = std::max(piece.id, 1);
  require(is_refused([&] { mesh::number_mesh(other); }), "a piece twice is not found");
}

void run(const Communicator& communicator, int squares, const std::string& folder) {
  Steps steps(communicator);
  const io::Assembled file =
      steps.time("assemble", [&] { return io::assemble(local_columns(communicator, squares), 0); });
  const mesh::GlobalIndex cells = file.mesh.cell_count();
  mesh::NumberedMesh cut = steps.time("repartition", [&] {
    return mesh::repartition(*file.mesh.pieces, static_cast<mesh::PieceId>(cells / cells_per_piece + 2));
  });
  cut = steps.time("numbering", [&] { return mesh::number_mesh(std::move(cut)); });
  const std::string hash = steps.time("hash", [&] { return mesh::hash_mesh(cut); });
  const mesh::ValidityReport validity =
      steps.time("validity", [&] { return mesh::check_volume_mesh(cut, nullptr); });
  require(validity.valid(), validity.valid() ? "" : validity.violations.front().c_str());
  const mesh::MixedQuality quality =
      steps.time("quality", [&] { return mesh::measure_quality(cut, mesh::link_faces(cut)); });
  require_found_out(cut, hash);
  const auto same = [&](const mesh::DistributedMesh& other) {
    return mesh::hash_mesh(mesh::number_mesh(other)) == hash;
  };
  std::vector<parallel::Rank> owner;
  for (mesh::PieceId id = 0; id < cut.piece_count; ++id) owner.push_back((5 * id + 1) % communicator.size());
  steps.time("migration", [&] { return mesh::migrate(cut, owner), 0; });
  require(same(cut), "migration has changed the mesh");
  require_all_missed(cut);
  const mesh::DistributedMesh back =
      steps.time("checkpoint", [&] { return through_checkpoint(cut, folder); });
  require(same(back), "the checkpoint has changed the mesh");
  std::int64_t bytes = 0;
  for (const mesh::Piece& piece : back.pieces) bytes += mesh::bytes_at_rest(piece);
  bytes = communicator.sum(bytes);
  if (!communicator.is_root()) return;
  std::printf(
      "RESULT ranks=%d cells=%lld pieces=%d%s bytes_per_cell=%.1f volume=%.15g min_scaled_jacobian=%.6g "
      "hash=%s\n",
      communicator.size(), static_cast<long long>(cells), cut.piece_count, steps.text().c_str(),
      static_cast<double>(bytes) / static_cast<double>(cells), quality.volume,
      quality.worst_of(mesh::Measure::scaled_jacobian, 0), hash.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator communicator = Communicator::world();
  try {
    run(communicator, argc > 1 ? std::atoi(argv[1]) : 353, argc > 2 ? argv[2] : ".");
  } catch (const std::exception& error) {
    if (communicator.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
