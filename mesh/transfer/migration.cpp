#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace aeroloom::mesh {

namespace {

void require_valid_owners(const DistributedMesh& mesh, const std::vector<parallel::Rank>& owner) {
  const parallel::Communicator& communicator = mesh.communicator;
  if (owner.size() != static_cast<std::size_t>(mesh.piece_count)) {
    throw std::logic_error("migrate: not one owner per piece");
  }
  const auto exists = [&](parallel::Rank rank) { return rank >= 0 && rank < communicator.size(); };
  if (!std::all_of(owner.begin(), owner.end(), exists)) throw std::logic_error("migrate: no such rank");
}

}  // namespace

void migrate(DistributedMesh& mesh, const std::vector<parallel::Rank>& owner) {
  const parallel::Communicator communicator = mesh.communicator;
  parallel::agree(communicator, [&] { require_valid_owners(mesh, owner); });
  std::vector<Piece> staying;
  std::map<parallel::Rank, parallel::Packer> leaving;
  for (Piece& piece : mesh.pieces) {
    if (owner[piece.id] == communicator.rank()) {
      staying.push_back(std::move(piece));
    } else {
      parallel::pack(leaving[owner[piece.id]], piece);
      piece = {};  // a piece is never held twice for longer than it is packed
    }
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(leaving.size());
  for (auto& [rank, packer] : leaving) parcels.push_back({rank, packer.take()});
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) staying.push_back(parallel::unpack<Piece>(unpacker));
    parallel::Bytes().swap(parcel.content);
  }
  std::sort(staying.begin(), staying.end(), [](const Piece& a, const Piece& b) { return a.id < b.id; });
  mesh.pieces = std::move(staying);
}

}  // namespace aeroloom::mesh
