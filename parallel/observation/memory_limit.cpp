#include "parallel/observation/memory_limit.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/communication/host.hpp"
#include "parallel/communication/session.hpp"
#include "parallel/observation/process_memory.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

/// The share of this rank, and what is told of it; 0 where there is none.
struct Limit {
  std::int64_t share = 0, of_node = 0;
  int ranks_here = 1;
};

Limit& limit() {
  static Limit instance;
  return instance;
}

/// Once it has struck, the way out needs memory, too.
void lift() {
  rlimit data{};
  getrlimit(RLIMIT_DATA, &data);
  data.rlim_cur = data.rlim_max;
  setrlimit(RLIMIT_DATA, &data);
}

/// An allocation has failed. Within agree() all ranks will learn of it; elsewhere the others would wait for
/// ever.
void on_exhaustion() {
  lift();
  if (!is_agreeing()) give_up_without_memory();
  throw std::bad_alloc();
}

double gibibytes(std::int64_t bytes) {
  return static_cast<double>(bytes) / (1LL << 30);
}

/// The least limit of a control group and of those above it, as far as they can be seen.
std::int64_t least_limit(const std::string& root, std::string group, const char* name, std::int64_t bytes) {
  while (true) {
    if (group == "/") group.clear();
    std::ifstream file(root + group + "/" + name);
    std::int64_t allowed = 0;
    if (file >> allowed && allowed > 0) bytes = std::min(bytes, allowed);
    const std::size_t last = group.find_last_of('/');
    if (last == std::string::npos) return bytes;
    group.erase(last);
  }
}

}  // namespace

NodeShape find_node_shape(const Communicator& communicator) {
  NodeShape shape;
  MPI_Comm node = MPI_COMM_NULL;
  session::check(
      MPI_Comm_split_type(host_communicator(communicator), MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node),
      "finding the ranks of the node");
  int rank = 0;
  MPI_Comm_size(node, &shape.ranks_here);
  MPI_Comm_rank(node, &rank);
  MPI_Comm_free(&node);
  shape.nodes = static_cast<int>(communicator.sum(std::int64_t{rank == 0 ? 1 : 0}));
  return shape;
}

std::int64_t node_memory_bytes() {
  std::int64_t bytes = static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
  std::ifstream groups("/proc/self/cgroup");  // "0::/job" (version 2), "4:memory:/job" (version 1)
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string kinds = fmt::format(",{},", line.substr(first + 1, second - first - 1));
    const std::string group = line.substr(second + 1);
    if (kinds == ",,") bytes = least_limit("/sys/fs/cgroup", group, "memory.max", bytes);
    if (kinds.find(",memory,") != std::string::npos)
      bytes = least_limit("/sys/fs/cgroup/memory", group, "memory.limit_in_bytes", bytes);
  }
  return bytes;
}

void limit_memory(const Communicator& communicator, std::int64_t bytes_of_node) {
  const int ranks_here = find_node_shape(communicator).ranks_here;
  agree(communicator, [&] {
    const std::int64_t share = bytes_of_node / ranks_here, used = status_bytes("RssAnon");
    limit() = {share, bytes_of_node, ranks_here};
    if (share <= used) throw std::bad_alloc();
    // Memory that is reserved but not in use, such as stacks of threads, is not charged.
    const std::int64_t reserved = std::max<std::int64_t>(0, status_bytes("VmData") - used);
    rlimit data{};
    getrlimit(RLIMIT_DATA, &data);
    data.rlim_cur = std::min(data.rlim_max, static_cast<rlim_t>(share + reserved));
    if (setrlimit(RLIMIT_DATA, &data) != 0) throw std::runtime_error("the system refuses a limit on memory");
    std::set_new_handler(on_exhaustion);
  });
}

bool is_memory_limited() {
  return limit().share > 0;
}

std::int64_t allowed_for_child(std::int64_t wanted) {
  if (!is_memory_limited()) return wanted;
  constexpr std::int64_t least = 1 << 20;  // nothing runs in that, and that is what is said
  return std::clamp(limit().share - status_bytes("RssAnon"), std::min(least, wanted), wanted);
}

std::string out_of_memory_text() {
  if (!is_memory_limited()) return "out of memory";
  return fmt::format(
      "out of memory: {:.3g} GiB are allowed on this node (--max-memory), {:.3g} GiB for each of its {} "
      "rank(s). Remedies: a higher limit, larger sizes, more nodes, fewer ranks on each",
      gibibytes(limit().of_node), gibibytes(limit().share), limit().ranks_here);
}

void give_up_without_memory() {
  if (!session::is_library_running()) return;
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (size == 1) return;
  std::fprintf(stderr, "error (rank %d): %s\n", rank, out_of_memory_text().c_str());
  abort_all_ranks(exit_out_of_memory);
}

}  // namespace aeroloom::parallel
