#include "parallel/storage/task_store.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

namespace aeroloom::parallel {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t magic = 0x31307473'6b736174;  // of this layout of records
constexpr const char* extension = ".tasks";

/// Everything at that place; false where the file ends before.
bool read_all(const FileDescriptor& file, std::int64_t offset, std::span<std::byte> to) {
  while (!to.empty()) {
    const ssize_t count = pread(file.number(), to.data(), to.size(), offset);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    to = to.subspan(static_cast<std::size_t>(count));
    offset += count;
  }
  return true;
}

}  // namespace

/// In front of each result.
struct TaskStore::RecordHeader {
  std::uint64_t magic = 0;
  Digest key, content;
  std::int64_t bytes = 0;
  std::uint64_t check = 0;  ///< of all the above

  std::uint64_t right_check() const {
    return digest_of(std::as_bytes(std::span(this, 1)).first(offsetof(RecordHeader, check))).low;
  }
};

struct TaskStore::FileName {
  std::int32_t generation = 0, rank = 0;
};

TaskStore::TaskStore(Communicator communicator, std::string folder, std::string name, const Digest& context,
                     Earlier earlier)
    : _communicator(std::move(communicator)),
      _folder(std::move(folder)),
      _name(std::move(name)),
      _context(context) {
  std::vector<FileName> files;
  on_root(_communicator, [&] {
    fs::create_directories(_folder);
    if (earlier == Earlier::forget) remove_files();
    files = list_files();
  });
  _communicator.broadcast_items(files);
  std::vector<StoredTask> mine;
  for (std::size_t i = 0; i < files.size(); ++i) {
    _generation = std::max(_generation, files[i].generation + 1);
    if (static_cast<Rank>(i % static_cast<std::size_t>(_communicator.size())) != _communicator.rank())
      continue;
    const std::vector<StoredTask> places = scan(files[i]);
    mine.insert(mine.end(), places.begin(), places.end());
  }
  for (const StoredTask& place : _communicator.all_gather_items<StoredTask>(mine))
    _places.emplace(place.key, place);
}

TaskStore::~TaskStore() = default;

std::string TaskStore::path_of(std::int32_t generation, Rank rank) const {
  return fmt::format("{}/{}.{}.{}{}", _folder, _name, generation, rank, extension);
}

/// Ascending.
std::vector<TaskStore::FileName> TaskStore::list_files() const {
  std::vector<FileName> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(_folder)) {
    const std::string name = entry.path().filename().string();
    FileName file;
    const std::string prefix = _name + ".";
    if (!name.starts_with(prefix)) continue;
    const char *at = name.data() + prefix.size(), *const end = name.data() + name.size();
    const auto generation = std::from_chars(at, end, file.generation);
    if (generation.ec != std::errc() || generation.ptr == end) continue;
    if (std::from_chars(generation.ptr + 1, end, file.rank).ec != std::errc()) continue;
    if (entry.path().string() == path_of(file.generation, file.rank)) files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const FileName& a, const FileName& b) {
    return std::pair(a.generation, a.rank) < std::pair(b.generation, b.rank);
  });
  return files;
}

/// The records up to the first that is not whole.
std::vector<TaskStore::StoredTask> TaskStore::scan(const FileName& file) const {
  std::vector<StoredTask> places;
  const FileDescriptor stream(open(path_of(file.generation, file.rank).c_str(), O_RDONLY | O_CLOEXEC));
  struct stat status {};
  if (!stream.is_open() || fstat(stream.number(), &status) != 0) return places;
  RecordHeader header;
  for (std::int64_t at = 0;; at += header.bytes) {
    if (!read_all(stream, at, std::as_writable_bytes(std::span(&header, 1)))) return places;
    at += static_cast<std::int64_t>(sizeof header);
    if (header.magic != magic || header.check != header.right_check()) return places;
    if (header.bytes < 0 || header.bytes > status.st_size - at) return places;
    places.push_back({header.key, header.content, at, header.bytes, file.generation, file.rank});
  }
}

Digest TaskStore::in_context(const Digest& key) const {
  return Digester().value(_context.low).value(_context.high).value(key.low).value(key.high).result();
}

std::optional<Bytes> TaskStore::find(const Digest& key) {
  const auto at = _places.find(in_context(key));
  if (at == _places.end()) return std::nullopt;
  const StoredTask& place = at->second;
  const FileDescriptor stream(open(path_of(place.generation, place.rank).c_str(), O_RDONLY | O_CLOEXEC));
  Bytes result(static_cast<std::size_t>(place.bytes));
  if (!stream.is_open() || !read_all(stream, place.offset, result)) return std::nullopt;
  if (digest_of(result) != place.content) return std::nullopt;
  ++_found;
  return result;
}

void TaskStore::keep(const Digest& key, std::span<const std::byte> result) {
  if (_failed) return;
  const std::string path = path_of(_generation, _communicator.rank());
  if (!_file) {
    _file =
        std::make_unique<FileDescriptor>(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!_file->is_open()) return give_up(std::strerror(errno));
  }
  RecordHeader header{magic, in_context(key), digest_of(result), static_cast<std::int64_t>(result.size()), 0};
  header.check = header.right_check();
  errno = 0;
  if (write_all(_file->number(), std::as_bytes(std::span(&header, 1))) &&
      write_all(_file->number(), result)) {
    _end += static_cast<std::int64_t>(sizeof header + result.size());
    return;
  }
  const std::string reason = std::strerror(errno);
  if (ftruncate(_file->number(), _end) != 0) _file->close();  // what is not whole is not found
  give_up(reason);
}

void TaskStore::give_up(const std::string& reason) {
  _failed = true;
  log_warning(
      fmt::format("checkpoint: cannot write to '{}' ({}): from here on what is finished within a "
                  "stage is not kept",
                  path_of(_generation, _communicator.rank()), reason));
}

void TaskStore::remove_files() const {
  for (const FileName& file : list_files()) fs::remove(path_of(file.generation, file.rank));
}

void TaskStore::remove() {
  _file.reset();
  _places.clear();
  _communicator.barrier();
  on_root(_communicator, [&] { remove_files(); });
}

}  // namespace aeroloom::parallel
