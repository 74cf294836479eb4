#include "mesh/quality/bin_sums.hpp"

#include "mesh/exchange/delivery.hpp"

#include <span>
#include <utility>

namespace aeroloom::mesh {

std::vector<std::int64_t> sum_bins(const parallel::Communicator& communicator,
                                   const std::vector<std::int64_t>& bins) {
  struct BinCount {
    std::int64_t bin, count;
  };
  const auto per_rank = static_cast<std::int64_t>(bins.size() / communicator.size() + 1);
  std::vector<BinCount> filled;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (bins[b] != 0) filled.push_back({static_cast<std::int64_t>(b), bins[b]});
  }
  const auto arrived = deliver(communicator, std::move(filled), [per_rank](const BinCount& entry) {
    return static_cast<parallel::Rank>(entry.bin / per_rank);
  });
  std::vector<std::int64_t> stretch(per_rank, 0);
  const std::int64_t first = per_rank * communicator.rank();
  for (const BinCount& entry : arrived) stretch[entry.bin - first] += entry.count;
  auto all = communicator.all_gather_items(std::span<const std::int64_t>(stretch));
  all.resize(bins.size());
  return all;
}

}  // namespace aeroloom::mesh
