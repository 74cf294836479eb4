#include "improve/balance.hpp"

#include "parallel/schedule.hpp"

#include <tuple>

namespace aeroloom::improve {

void balance_pieces(const parallel::Communicator& communicator, mesh::DistributedMesh& mesh,
                    const std::vector<double>& work) {
  struct Row {
    mesh::PieceId piece;
    parallel::Rank owner;
    double work;

    static constexpr auto fields() { return std::tuple(&Row::piece, &Row::owner, &Row::work); }
  };
  std::vector<Row> mine;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i)
    mine.push_back({mesh.pieces[i].id, communicator.rank(), work[i]});
  std::vector<double> all(mesh.piece_count, 0);
  std::vector<parallel::Rank> now(mesh.piece_count, 0);
  for (const Row& row : communicator.all_gather_items<Row>(mine)) {
    all[row.piece] = row.work;
    now[row.piece] = row.owner;
  }
  const std::vector<parallel::Rank> owner = parallel::rebalance(all, now, communicator.size());
  if (owner != now) migrate(communicator, mesh, owner);
}

}  // namespace aeroloom::improve
