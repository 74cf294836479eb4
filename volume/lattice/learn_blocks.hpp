/// How a rank learns of blocks of other ranks: questions, answers, and the growth of tree and table.
#pragma once

#include "mesh/exchange/delivery.hpp"
#include "volume/lattice/near_boxes.hpp"
#include "volume/lattice/neighbourhood.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// Answers what other ranks ask, and learns what they answer. add_answers(questions of a rank, add) calls
/// add(b) for blocks of this rank. Collective.
template <class AddAnswers>
void learn(const parallel::Communicator& communicator, LatticeTree& tree, SurfaceTable& table,
           std::vector<Question> questions, const AddAnswers& add_answers) {
  struct TouchedBlock {
    KnownBlock block;
    float longest_edge;
    parallel::Rank to;
    static constexpr auto fields() {
      return std::tuple(&TouchedBlock::block, &TouchedBlock::longest_edge, &TouchedBlock::to);
    }
  };
  std::vector<TouchedBlock> rows;
  const std::vector<Question> asked = take_questions(communicator, std::move(questions));
  for_each_asker(asked, [&](std::span<const Question> of_rank) {
    add_answers(of_rank, [&](BlockIndex b) {
      rows.push_back({tree.known(b), table.longest_edge[b], of_rank.front().from});
    });
  });
  rows = mesh::deliver(communicator, std::move(rows), [](const TouchedBlock& row) { return row.to; });
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (tree.is_known(b)) rows.push_back({tree.known(b), table.longest_edge[b], 0});
  }
  const BlockIndex first = tree.first(), last = tree.last();
  std::vector<KnownBlock> blocks;
  blocks.reserve(rows.size());
  for (const TouchedBlock& row : rows) blocks.push_back(row.block);
  tree.learn(std::move(blocks));
  table.longest_edge.assign(tree.block_count(), 0);
  for (const TouchedBlock& row : rows) table.longest_edge[tree.index(row.block.number)] = row.longest_edge;
  table.note_levels_met(tree);
  const auto move = [&](auto& values) {
    auto moved = std::decay_t<decltype(values)>(tree.block_count());
    std::copy(values.begin() + first, values.begin() + last, moved.begin() + tree.first());
    values = std::move(moved);
  };
  move(table.triangles);
  move(table.nearest);
}

/// Boxes of blocks, by their level.
class BoxesByLevel {
public:
  explicit BoxesByLevel(std::span<const Question> questions) {
    for (const Question& question : questions) _of_level[question.level].add(question.box);
    for (NearBoxes& boxes : _of_level) boxes.build();
  }
  /// Whether one of at least this level touches a box.
  bool any_from(int level, const GridBox& box) const {
    for (std::size_t l = std::max(level, 0); l < _of_level.size(); ++l) {
      if (_of_level[l].any_within(box, 0)) return true;
    }
    return false;
  }

private:
  std::array<NearBoxes, sizing::finest_level + 1> _of_level;
};

}  // namespace aeroloom::volume
