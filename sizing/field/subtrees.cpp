#include "sizing/field/subtrees.hpp"

#include "geometry/sort_by_key.hpp"

#include <numeric>

namespace aeroloom::sizing {
namespace {

struct Cube {
  std::uint64_t key;
  std::uint8_t level;

  std::uint64_t size() const { return 1ULL << 3 * (finest_level - level); }
};

/// For each cube how many cells lie in it, and how many of them are smaller.
std::vector<std::int64_t> count_in(const std::vector<Cube>& cubes, CellSpans cells) {
  std::vector<std::int64_t> counts;
  for (const Cube& cube : cubes) {
    const auto first = std::lower_bound(cells.keys.begin(), cells.keys.end(), cube.key);
    const auto last = std::lower_bound(first, cells.keys.end(), cube.key + cube.size());
    const auto levels = cells.levels.subspan(first - cells.keys.begin(), last - first);
    counts.push_back(last - first);
    counts.push_back(std::count_if(levels.begin(), levels.end(), [&](int l) { return l > cube.level; }));
  }
  return counts;
}

}  // namespace

Subtrees::Subtrees(const parallel::Communicator& communicator, CellSpans own, std::int64_t most)
    : _communicator(communicator), _rank(communicator.rank()) {
  struct Subtree {
    Cube cube;
    std::int64_t cells;
  };
  std::vector<Subtree> subtrees;
  for (std::vector<Cube> cubes{{0, 0}}; !cubes.empty();) {
    std::vector<std::int64_t> counts = count_in(cubes, own);
    communicator.sum_each(counts);
    std::vector<Cube> smaller;
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      const auto [key, level] = cubes[i];
      if (counts[2 * i] <= most || counts[2 * i + 1] == 0) {
        subtrees.push_back({cubes[i], counts[2 * i]});
        continue;
      }
      for (std::uint64_t child = 0; child < 8; ++child)
        smaller.push_back({key + child * (cubes[i].size() >> 3), static_cast<std::uint8_t>(level + 1)});
    }
    cubes = std::move(smaller);
  }
  geometry::sort_by_key(subtrees, [](const Subtree& subtree) { return subtree.cube.key; });
  _keys.clear(), _levels.clear();
  std::vector<std::int64_t> weights;
  for (const Subtree& subtree : subtrees) {
    _keys.push_back(subtree.cube.key), _levels.push_back(subtree.cube.level);
    weights.push_back(subtree.cells + 1);  // what is empty is work, too
  }
  assign_to_ranks(weights, communicator.size());
}

void Subtrees::assign_to_ranks(std::span<const std::int64_t> weights, int ranks) {
  const std::int64_t total = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  _firsts.clear();
  std::int64_t before = 0;
  for (std::size_t subtree = 0; subtree < weights.size(); ++subtree) {
    // By its middle: a rank's part begins with the first subtree that lies in it.
    const double middle = static_cast<double>(before) + 0.5 * static_cast<double>(weights[subtree]);
    while (static_cast<double>(_firsts.size()) * static_cast<double>(total) <= middle * ranks)
      _firsts.push_back(subtree);
    before += weights[subtree];
  }
  _firsts.resize(static_cast<std::size_t>(ranks), weights.size());
}

}  // namespace aeroloom::sizing
