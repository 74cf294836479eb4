/// How a rank gets ghosts: questions to other ranks, and their answers.
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

/// Answers what other ranks ask, and returns what they answer. add_answers(questions of a rank, add) calls
/// add(b) for blocks of this rank. Collective.
template <class AddAnswers>
std::vector<GhostBlock> fetch_blocks(const Lattice& lattice, std::vector<Question> questions,
                                     const AddAnswers& add_answers) {
  const parallel::Communicator& communicator = lattice.tree.communicator();
  struct Parcel {
    GhostBlock block;
    parallel::Rank to;
    static constexpr auto fields() { return std::tuple(&Parcel::block, &Parcel::to); }
  };
  std::vector<Parcel> parcels;
  const std::vector<Question> asked = take_questions(communicator, std::move(questions));
  for_each_asker(asked, [&](std::span<const Question> of_rank) {
    add_answers(of_rank, [&](BlockIndex b) {
      parcels.push_back({{lattice.tree.packed(b), lattice.table.longest_edge[b]}, of_rank.front().from});
    });
  });
  std::vector<GhostBlock> fetched;
  for (const Parcel& parcel :
       mesh::deliver(communicator, std::move(parcels), [](const Parcel& p) { return p.to; }))
    fetched.push_back(parcel.block);
  return fetched;
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
