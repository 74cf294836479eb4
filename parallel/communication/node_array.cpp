#include "parallel/communication/node_array.hpp"

#include "parallel/communication/host.hpp"
#include "parallel/communication/imposed_nodes.hpp"
#include "parallel/communication/message_counting.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/communication/transfers.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <chrono>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

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

/// Frees a group, unless the library has ended before.
void free_group(MPI_Comm& group) {
  if (group != MPI_COMM_NULL && session::is_library_running()) MPI_Comm_free(&group);
}

/// The ranks of a node.
class NodeGroup {
public:
  explicit NodeGroup(MPI_Comm all) {
    session::check(MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &_group),
                   "finding the ranks of the node");
    note_size();
  }
  /// Neighbours in the order of ranks instead, so many.
  NodeGroup(const CommunicatorHandle& all, int ranks_per_node) {
    session::check(MPI_Comm_split(all.communicator, all.rank / ranks_per_node, all.rank, &_group),
                   "making the ranks of a node");
    note_size();
  }
  ~NodeGroup() { free_group(_group); }
  NodeGroup(const NodeGroup&) = delete;
  NodeGroup& operator=(const NodeGroup&) = delete;

  int rank() const { return _rank; }
  int size() const { return _size; }
  template <class T>
  void broadcast(T& value) const {
    session::check(MPI_Bcast(&value, sizeof value, MPI_BYTE, 0, _group), "telling the node");
  }
  bool all(bool mine) const { return holds_for_all(_group, mine); }
  void wait() const { session::check(MPI_Barrier(_group), "waiting for the node"); }

  static bool holds_for_all(MPI_Comm group, bool mine) {
    int value = mine ? 1 : 0, result = 0;
    session::check(MPI_Allreduce(&value, &result, 1, MPI_INT, MPI_MIN, group), "asking the others");
    return result != 0;
  }

private:
  void note_size() {
    MPI_Comm_rank(_group, &_rank);
    MPI_Comm_size(_group, &_size);
  }

  MPI_Comm _group = MPI_COMM_NULL;
  int _rank = 0, _size = 1;
};

/// The first ranks of all nodes.
class FirstRanks {
public:
  FirstRanks(const CommunicatorHandle& all, const NodeGroup& node) : _leader_of(all.size) {
    session::check(MPI_Comm_split(all.communicator, node.rank() == 0 ? 0 : MPI_UNDEFINED, all.rank, &_group),
                   "making the group of nodes");
    int mine = 0;
    if (_group != MPI_COMM_NULL) MPI_Comm_rank(_group, &mine);
    node.broadcast(mine);
    session::check(MPI_Allgather(&mine, 1, MPI_INT, _leader_of.data(), 1, MPI_INT, all.communicator),
                   "telling nodes apart");
  }
  ~FirstRanks() { free_group(_group); }
  FirstRanks(const FirstRanks&) = delete;
  FirstRanks& operator=(const FirstRanks&) = delete;

  /// Whether a rank shares its node with this one.
  bool are_together(int rank, int other) const { return _leader_of[rank] == _leader_of[other]; }
  /// Of parts of ranks one after another each node has its ranks' own, and gets the others.
  void complete(std::byte* parts, const std::vector<std::uint64_t>& sizes) const {
    if (_group == MPI_COMM_NULL) return;
    for (std::size_t r = 0; r < sizes.size();) {
      const int leader = _leader_of[r];
      std::uint64_t size = 0;
      for (; r < sizes.size() && _leader_of[r] == leader; ++r) size += sizes[r];
      for_each_part(size, [&](std::size_t offset, int count) {
        session::check(MPI_Bcast(parts + offset, count, MPI_BYTE, leader, _group), "telling the nodes");
      });
      parts += size;
    }
  }

private:
  MPI_Comm _group = MPI_COMM_NULL;
  std::vector<int> _leader_of;  // of each rank, in the group
};

struct Nodes {
  NodeGroup node;
  FirstRanks first_ranks;

  explicit Nodes(const CommunicatorHandle& all) : node(all.communicator), first_ranks(all, node) {}
  Nodes(const CommunicatorHandle& all, int ranks_per_node)
      : node(all, ranks_per_node), first_ranks(all, node) {}
};

/// Made when first asked for, and kept as long as the group is. Collective then.
const Nodes& nodes_of(CommunicatorHandle& all) {
  if (!all.nodes) all.nodes = std::make_shared<const Nodes>(all);
  return *static_cast<const Nodes*>(all.nodes.get());
}

using Mapping = std::shared_ptr<std::byte>;

/// The file from its beginning; nothing when the system refuses.
Mapping map_file(const FileDescriptor& file, std::size_t size, int protection) {
  void* at = mmap(nullptr, size, protection, MAP_SHARED, file.number(), 0);
  if (at == MAP_FAILED) return nullptr;
  return {static_cast<std::byte*>(at), [size](std::byte* start) { munmap(start, size); }};
}

/// The first rank of a node makes the file, with room for so many bytes after the header. A header without
/// a descriptor: it could not.
Mapping make_file(std::size_t bytes, FileDescriptor& file, Header& header) {
  const std::size_t size = sizeof(Header) + bytes;
  file = FileDescriptor(memfd_create("aeroloom", MFD_CLOEXEC));
  if (!file.is_open() || posix_fallocate(file.number(), 0, static_cast<off_t>(size)) != 0) return nullptr;
  Mapping mapping = map_file(file, size, PROT_READ | PROT_WRITE);
  if (!mapping) return nullptr;
  header = {getpid(), file.number(), static_cast<std::int64_t>(size),
            std::chrono::steady_clock::now().time_since_epoch().count()};
  std::memcpy(mapping.get(), &header, sizeof header);
  return mapping;
}

Mapping open_file(const Header& header, int flags, int protection) {
  if (header.descriptor < 0) return nullptr;
  const std::string path = fmt::format("/proc/{}/fd/{}", header.process, header.descriptor);
  const FileDescriptor file(open(path.c_str(), flags | O_CLOEXEC));
  struct stat found {};
  if (!file.is_open() || fstat(file.number(), &found) != 0 || found.st_size != header.size) return nullptr;
  Mapping mapping = map_file(file, static_cast<std::size_t>(header.size), protection);
  if (!mapping || std::memcmp(mapping.get(), &header, sizeof header) != 0) return nullptr;
  return mapping;
}

std::shared_ptr<const std::byte> after_header(const Mapping& mapping) {
  return {mapping, mapping.get() + sizeof(Header)};
}

}  // namespace

std::shared_ptr<const std::byte> NodeMemory::share(const Communicator& communicator,
                                                   std::span<const std::byte> bytes) {
  if (communicator.size() == 1 || bytes.empty()) return nullptr;
  const session::MessageScope timed;
  communicator.usable_handle();
  const NodeGroup& node = nodes_of(*communicator._handle).node;
  if (node.size() == 1) return nullptr;
  FileDescriptor file;
  Header header;
  Mapping mapping;
  if (node.rank() == 0) {
    mapping = make_file(bytes.size(), file, header);
    if (mapping) {
      std::memcpy(mapping.get() + sizeof header, bytes.data(), bytes.size());
      mprotect(mapping.get(), static_cast<std::size_t>(header.size), PROT_READ);
    }
  }
  node.broadcast(header);
  if (node.rank() != 0) mapping = open_file(header, O_RDONLY, PROT_READ);
  if (!node.all(mapping != nullptr)) return nullptr;
  return after_header(mapping);
}

namespace {

/// Where the bytes of each rank begin, and the end.
std::vector<std::uint64_t> offsets_of(const std::vector<std::uint64_t>& sizes) {
  std::vector<std::uint64_t> offsets(sizes.size() + 1, 0);
  std::partial_sum(sizes.begin(), sizes.end(), offsets.begin() + 1);
  return offsets;
}

/// Memory of the node for so many bytes, which its ranks may write; nothing where it cannot be had on some
/// node. Collective.
Mapping map_on_nodes(const CommunicatorHandle& all, const NodeGroup& node, std::uint64_t bytes) {
  FileDescriptor file;
  Header header;
  Mapping mapping;
  if (node.rank() == 0) mapping = make_file(bytes, file, header);
  node.broadcast(header);
  if (node.rank() != 0) mapping = open_file(header, O_RDWR, PROT_READ | PROT_WRITE);
  return NodeGroup::holds_for_all(all.communicator, mapping != nullptr) ? mapping : nullptr;
}

/// Of a file, from its beginning.
void protect(std::byte* start) {
  Header header;
  std::memcpy(&header, start, sizeof header);
  mprotect(start, static_cast<std::size_t>(header.size), PROT_READ);
}

}  // namespace

std::shared_ptr<const std::byte> NodeMemory::gather(const Communicator& communicator,
                                                    std::span<const std::byte> mine) {
  const std::vector<std::uint64_t> sizes = communicator.all_sizes(mine.size());
  const std::vector<std::uint64_t> offsets = offsets_of(sizes);
  const session::MessageScope timed;
  const CommunicatorHandle& all = communicator.usable_handle();
  session::count_all_gather(all, sizes);
  if (all.size == 1 || offsets.back() == 0) return nullptr;
  const auto& [node, first_ranks] = nodes_of(*communicator._handle);
  const Mapping mapping = map_on_nodes(all, node, offsets.back());
  if (!mapping) return nullptr;
  std::byte* parts = mapping.get() + sizeof(Header);
  if (!mine.empty()) std::memcpy(parts + offsets[all.rank], mine.data(), mine.size());
  node.wait();
  if (node.rank() == 0) first_ranks.complete(parts, sizes);
  node.wait();
  protect(mapping.get());
  return after_header(mapping);
}

NodeMemory::Composition NodeMemory::compose(const Communicator& communicator,
                                            std::span<const std::byte> mine) {
  Composition result;
  result.offsets = offsets_of(communicator.all_sizes(mine.size()));
  const session::MessageScope timed;
  const CommunicatorHandle& all = communicator.usable_handle();
  const auto& [node, first_ranks] = nodes_of(*communicator._handle);
  const Mapping mapping = map_on_nodes(all, node, result.offsets.back());
  result.is_of_node = mapping != nullptr;
  if (mapping) {
    result.memory = {mapping, mapping.get() + sizeof(Header)};
  } else {
    const auto own = std::make_shared<std::vector<std::byte>>(result.offsets.back());
    result.memory = {own, own->data()};
  }
  int others = 0;
  for (Rank rank = 0; rank < all.size; ++rank) {
    if (rank == all.rank) continue;
    if (!mapping) result.unwritten.push_back(rank);
    if (mapping && !first_ranks.are_together(rank, all.rank) && others++ % node.size() == node.rank())
      result.unwritten.push_back(rank);
  }
  if (!mine.empty()) std::memcpy(result.part(all.rank).data(), mine.data(), mine.size());
  return result;
}

std::shared_ptr<const std::byte> NodeMemory::finish(Composition composition) {
  if (composition.is_of_node) protect(composition.memory.get() - sizeof(Header));
  return std::move(composition.memory);
}

Communicator impose_nodes(const Communicator& communicator, int ranks_per_node) {
  const std::shared_ptr<CommunicatorHandle> all = session::duplicate(host_communicator(communicator));
  all->nodes = std::make_shared<const Nodes>(*all, ranks_per_node);
  return Communicator(all);
}

}  // namespace aeroloom::parallel
