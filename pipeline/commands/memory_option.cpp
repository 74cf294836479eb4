#include "pipeline/commands/memory_option.hpp"

#include "parallel/observation/memory_limit.hpp"
#include "pipeline/commands/command.hpp"
#include "pipeline/commands/help.hpp"

#include <cctype>
#include <charconv>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Bytes of a unit; 0 for none that is known.
double unit_bytes(const std::string& unit, std::int64_t node_bytes) {
  if (unit == "%") return static_cast<double>(node_bytes) / 100;
  constexpr std::string_view letters = "KMGT";
  const bool long_form = unit.size() == 3 && unit.substr(1) == "iB", short_form = unit.size() == 1;
  if (!long_form && !short_form) return 0;
  const std::size_t at = letters.find(static_cast<char>(std::toupper(static_cast<unsigned char>(unit[0]))));
  return at == std::string_view::npos ? 0 : static_cast<double>(std::int64_t{1} << (10 * (at + 1)));
}

}  // namespace

std::int64_t memory_size(const std::string& text, std::int64_t node_bytes) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const std::string unit(end, static_cast<const char*>(text.data() + text.size()));
  const double bytes = error == std::errc() ? number * unit_bytes(unit, node_bytes) : 0;
  constexpr double most_bytes = 1e18;  // fits in 64 bits with a sign
  if (!(bytes >= 1) || bytes > most_bytes || (unit == "%" && number > 100)) {
    throw std::invalid_argument(
        fmt::format("'{}' is no amount of memory; give one like 8G, 500M, or 80% of the node", text));
  }
  return static_cast<std::int64_t>(bytes);
}

void add_memory_option(CLI::App& command, std::int64_t& bytes_of_node) {
  command
      .add_option_function<std::string>(
          "--max-memory",
          [&bytes_of_node](const std::string& text) {
            try {
              bytes_of_node = memory_size(text, parallel::node_memory_bytes());
            } catch (const std::invalid_argument& error) {
              throw CLI::ValidationError("--max-memory", error.what());
            }
          },
          "memory for all ranks of a node together: 8G, 500M, 80% of the node (docs/usage.md)")
      ->type_name("SIZE")
      ->group(option_group::resources);
}

int within_memory(const Invocation& invocation, std::int64_t bytes_of_node,
                  const std::function<int()>& work) {
  try {
    if (bytes_of_node > 0) parallel::limit_memory(invocation.communicator, bytes_of_node);
  } catch (const parallel::CollectiveError& error) {
    return fail(invocation, report::ExitCode::resources, error.what());
  }
  return work();
}

}  // namespace aeroloom::pipeline
