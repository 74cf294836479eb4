// How a point finds its leaf.
#include "sizing/field/octree.hpp"

#include <algorithm>

namespace aeroloom::sizing {
namespace {

/// Two levels at once: half as many steps as with one, for a table of 256 bytes at each node.
constexpr std::size_t branches = 64;

/// The level of the branches that a cell consists of, or is.
int branch_level(int level) {
  return std::max(2, level + level % 2);
}

/// How many branches that is.
std::size_t branches_of(int level) {
  return std::size_t{1} << 3 * (branch_level(level) - level);
}

/// Nodes as a table has them, those below a first one.
class Nodes {
public:
  /// Where the entries of a cell stand. The branches of the first node are of level `level`, and begin with
  /// the finest cell `low`.
  std::size_t place(std::uint64_t low, int level, std::uint64_t key, int cell_level) {
    std::size_t at = (key - low) >> 3 * (finest_level - level);
    for (; level < cell_level; level += 2) {
      std::int32_t& entry = _entries[at];
      std::size_t node = static_cast<std::size_t>(-entry);
      if (entry >= 0) {
        node = count();
        entry = -static_cast<std::int32_t>(node);
        _entries.resize(_entries.size() + branches, 0);
      }
      at = node * branches + (key >> 3 * (finest_level - level - 2) & (branches - 1));
    }
    return at;
  }
  void put(std::uint64_t low, int level, std::uint64_t key, int cell_level, std::size_t entry) {
    const std::size_t at = place(low, level, key, cell_level);
    std::fill_n(_entries.begin() + static_cast<std::ptrdiff_t>(at), branches_of(cell_level),
                static_cast<std::int32_t>(entry));
  }
  std::size_t count() const { return _entries.size() / branches; }
  std::vector<std::int32_t>& entries() { return _entries; }

private:
  std::vector<std::int32_t> _entries = std::vector<std::int32_t>(branches, 0);
};

/// A rank's part of a table, with branches of subtrees in place of the first node.
struct PartOfTable {
  std::vector<std::int32_t> branches;  ///< of its subtrees, in their order
  std::vector<std::int32_t> entries;   ///< of the nodes below

  /// From numbers among this rank's leaves and nodes to those among all.
  void renumber(std::size_t first_leaf, std::size_t first_node) {
    for (std::vector<std::int32_t>* all : {&branches, &entries}) {
      for (std::int32_t& entry : *all)
        entry += entry >= 0 ? static_cast<std::int32_t>(first_leaf) : -static_cast<std::int32_t>(first_node);
    }
  }
};

PartOfTable tabulate(const Subtrees& subtrees, IndexRange own, CellSpans leaves) {
  Nodes nodes;
  PartOfTable part;
  std::size_t leaf = 0;
  for (std::size_t subtree = own.first; subtree < own.last; ++subtree) {
    const std::uint64_t low = subtrees.key(subtree);
    const std::uint64_t end = low + (1ULL << 3 * (finest_level - subtrees.level(subtree)));
    const int level = branch_level(subtrees.level(subtree));
    std::fill_n(nodes.entries().begin(), branches, 0);
    for (; leaf < leaves.size() && leaves.keys[leaf] < end; ++leaf)
      nodes.put(low, level, leaves.keys[leaf], leaves.levels[leaf], leaf);
    part.branches.insert(
        part.branches.end(), nodes.entries().begin(),
        nodes.entries().begin() + static_cast<std::ptrdiff_t>(branches_of(subtrees.level(subtree))));
  }
  part.entries.assign(nodes.entries().begin() + branches, nodes.entries().end());
  return part;
}

/// The nodes above subtrees; entries where subtrees are remain open.
Nodes above_subtrees(const Subtrees& subtrees) {
  Nodes nodes;
  for (std::size_t subtree = 0; subtree < subtrees.count(); ++subtree)
    nodes.place(0, 2, subtrees.key(subtree), subtrees.level(subtree));
  return nodes;
}

/// Puts the branches of all subtrees, one subtree after another, into the nodes above.
void fill_in_subtrees(const Subtrees& subtrees, const std::vector<std::int32_t>& of_subtrees, Nodes& above) {
  auto next = of_subtrees.begin();
  for (std::size_t subtree = 0; subtree < subtrees.count(); ++subtree) {
    const std::size_t at = above.place(0, 2, subtrees.key(subtree), subtrees.level(subtree));
    const auto end = next + static_cast<std::ptrdiff_t>(branches_of(subtrees.level(subtree)));
    std::copy(next, end, above.entries().begin() + static_cast<std::ptrdiff_t>(at));
    next = end;
  }
}

}  // namespace

LeafTable::LeafTable(CellSpans leaves) {
  Nodes nodes;
  for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf)
    nodes.put(0, 2, leaves.keys[leaf], leaves.levels[leaf], leaf);
  _entries = parallel::NodeArray<std::int32_t>(std::move(nodes.entries()));
}

// A rank's nodes come after those above all subtrees and those of lower ranks; within its part they count
// from 1.
LeafTable::LeafTable(const Subtrees& subtrees, CellSpans own, CellSpans all) {
  const parallel::Communicator& communicator = subtrees.communicator();
  const auto first_leaf = [&](parallel::Rank rank) {
    return static_cast<std::size_t>(
        std::lower_bound(all.keys.begin(), all.keys.end(), subtrees.first_key(rank)) - all.keys.begin());
  };
  PartOfTable part = tabulate(subtrees, subtrees.of_rank(communicator.rank()), own);
  Nodes above = above_subtrees(subtrees);
  // The branches of subtrees count leaves and nodes of all.
  const auto nodes = static_cast<std::int64_t>(part.entries.size() / branches);
  const auto nodes_before = above.count() + static_cast<std::size_t>(communicator.exclusive_scan(nodes));
  part.renumber(first_leaf(communicator.rank()), nodes_before - 1);
  fill_in_subtrees(subtrees, communicator.all_gather_items<std::int32_t>(part.branches), above);
  const std::vector<std::int32_t>& top = above.entries();
  if (communicator.is_root()) part.entries.insert(part.entries.begin(), top.begin(), top.end());
  const auto write = [&](parallel::Rank rank, std::size_t first, std::span<std::int32_t> to) {
    const IndexRange leaves{first_leaf(rank),
                            rank + 1 < communicator.size() ? first_leaf(rank + 1) : all.size()};
    PartOfTable other = tabulate(subtrees, subtrees.of_rank(rank), all.part(leaves));
    if (rank == 0) to = {std::copy(top.begin(), top.end(), to.begin()), to.end()};
    other.renumber(leaves.first, (rank == 0 ? above.count() : first / branches) - 1);
    std::copy(other.entries.begin(), other.entries.end(), to.begin());
  };
  _entries = parallel::NodeArray<std::int32_t>::composed(communicator, std::move(part.entries), write);
}

void Octree::share() {
  table._entries = table._entries.shared(communicator);
  keys = keys.shared(communicator);
  levels = levels.shared(communicator);
}

}  // namespace aeroloom::sizing
