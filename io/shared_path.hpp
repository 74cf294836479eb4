/// A file that several ranks read or write together.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io {

/// Consecutive items of a list, those from `begin` to before `end`.
struct LocalRange {
  std::int64_t begin = 0, end = 0;

  /// The range of rank `rank` where `count` items are divided evenly over `size` ranks.
  static LocalRange of(std::int64_t count, int rank, int size) {
    const std::int64_t each = count / size, rest = count % size;
    const auto first = [&](std::int64_t r) { return r * each + (r < rest ? r : rest); };
    return {first(rank), first(rank + std::int64_t{1})};
  }
  std::int64_t count() const { return end - begin; }
};

/// The path of a file, and the ranks that read or write it. All ranks hold the same path.
struct SharedPath {
  parallel::Communicator communicator;
  std::string path;

  /// The range of `count` items that this rank reads.
  LocalRange local_range(std::int64_t count) const {
    return LocalRange::of(count, communicator.rank(), communicator.size());
  }
};

}  // namespace aeroloom::io
