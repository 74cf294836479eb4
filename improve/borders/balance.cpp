#include "improve/borders/balance.hpp"

#include "mesh/exchange/delivery.hpp"
#include "parallel/communication/schedule.hpp"

namespace aeroloom::improve {

void balance_pieces(mesh::DistributedMesh& mesh, const std::vector<double>& work) {
  const std::vector<parallel::Rank> here(mesh.pieces.size(), mesh.communicator.rank());
  const std::vector<parallel::Rank> now = mesh::gather_by_piece(mesh, here);
  const std::vector<parallel::Rank> owner =
      parallel::rebalance(mesh::gather_by_piece(mesh, work), now, mesh.communicator.size());
  if (owner != now) migrate(mesh, owner);
}

}  // namespace aeroloom::improve
