#include "io/checkpoint_file.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/schedule.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

namespace aeroloom::io {
namespace {

using parallel::Bytes;
using parallel::Communicator;
using parallel::Digest;

constexpr std::uint64_t magic = 0x54504b43'4f524541;  // "AEROCKPT"
constexpr std::uint64_t version = 2;

/// The beginning of the file.
struct Preamble {
  std::uint64_t magic = 0, version = 0;
  std::int64_t header_bytes = 0, file_bytes = 0;
  Digest digest;  ///< of the above and of the header
  Digest right_digest(std::span<const std::byte> header) const {
    Preamble unsigned_one = *this;
    unsigned_one.digest = {};
    return parallel::Digester().bytes(parallel::to_wire(unsigned_one)).bytes(header).result();
  }
};

/// The common bytes, or an item.
struct SavedItem {
  std::int64_t number = 0, bytes = 0;
  Digest digest;
};

constexpr std::int64_t preamble_bytes = parallel::wire_size<Preamble>;

struct Header {
  CheckpointLabel label;
  std::vector<SavedItem> rows;  ///< of the common bytes, then of the items by number
  /// Where the bytes of each row begin, and where the last ones end.
  std::vector<std::int64_t> offsets(std::int64_t first) const {
    std::vector<std::int64_t> offsets;
    for (const SavedItem& row : rows) offsets.push_back(std::exchange(first, first + row.bytes));
    offsets.push_back(first);
    return offsets;
  }
};

[[noreturn]] void refuse_checkpoint(const std::string& path, const std::string& why) {
  throw std::ios_base::failure(fmt::format("'{}' is damaged: {}", path, why));
}

void read_at(std::ifstream& stream, const std::string& path, std::int64_t offset, std::span<std::byte> to) {
  stream.seekg(offset);
  stream.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
  if (!stream) refuse_checkpoint(path, "it cannot be read to its end");
}

/// The packed header, checked; rank 0 reads it. Empty where there is no file.
Bytes read_header(const std::string& path, Preamble& preamble) {
  if (!std::filesystem::exists(path)) return {};
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path));
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::ios_base::failure("cannot open '" + path + "'");
  Bytes beginning(preamble_bytes);
  read_at(stream, path, 0, beginning);
  preamble = parallel::from_wire<Preamble>(beginning);
  if (preamble.magic != magic) refuse_checkpoint(path, "it does not begin as a checkpoint does");
  if (preamble.version != version)
    refuse_checkpoint(path, fmt::format("layout {}, this program reads {}", preamble.version, version));
  if (preamble.file_bytes != size)
    refuse_checkpoint(path, fmt::format("{} bytes, its beginning says {}", size, preamble.file_bytes));
  if (preamble.header_bytes <= 0 || preamble.header_bytes > size)
    refuse_checkpoint(path, "its header is too long");
  Bytes header(static_cast<std::size_t>(preamble.header_bytes));
  read_at(stream, path, preamble_bytes, header);
  if (preamble.right_digest(header) != preamble.digest)
    refuse_checkpoint(path, "its header is not what was written");
  return header;
}

/// On every rank; empty where there is no file.
Bytes broadcast_header(const SharedPath& file) {
  Bytes bytes;
  parallel::on_root(file.communicator, [&] {
    Preamble preamble;
    bytes = read_header(file.path, preamble);
  });
  file.communicator.broadcast(bytes);
  return bytes;
}

/// Rows and places of the whole file, the same on every rank.
Header plan(const Communicator& communicator, const CheckpointLabel& label, const CheckpointDraft& draft) {
  std::vector<SavedItem> mine;
  parallel::agree(communicator, [&] {
    for (const CheckpointDraft::Item& item : draft.items) {
      const Bytes bytes = item.bytes();
      mine.push_back({item.number, static_cast<std::int64_t>(bytes.size()), parallel::digest_of(bytes)});
    }
  });
  Header header{label, communicator.gather_sorted(mine, &SavedItem::number)};
  std::vector<SavedItem> common{
      {-1, static_cast<std::int64_t>(draft.common.size()), parallel::digest_of(draft.common)}};
  communicator.broadcast_items(common);
  header.rows.insert(header.rows.begin(), common.front());
  return header;
}

Bytes read_checked(std::ifstream& stream, const std::string& path, const SavedItem& row,
                   std::int64_t offset) {
  Bytes bytes(static_cast<std::size_t>(row.bytes));
  read_at(stream, path, offset, bytes);
  if (parallel::digest_of(bytes) != row.digest)
    refuse_checkpoint(path,
                      fmt::format("the {} bytes from {} on are not what was written", row.bytes, offset));
  return bytes;
}

}  // namespace

void write_checkpoint(const SharedPath& file, const CheckpointLabel& label, const CheckpointDraft& draft) {
  const Communicator& communicator = file.communicator;
  const Header header = plan(communicator, label, draft);
  const Bytes packed = parallel::to_wire(header);
  const auto offsets = header.offsets(preamble_bytes + static_cast<std::int64_t>(packed.size()));
  // The old file stays until all of the new one is there.
  const std::string fresh = file.path + ".new";
  const auto work = [&](parallel::SharedFile& opened) {
    if (communicator.is_root()) {
      Preamble preamble{magic, version, static_cast<std::int64_t>(packed.size()), offsets.back(), {}};
      preamble.digest = preamble.right_digest(packed);
      opened.write(0, parallel::to_wire(preamble));
      opened.write(preamble_bytes, packed);
      opened.write(offsets.front(), draft.common);
    }
    for (const CheckpointDraft::Item& item : draft.items) {
      const auto row =
          std::lower_bound(header.rows.begin() + 1, header.rows.end(), item.number,
                           [](const SavedItem& a, std::int64_t number) { return a.number < number; });
      opened.write(offsets[static_cast<std::size_t>(row - header.rows.begin())], item.bytes());
    }
  };
  parallel::write_shared_file(communicator, fresh, work, parallel::Named::when_written);
  parallel::on_root(communicator, [&] { std::filesystem::rename(fresh, file.path); });
}

std::optional<CheckpointLabel> read_checkpoint_label(const SharedPath& file, std::size_t texts) {
  const Bytes packed = broadcast_header(file);
  if (packed.empty()) return std::nullopt;
  CheckpointLabel label = parallel::from_wire<Header>(packed).label;
  if (label.about.size() != texts) return std::nullopt;
  return label;
}

CheckpointContent read_checkpoint(const SharedPath& file) {
  const auto& [communicator, path] = file;
  const Bytes packed = broadcast_header(file);
  CheckpointContent content;
  parallel::agree(communicator, [&] {
    if (packed.empty()) throw std::ios_base::failure("there is no '" + path + "'");
    const auto header = parallel::from_wire<Header>(packed);
    const auto offsets = header.offsets(preamble_bytes + static_cast<std::int64_t>(packed.size()));
    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw std::ios_base::failure("cannot open '" + path + "'");
    if (communicator.is_root())
      content.common = read_checked(stream, path, header.rows.front(), offsets.front());
    std::vector<double> loads;
    for (std::size_t i = 1; i < header.rows.size(); ++i)
      loads.push_back(static_cast<double>(header.rows[i].bytes));
    const std::vector<parallel::Rank> owners = parallel::assign_largest_first(loads, communicator.size());
    for (std::size_t i = 0; i < owners.size(); ++i) {
      if (owners[i] != communicator.rank()) continue;
      content.items.push_back(
          {header.rows[i + 1].number, read_checked(stream, path, header.rows[i + 1], offsets[i + 1])});
    }
  });
  communicator.broadcast(content.common);
  return content;
}

}  // namespace aeroloom::io
