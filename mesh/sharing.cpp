#include "mesh/sharing.hpp"

#include "geometry/runs.hpp"
#include "mesh/delivery.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {

std::int64_t forget_unshared(const parallel::Communicator& communicator, DistributedMesh& mesh) {
  struct Share {
    SharedToken token;
    PieceId piece;
    parallel::Rank rank;
  };
  std::vector<Share> mine;
  for (const Piece& piece : mesh.pieces) {
    for (const SharedToken token : piece.shared_tokens)
      mine.push_back({token, piece.id, communicator.rank()});
  }
  std::vector<Share> met = deliver(communicator, std::move(mine), [&](const Share& s) {
    return meeting_rank(mix_in(0, s.token), communicator.size());
  });
  std::sort(met.begin(), met.end(), [](const Share& a, const Share& b) {
    return std::tie(a.token, a.piece) < std::tie(b.token, b.piece);
  });
  std::vector<Share> alone;
  const auto same = [](const Share& a, const Share& b) { return a.token == b.token; };
  geometry::for_each_run(std::span<const Share>(met), same, [&](std::size_t first, std::size_t last) {
    if (last == first + 1) alone.push_back(met[first]);
  });
  std::vector<Share> arrived = deliver(communicator, std::move(alone), [](const Share& s) { return s.rank; });
  const auto less = [](const Share& a, const Share& b) {
    return std::tie(a.piece, a.token) < std::tie(b.piece, b.token);
  };
  std::sort(arrived.begin(), arrived.end(), less);
  for (Piece& piece : mesh.pieces) {
    std::size_t kept = 0;
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s) {
      const Share wanted{piece.shared_tokens[s], piece.id, 0};
      if (std::binary_search(arrived.begin(), arrived.end(), wanted, less)) continue;
      piece.shared_vertices[kept] = piece.shared_vertices[s];
      piece.shared_tokens[kept++] = piece.shared_tokens[s];
    }
    piece.shared_vertices.resize(kept);
    piece.shared_tokens.resize(kept);
  }
  return communicator.sum(static_cast<std::int64_t>(arrived.size()));
}

}  // namespace aeroloom::mesh
