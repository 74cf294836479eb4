#include "improve/balance.hpp"

#include "parallel/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace aeroloom::improve {
namespace {

constexpr double tolerance = 1.05;  // of the mean

double heaviest(const std::vector<double>& work, const std::vector<parallel::Rank>& owner, int ranks) {
  std::vector<double> load(ranks, 0);
  for (std::size_t i = 0; i < work.size(); ++i) load[owner[i]] += work[i];
  return *std::max_element(load.begin(), load.end());
}

/// Few pieces move where that makes the work even enough, else as few as go with the most even assignment.
std::vector<parallel::Rank> new_owners(const std::vector<double>& work,
                                       const std::vector<parallel::Rank>& now, int ranks) {
  const double mean = std::accumulate(work.begin(), work.end(), 0.0) / ranks;
  const std::vector<parallel::Rank> nearby = parallel::move_excess(work, now, ranks);
  const std::vector<parallel::Rank> even = parallel::assign_largest_first(work, ranks);
  if (heaviest(work, nearby, ranks) <= std::max(tolerance * mean, heaviest(work, even, ranks))) return nearby;
  return parallel::keep_in_place(work, even, now, ranks);
}

}  // namespace

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
  const double mean = std::accumulate(all.begin(), all.end(), 0.0) / communicator.size();
  const double before = heaviest(all, now, communicator.size());
  if (before <= tolerance * mean) return;
  const std::vector<parallel::Rank> owner = new_owners(all, now, communicator.size());
  if (heaviest(all, owner, communicator.size()) < before) migrate(communicator, mesh, owner);
}

}  // namespace aeroloom::improve
