#include "mesh/exchange/distributed_table.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::mesh {

parallel::Rank KeyRanges::rank_of(GlobalIndex key) const {
  const auto found = std::upper_bound(first.begin(), first.end() - 1, key);
  return static_cast<parallel::Rank>(std::max<std::ptrdiff_t>(1, found - first.begin()) - 1);
}

KeyRanges even_ranges(int ranks, GlobalIndex limit) {
  KeyRanges ranges;
  const GlobalIndex width = limit / ranks + 1;
  for (int r = 0; r <= ranks; ++r) ranges.first.push_back(width * r);
  return ranges;
}

KeyRanges fair_ranges(const parallel::Communicator& communicator, std::vector<GlobalIndex> keys,
                      GlobalIndex limit) {
  constexpr GlobalIndex dense = 4, samples_per_rank = 64;
  const GlobalIndex ranks = communicator.size();
  const GlobalIndex total = communicator.sum(static_cast<std::int64_t>(keys.size()));
  if (limit / dense <= total) return even_ranges(communicator.size(), limit);
  std::sort(keys.begin(), keys.end());
  // One of so many keys on any rank, so that samples of all count the same.
  const GlobalIndex step = total / (samples_per_rank * ranks) + 1;
  std::vector<GlobalIndex> samples;
  for (GlobalIndex i = step / 2; i < static_cast<GlobalIndex>(keys.size()); i += step)
    samples.push_back(keys[static_cast<std::size_t>(i)]);
  samples = communicator.gather_sorted(samples);
  if (samples.empty()) return even_ranges(communicator.size(), limit);
  KeyRanges ranges;
  ranges.first.push_back(0);
  for (GlobalIndex r = 1; r < ranks; ++r)
    ranges.first.push_back(
        samples[samples.size() * static_cast<std::size_t>(r) / static_cast<std::size_t>(ranks)]);
  ranges.first.push_back(limit);
  return ranges;
}

GlobalIndex lowest_of_all(const parallel::Communicator& communicator, GlobalIndex mine) {
  constexpr GlobalIndex none = std::numeric_limits<GlobalIndex>::max();
  const GlobalIndex lowest = communicator.minimum(static_cast<std::int64_t>(mine < 0 ? none : mine));
  return lowest == none ? -1 : lowest;
}

}  // namespace aeroloom::mesh
