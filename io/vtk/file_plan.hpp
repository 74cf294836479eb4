/// Which parts of a mesh share a file, who writes each file, and when parts travel to the writer.
#pragma once

#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// A part and where it lives.
struct PartPlace {
  std::int32_t id = 0;
  parallel::Rank rank = 0;
  mesh::GlobalIndex items = 0;  ///< cells (or faces) that go into a file
  mesh::GlobalIndex work = 0;   ///< to write it, in corners of these items

  static constexpr auto fields() {
    return std::tuple(&PartPlace::id, &PartPlace::rank, &PartPlace::items, &PartPlace::work);
  }
};

/// A file: consecutive parts.
struct PlannedFile {
  /// Of a file whose parts all live with its writer: it waits for no round.
  static constexpr std::size_t no_round = std::numeric_limits<std::size_t>::max();

  parallel::Rank writer = 0;
  std::size_t round = no_round;  ///< in which its parts travel to the writer
};

struct FilePlan {
  std::vector<std::size_t> file_of;  ///< per part
  std::vector<PlannedFile> files;
  std::size_t rounds = 0;

  const PlannedFile& plan_of(std::int32_t part) const {
    return files[file_of[static_cast<std::size_t>(part)]];
  }
};

/// Parts share a file until it has `items_per_file`: a function of the mesh alone. A file is written by the
/// rank that holds most of it as long as this rank has no more work than the others, else by the rank with
/// least work: at the end two ranks differ by one file at most. In a round at most `items_per_file`, or an
/// eighth of a rank's mean share of the items where that is more, travel to a writer (but always one file's).
/// `places`: of all parts, ascending by id from 0.
FilePlan plan_files(std::span<const PartPlace> places, mesh::GlobalIndex items_per_file, int ranks);

}  // namespace aeroloom::io
