#include "improve/borders/balance.hpp"

#include "parallel/communication/schedule.hpp"

#include <tuple>

namespace aeroloom::improve {

void balance_pieces(mesh::DistributedMesh& mesh, const std::vector<double>& work) {
  const parallel::Communicator communicator = mesh.communicator;
  struct PieceWork {
    mesh::PieceId piece;
    parallel::Rank owner;
    double work;

    static constexpr auto fields() {
      return std::tuple(&PieceWork::piece, &PieceWork::owner, &PieceWork::work);
    }
  };
  std::vector<PieceWork> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    mine.push_back({mesh.pieces[i].id, communicator.rank(), work[i]});
  std::vector<double> all(mesh.piece_count, 0);
  std::vector<parallel::Rank> now(mesh.piece_count, 0);
  for (const PieceWork& row : communicator.all_gather_items<PieceWork>(mine)) {
    all[row.piece] = row.work;
    now[row.piece] = row.owner;
  }
  const std::vector<parallel::Rank> owner = parallel::rebalance(all, now, communicator.size());
  if (owner != now) migrate(mesh, owner);
}

}  // namespace aeroloom::improve
