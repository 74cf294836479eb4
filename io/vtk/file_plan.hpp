/// Distributes the parts of a mesh over files, and chooses the rank that writes each file.
#pragma once

#include "mesh/data/piece.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace aeroloom::io {

/// A part, and the rank that holds it.
struct PartLocation {
  std::int32_t id = 0;
  parallel::Rank rank = 0;
  mesh::GlobalIndex items = 0;  ///< cells (or faces) for the file
  mesh::GlobalIndex work = 0;   ///< work to write them: their number of corners
};

/// A file, which holds consecutive parts.
struct PlannedFile {
  /// The round of a file whose writer holds all its parts.
  static constexpr std::size_t no_round = std::numeric_limits<std::size_t>::max();

  parallel::Rank writer = 0;
  std::size_t round = no_round;  ///< in which the writer gets the parts
};

struct FilePlan {
  std::vector<std::size_t> file_of;  ///< by part
  std::vector<PlannedFile> files;
  std::size_t rounds = 0;

  const PlannedFile& plan_of(std::int32_t part) const {
    return files[file_of[static_cast<std::size_t>(part)]];
  }
};

/// Consecutive parts go into one file until it has `items_per_file` items. This depends on the mesh alone.
/// The rank that holds most of a file writes it, as long as it has no more than the mean work. Otherwise the
/// rank with least work writes it, so at the end two ranks differ by at most one file. Parts are sent to
/// writers in rounds, which limits memory. In a round a writer gets one file, or more while they have at most
/// `items_per_file` items or an eighth of the mean of all ranks. `places`: all parts, by id from 0.
FilePlan plan_files(std::span<const PartLocation> places, mesh::GlobalIndex items_per_file, int ranks);

}  // namespace aeroloom::io
