/// Ghosts: blocks of other ranks, as far as they matter to those of this one.
#pragma once

#include "geometry/runs.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/lattice.hpp"

#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// A rank asks another for what touches a box, or is near it.
struct Question {
  GridBox box;
  double least = 0, most = 0;  ///< see BlockSearchRadii
  std::int32_t level = 0;      ///< of the block for which it is asked
  parallel::Rank to = 0, from = 0;

  static constexpr auto fields() {
    return std::tuple(&Question::box, &Question::least, &Question::most, &Question::level, &Question::to,
                      &Question::from);
  }
};
/// Asks all other ranks that have blocks where `where` is.
void ask(const LatticeTree& tree, const GridBox& where, Question question, std::vector<Question>& questions);
/// The questions to this rank, rank by rank. Collective.
std::vector<Question> take_questions(const parallel::Communicator& communicator,
                                     std::vector<Question> questions);
/// Calls visit(questions) for those of each rank in turn.
template <class Visit>
void for_each_asker(std::span<const Question> questions, const Visit& visit) {
  geometry::for_each_run(
      questions, [](const Question& a, const Question& b) { return a.from == b.from; },
      [&](std::size_t first, std::size_t last) { visit(questions.subspan(first, last - first)); });
}

/// A block that another rank owns.
struct GhostBlock {
  PackedBlock block;
  float longest_edge;  ///< see SurfaceTable

  static constexpr auto fields() { return std::tuple(&GhostBlock::block, &GhostBlock::longest_edge); }
};

/// All blocks that touch this rank's, or hold corners of its triangles. Collective.
std::vector<GhostBlock> fetch_ghosts(const Lattice& lattice);
/// Where there are far finer blocks on the surface (see looks_of_block), one of them. Collective.
std::vector<GhostBlock> fetch_finer_ghosts(const Lattice& lattice);

}  // namespace aeroloom::volume
