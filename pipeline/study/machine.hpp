/// Describes the machine of a study.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// Of this host, as far as known. For a study of jobs: of the first host that reports it.
struct Machine {
  std::string host;
  std::string processor;
  int processors = 1;              ///< available on one node
  std::int64_t memory_bytes = 0;   ///< of a node
  std::vector<std::string> links;  ///< network interfaces with speed
  std::string system;

  nlohmann::ordered_json json() const;
};

Machine this_machine();

}  // namespace aeroloom::study
