#include "parallel/node_array.hpp"

#include "parallel/file_descriptor.hpp"
#include "parallel/session.hpp"

#include <chrono>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

/// In front of the bytes, and what ranks of a node tell each other: a file without a name, reached through
/// the process that made it, is the right one if it begins with what was told.
struct Header {
  std::int64_t process = 0, descriptor = -1, size = 0, made_at = 0;
};
static_assert(sizeof(Header) % alignof(std::max_align_t) == 0);

/// A group that is freed at the end of the scope.
class NodeGroup {
public:
  explicit NodeGroup(MPI_Comm all) {
    session::check(MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &_group),
                   "finding the ranks of the node");
    MPI_Comm_rank(_group, &_rank);
    MPI_Comm_size(_group, &_size);
  }
  ~NodeGroup() { MPI_Comm_free(&_group); }
  NodeGroup(const NodeGroup&) = delete;
  NodeGroup& operator=(const NodeGroup&) = delete;

  int rank() const { return _rank; }
  int size() const { return _size; }
  void broadcast(Header& header) const {
    session::check(MPI_Bcast(&header, sizeof header, MPI_BYTE, 0, _group), "telling the node");
  }
  bool all(bool mine) const {
    int value = mine ? 1 : 0, result = 0;
    session::check(MPI_Allreduce(&value, &result, 1, MPI_INT, MPI_MIN, _group), "asking the node");
    return result != 0;
  }

private:
  MPI_Comm _group = MPI_COMM_NULL;
  int _rank = 0, _size = 1;
};

using Mapping = std::shared_ptr<std::byte>;

/// The file from its beginning; nothing when the system refuses.
Mapping map_file(const FileDescriptor& file, std::size_t size, int protection) {
  void* at = mmap(nullptr, size, protection, MAP_SHARED, file.number(), 0);
  if (at == MAP_FAILED) return nullptr;
  return {static_cast<std::byte*>(at), [size](std::byte* start) { munmap(start, size); }};
}

/// The first rank of a node writes the file. A header without a descriptor: it could not.
Mapping write_file(std::span<const std::byte> bytes, FileDescriptor& file, Header& header) {
  const std::size_t size = sizeof(Header) + bytes.size();
  file = FileDescriptor(memfd_create("aeroloom", MFD_CLOEXEC));
  if (!file.is_open() || posix_fallocate(file.number(), 0, static_cast<off_t>(size)) != 0) return nullptr;
  Mapping mapping = map_file(file, size, PROT_READ | PROT_WRITE);
  if (!mapping) return nullptr;
  header = {getpid(), file.number(), static_cast<std::int64_t>(size),
            std::chrono::steady_clock::now().time_since_epoch().count()};
  std::memcpy(mapping.get(), &header, sizeof header);
  std::memcpy(mapping.get() + sizeof header, bytes.data(), bytes.size());
  mprotect(mapping.get(), size, PROT_READ);
  return mapping;
}

Mapping open_file(const Header& header) {
  if (header.descriptor < 0) return nullptr;
  const std::string path = fmt::format("/proc/{}/fd/{}", header.process, header.descriptor);
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat found {};
  if (!file.is_open() || fstat(file.number(), &found) != 0 || found.st_size != header.size) return nullptr;
  Mapping mapping = map_file(file, static_cast<std::size_t>(header.size), PROT_READ);
  if (!mapping || std::memcmp(mapping.get(), &header, sizeof header) != 0) return nullptr;
  return mapping;
}

}  // namespace

std::shared_ptr<const std::byte> NodeMemory::share(const Communicator& communicator,
                                                   std::span<const std::byte> bytes) {
  if (communicator.size() == 1 || bytes.empty()) return nullptr;
  const session::MessageScope timed;
  const NodeGroup node(communicator.usable_handle().communicator);
  if (node.size() == 1) return nullptr;
  FileDescriptor file;
  Header header;
  Mapping mapping;
  if (node.rank() == 0) mapping = write_file(bytes, file, header);
  node.broadcast(header);
  if (node.rank() != 0) mapping = open_file(header);
  if (!node.all(mapping != nullptr)) return nullptr;
  return {mapping, mapping.get() + sizeof(Header)};
}

}  // namespace aeroloom::parallel
