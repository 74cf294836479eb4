/// The option `--max-memory`.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

struct Invocation;

/// Bytes from "8G", "500M", "1.5T" (units of 1024) or "80%" of `node_bytes`. Throws std::invalid_argument for
/// any other text and for zero.
std::int64_t memory_size(const std::string& text, std::int64_t node_bytes);

/// Adds the option. The value is in bytes of this node; 0 without the option.
void add_memory_option(CLI::App& command, std::int64_t& bytes_of_node);

/// Sets the limit, if any, and runs the command. Returns its exit code, or that of a limit which is too small
/// from the start. Collective.
int within_memory(const Invocation& invocation, std::int64_t bytes_of_node, const std::function<int()>& work);

}  // namespace aeroloom::pipeline
