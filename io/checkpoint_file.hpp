/// The result of a stage in a file, for a run that goes on from there: written by all ranks at once, read by
/// any number of them, refused as soon as one bit is not what it was.
///
/// Layout: magic, version, bytes of the header, digest of both and of the header; the header with key, texts,
/// and for the common bytes and each item its number, bytes and digest; then their bytes, without gaps.
#pragma once

#include "io/shared_path.hpp"
#include "parallel/storage/digest.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// The key of a checkpoint, by which a run tells whether it is its own.
struct CheckpointLabel {
  parallel::Digest key;            ///< of everything its content depends on
  std::vector<std::string> about;  ///< the same in words, to tell what is different where the key is

  static constexpr auto fields() { return std::tuple(&CheckpointLabel::key, &CheckpointLabel::about); }
};

/// Content to be written.
struct CheckpointDraft {
  /// One of the parts that are spread over ranks. Its bytes are asked for twice, so that no rank holds those
  /// of all its items.
  struct Item {
    std::int64_t number = 0;  ///< not negative, each once in the whole file
    std::function<parallel::Bytes()> bytes;
  };
  parallel::Bytes common;  ///< that of rank 0 counts
  std::vector<Item> items;
};

/// Content that was read.
struct CheckpointContent {
  struct Item {
    std::int64_t number = 0;
    parallel::Bytes bytes;
  };
  parallel::Bytes common;   ///< on every rank
  std::vector<Item> items;  ///< of this rank: ascending numbers, distributed by their bytes
};

/// Writes the file whole or not at all (parallel/storage/shared_file.hpp). Collective; throws
/// CollectiveError.
void write_checkpoint(const SharedPath& file, const CheckpointLabel& label, const CheckpointDraft& draft);

/// The label alone; nothing where there is no file, or one with another number of texts. Collective; throws
/// CollectiveError where it is damaged.
std::optional<CheckpointLabel> read_checkpoint_label(const SharedPath& file, std::size_t texts);

/// Collective; throws CollectiveError where it cannot be read or is damaged.
CheckpointContent read_checkpoint(const SharedPath& file);

}  // namespace aeroloom::io
