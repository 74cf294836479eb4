#include "io/checkpoint_file.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/io/scratch_folder.hpp"
#include "tests/meshes/mixed_mesh.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace aeroloom::io {
namespace {

class MeshCheckpoint : public examples::ScratchFolder {
protected:
  void write(const mesh::DistributedMesh& mesh) {
    CheckpointDraft draft;
    for (const mesh::Piece& piece : mesh.pieces)
      draft.items.push_back({piece.id, [&piece] { return parallel::to_wire(piece); }});
    write_checkpoint({world, path("c")}, {}, draft);
  }

  mesh::DistributedMesh read(mesh::DistributedMesh names) {
    names.pieces.clear();
    for (const CheckpointContent::Item& item : read_checkpoint({world, path("c")}).items)
      names.pieces.push_back(parallel::from_wire<mesh::Piece>(item.bytes));
    return names;
  }

  std::string hash_of(const mesh::DistributedMesh& mesh) { return mesh::hash_mesh(mesh::number_mesh(mesh)); }
};

TEST_F(MeshCheckpoint, MixedPiecesComeBack) {
  const mesh::DistributedMesh mesh = mesh::examples::mixed_mesh(world, 4, 7);
  write(mesh);
  EXPECT_EQ(hash_of(read(mesh)), hash_of(mesh));
}

TEST_F(MeshCheckpoint, AChangedBitIsRefused) {
  const mesh::DistributedMesh mesh = mesh::examples::mixed_mesh(world, 2, 3);
  write(mesh);
  if (world.is_root()) {
    const auto at = static_cast<std::streamoff>(std::filesystem::file_size(path("c")) / 2);
    std::fstream file(path("c"), std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const int byte = file.get();
    file.seekp(at);
    file.put(static_cast<char>(byte ^ 4));
  }
  world.barrier();
  EXPECT_THROW(read(mesh), parallel::CollectiveError);
}

}  // namespace
}  // namespace aeroloom::io
