#include "volume/neighbourhood.hpp"

#include "aeroloom/mesh/delivery.hpp"
#include "volume/halo.hpp"
#include "volume/near_boxes.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace aeroloom::volume {

using parallel::Communicator;
using parallel::ScopedCpu;

namespace {

/// Answers what other ranks ask, and learns what they answer. add_answers(questions of a rank, add) calls
/// add(b) for blocks of this rank. Collective.
template <class AddAnswers>
void learn(const Communicator& communicator, LatticeTree& tree, SurfaceTable& table,
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

}  // namespace

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

void learn_what_touches(const Communicator& communicator, const KnownLattice& lattice,
                        std::span<const SurfaceTriangle> triangles, parallel::StageClock& clock) {
  const LatticeFrame& frame = lattice.frame;
  LatticeTree& tree = lattice.tree;
  SurfaceTable& table = lattice.table;
  if (communicator.size() == 1) return;
  const ScopedCpu task(clock, ScopedCpu::As::task);
  std::vector<Question> questions;
  const auto ask_for = [&](const GridBox& box) {
    ask(tree, box, {box, 0, 0, 0, 0, communicator.rank()}, questions);
  };
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) ask_for(GridBox::of(tree.cube(b)).dilated(0.5));
  for (const SurfaceTriangle& triangle : triangles) {
    for (const geometry::Vec3& p : triangle.points) {
      const sizing::GridPoint place = frame.cell_at(frame.to_grid(p));
      if (tree.is_own(tree.any_at(place))) continue;
      const GridBox cell = GridBox::of({place, sizing::finest_level});
      ask_for({0.5 * (cell.low + cell.high), 0.5 * (cell.low + cell.high)});
    }
  }
  learn(communicator, tree, table, std::move(questions),
        [&](std::span<const Question> asked, const auto& add) {
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

void learn_what_is_far_finer(const Communicator& communicator, const KnownLattice& lattice,
                             const LatticeSource& source, parallel::StageClock& clock) {
  LatticeTree& tree = lattice.tree;
  SurfaceTable& table = lattice.table;
  if (communicator.size() == 1) return;
  const ScopedCpu task(clock, ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    for (const double radius : looks_of_block(source, b)) {
      const GridBox box = GridBox::of(tree.cube(b)).dilated(radius);
      ask(tree, box, {box, 0, 0, tree.level(b), 0, communicator.rank()}, questions);
    }
  }
  learn(communicator, tree, table, std::move(questions),
        [&](std::span<const Question> asked, const auto& add) {
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

void learn_what_is_cut(const Communicator& communicator, const KnownLattice& lattice, const ZoneCuts& cuts,
                       double width, parallel::StageClock& clock) {
  const LatticeFrame& frame = lattice.frame;
  LatticeTree& tree = lattice.tree;
  SurfaceTable& table = lattice.table;
  if (communicator.size() == 1) return;
  const ScopedCpu task(clock, ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const GridBox box =
        GridBox::of(tree.cube(b)).dilated(ZonesAround::search_radius(frame, tree, table, b, width));
    ask(tree, box, {box, 0, 0, tree.level(b), 0, communicator.rank()}, questions);
  }
  learn(communicator, tree, table, std::move(questions),
        [&](std::span<const Question> asked, const auto& add) {
          const BoxesByLevel boxes(asked);
          const auto is_wanted = [&](const GridCube& cube) {
            return cuts.zone_of_all(cube) == no_zone &&
                   boxes.any_from(cube.level - ZonesAround::finer_levels + 1, GridBox::of(cube));
          };
          tree.any_block_in(
              GridBox::of(GridCube{}),
              [&](BlockIndex b) {
                if (is_wanted(tree.cube(b))) add(b);
                return false;
              },
              [&](BlockIndex first, BlockIndex last, const GridCube& cube) {
                return last <= tree.first() || first >= tree.last() || !is_wanted(cube);
              });
        });
}

}  // namespace aeroloom::volume
