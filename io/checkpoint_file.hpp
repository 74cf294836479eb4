/// The result of a stage in a file, from which a later run goes on. All ranks write it together, and any
/// number of ranks read it. A file with one wrong bit is refused.
///
/// Layout: magic number, version, length of the header, digest of these and of the header. Then the header:
/// key, texts, and number, length and digest of the common bytes and of each item. Then the bytes, without
/// gaps.
#pragma once

#include "io/shared_path.hpp"
#include "parallel/storage/digest.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Tells a run whether a checkpoint is its own.
struct CheckpointLabel {
  parallel::Digest key;            ///< of everything that the content depends on
  std::vector<std::string> about;  ///< the same in words, to explain a different key
};

/// The content of a checkpoint before it is written.
struct CheckpointDraft {
  /// One of the items that are distributed over ranks. `bytes` is called twice, so that no rank holds the
  /// bytes of all its items at once.
  struct Item {
    std::int64_t number = 0;  ///< not negative, unique in the whole file
    std::function<parallel::Bytes()> bytes;
  };
  parallel::Bytes common;  ///< those of rank 0 are written
  std::vector<Item> items;
};

/// The content of a checkpoint that was read.
struct CheckpointContent {
  struct Item {
    std::int64_t number = 0;
    parallel::Bytes bytes;
  };
  parallel::Bytes common;   ///< on every rank
  std::vector<Item> items;  ///< of this rank, by ascending number; distributed by their length
};

/// Writes the file whole or not at all (parallel/storage/shared_file.hpp). Collective; throws
/// CollectiveError.
void write_checkpoint(const SharedPath& file, const CheckpointLabel& label, const CheckpointDraft& draft);

/// Reads the label alone. Empty where there is no file, or where the number of texts is not `texts`.
/// Collective; throws CollectiveError where the file is damaged.
std::optional<CheckpointLabel> read_checkpoint_label(const SharedPath& file, std::size_t texts);

/// Collective; throws CollectiveError where the file is damaged or cannot be read.
CheckpointContent read_checkpoint(const SharedPath& file);

}  // namespace aeroloom::io
