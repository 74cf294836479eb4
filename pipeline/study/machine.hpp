/// The machine that a study ran on.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// Of this host, as far as the system tells; for a study of jobs, of the hosts' first that says so.
struct Machine {
  std::string host;
  std::string processor;
  int processors = 1;              ///< that one node may use
  std::int64_t memory_bytes = 0;   ///< of a node
  std::vector<std::string> links;  ///< network interfaces with their speed
  std::string system;

  nlohmann::ordered_json json() const;
};

Machine this_machine();

}  // namespace aeroloom::study
