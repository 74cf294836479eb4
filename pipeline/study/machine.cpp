#include "pipeline/study/machine.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace aeroloom::study {

namespace {

/// The value after `key` and a colon, of the first line that begins with them.
std::string value_of(const char* file, const std::string& key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t at = line.find_first_not_of(" \t", line.find(':') + 1);
    return at == std::string::npos ? "" : line.substr(at);
  }
  return {};
}

std::vector<std::string> network_links() {
  std::vector<std::string> links;
  std::error_code ignored;  // unknown links are left out
  for (const auto& entry : std::filesystem::directory_iterator("/sys/class/net", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name == "lo") continue;
    std::ifstream file(entry.path() / "speed");
    long speed = 0;  // Mbit/s
    links.push_back(file >> speed && speed > 0
                        ? fmt::format("{} ({:g} Gbit/s)", name, 1e-3 * static_cast<double>(speed))
                        : name);
  }
  std::sort(links.begin(), links.end());
  return links;
}

int usable_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof(set), &set) != 0) return 1;
  return std::max(1, CPU_COUNT(&set));
}

}  // namespace

nlohmann::ordered_json Machine::json() const {
  return {
      {"host", host},   {"processor", processor}, {"processors", processors}, {"memory_bytes", memory_bytes},
      {"links", links}, {"system", system}};
}

Machine this_machine() {
  Machine machine;
  utsname names{};
  if (::uname(&names) == 0) {
    machine.host = names.nodename;
    machine.system = fmt::format("{} {} {}", names.sysname, names.release, names.machine);
  }
  machine.processor = value_of("/proc/cpuinfo", "model name");
  machine.processors = usable_processors();
  machine.memory_bytes = static_cast<std::int64_t>(::sysconf(_SC_PHYS_PAGES)) * ::sysconf(_SC_PAGESIZE);
  machine.links = network_links();
  return machine;
}

}  // namespace aeroloom::study
