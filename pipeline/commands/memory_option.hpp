/// `--max-memory`.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

struct Invocation;

/// "8G", "500M", "1.5T" (units of 1024) or "80%" of `node_bytes`, as bytes. Throws std::invalid_argument for
/// anything else, and for nothing.
std::int64_t memory_size(const std::string& text, std::int64_t node_bytes);

/// Adds the option; the value is in bytes of this node, 0 without the option.
void add_memory_option(CLI::App& command, std::int64_t& bytes_of_node);

/// Does the work of a command under the limit, if there is one: its exit code, or that of a limit that is too
/// small to begin with. Collective.
int within_memory(const Invocation& invocation, std::int64_t bytes_of_node, const std::function<int()>& work);

}  // namespace aeroloom::pipeline
