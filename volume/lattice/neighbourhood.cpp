#include "volume/lattice/neighbourhood.hpp"

#include "volume/lattice/block_points.hpp"
#include "volume/lattice/fetch_blocks.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::volume {

using parallel::Communicator;
using parallel::ScopedCpu;

void ask(const LatticeTree& tree, const GridBox& where, Question question, std::vector<Question>& questions) {
  if (tree.is_within_own(where)) return;
  std::vector<parallel::Rank> ranks;
  tree.for_each_rank_in(where, [&](parallel::Rank rank) { ranks.push_back(rank); });
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());
  for (const parallel::Rank rank : ranks) {
    question.to = rank;
    if (rank != question.from) questions.push_back(question);
  }
}

std::vector<Question> take_questions(const Communicator& communicator, std::vector<Question> questions) {
  return mesh::deliver(communicator, std::move(questions), [](const Question& q) { return q.to; });
}

std::vector<GhostBlock> fetch_ghosts(const Lattice& lattice) {
  const Communicator& communicator = lattice.tree.communicator();
  const LatticeTree& tree = lattice.tree;
  if (communicator.size() == 1) return {};
  const ScopedCpu task(ScopedCpu::As::task);
  std::vector<Question> questions;
  const auto ask_for = [&](const GridBox& box) {
    ask(tree, box, {box, 0, 0, 0, 0, communicator.rank()}, questions);
  };
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) ask_for(GridBox::of(tree.cube(b)).dilated(0.5));
  for (const SurfaceTriangle& triangle : lattice.triangles) {
    for (const geometry::Vec3& p : triangle.points) {
      const sizing::GridPoint place = lattice.frame.cell_at(lattice.frame.to_grid(p));
      if (tree.is_own(tree.any_at(place))) continue;
      const GridBox cell = GridBox::of({place, sizing::finest_level});
      ask_for({0.5 * (cell.low + cell.high), 0.5 * (cell.low + cell.high)});
    }
  }
  return fetch_blocks(lattice, std::move(questions), [&](std::span<const Question> asked, const auto& add) {
    const BoxesByLevel boxes(asked);
    tree.any_block_in(
        GridBox::of(GridCube{}),
        [&](BlockIndex b) {
          if (boxes.any_from(0, GridBox::of(tree.cube(b)))) add(b);
          return false;
        },
        [&](BlockIndex first, BlockIndex last, const GridCube& cube) {
          return last <= tree.first() || first >= tree.last() || !boxes.any_from(0, GridBox::of(cube));
        });
  });
}

std::vector<GhostBlock> fetch_finer_ghosts(const Lattice& lattice) {
  const Communicator& communicator = lattice.tree.communicator();
  const LatticeTree& tree = lattice.tree;
  const SurfaceTable& table = lattice.table;
  if (communicator.size() == 1) return {};
  const ScopedCpu task(ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    for (const double radius : looks_of_block(lattice, b)) {
      const GridBox box = GridBox::of(tree.cube(b)).dilated(radius);
      ask(tree, box, {box, 0, 0, tree.level(b), 0, communicator.rank()}, questions);
    }
  }
  return fetch_blocks(lattice, std::move(questions), [&](std::span<const Question> asked, const auto& add) {
    for (const Question& question : asked) {
      tree.any_block_in(
          question.box,
          [&](BlockIndex b) {
            if (!table.is_met(b) || tree.level(b) < far_finer_level(question.level)) return false;
            add(b);
            return true;
          },
          [&](BlockIndex first, BlockIndex last, const GridCube&) {
            return last <= tree.first() || first >= tree.last() ||
                   !table.any_met(first, last, far_finer_level(question.level));
          });
    }
  });
}

}  // namespace aeroloom::volume
