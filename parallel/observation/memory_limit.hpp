/// The user's memory limit. Reaching it ends all ranks with one message, before the system begins to kill
/// processes.
///
/// The limit is on private memory of a process: heap and private mappings, touched or not (RLIMIT_DATA).
/// Pages of the program, stacks and shared memory do not count. Ranks of a node divide its limit equally. A
/// sandboxed run may use the remaining memory of its rank, which waits for it.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::parallel {

/// The exit code when a rank runs out of memory outside agree().
inline constexpr int exit_out_of_memory = 8;

/// The number of ranks on the node of the calling rank, and the number of nodes.
struct NodeShape {
  int ranks_here = 1, nodes = 1;
};
/// Collective.
NodeShape find_node_shape(const Communicator& communicator);

/// The memory of this node, or the limit of the control group of this process if lower; bytes.
std::int64_t node_memory_bytes();

/// Limits the ranks of this node to `bytes_of_node` together; nodes may differ. Throws CollectiveError
/// (resources) if the program uses more already. Collective; to be called once.
void limit_memory(const Communicator& communicator, std::int64_t bytes_of_node);
bool is_memory_limited();

/// The bytes that a sandboxed run may map: `wanted`, at most the remaining memory of this rank.
std::int64_t allowed_for_child(std::int64_t wanted);

/// "out of memory", with the limit if there is one.
std::string out_of_memory_text();

/// Handles a failed allocation outside agree(). With several ranks, which would wait for this one, it prints
/// a message and ends all of them; on a single rank it returns.
void give_up_without_memory();

}  // namespace aeroloom::parallel
