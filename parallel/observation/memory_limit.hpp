/// A limit on memory that the user sets: running out of it ends all ranks with one message, before the system
/// begins to kill processes.
///
/// What counts is what a process has to itself (heap and private mappings, touched or not: RLIMIT_DATA), not
/// the program's own pages, stacks, or memory that processes share. Each rank gets an equal share of its
/// node's limit; a sandboxed run gets what is left of the share of its rank, which waits for it.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::parallel {

/// The exit code of a program that ends where running out of memory cannot be agreed on.
inline constexpr int exit_out_of_memory = 8;

/// How the ranks are spread over nodes; of the node of the calling rank.
struct NodeShape {
  int ranks_here = 1, nodes = 1;
};
/// Collective.
NodeShape find_node_shape(const Communicator& communicator);

/// Bytes of memory that this node has, or that the control group of this process may use.
std::int64_t node_memory_bytes();

/// From now on the ranks of this node may use `bytes_of_node` together, which may differ from node to node.
/// Throws CollectiveError (resources) where the program takes more already. Collective; once.
void limit_memory(const Communicator& communicator, std::int64_t bytes_of_node);
bool is_memory_limited();

/// The bytes that a sandboxed run may map: those wanted, or what is left of the share of this rank.
std::int64_t allowed_for_child(std::int64_t wanted);

/// "out of memory", with the limit where there is one.
std::string out_of_memory_text();

/// For memory failures that were not agreed on: where there are other ranks, which wait for this one, says so
/// and ends them all; alone it returns.
void give_up_without_memory();

}  // namespace aeroloom::parallel
