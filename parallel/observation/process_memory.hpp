/// This process's memory as the system tells it.
#pragma once

#include <cstdint>

namespace aeroloom::parallel {

inline constexpr double gibibyte = 1024.0 * 1024 * 1024;  ///< bytes

/// A memory figure of a file of /proc/self, in bytes; 0 where the system does not tell.
std::int64_t process_memory(const char* path, const char* key);

/// One of /proc/self/status. Resource usage would not do instead: its peak survives exec and may be that of
/// the launcher.
inline std::int64_t status_bytes(const char* key) {
  return process_memory("/proc/self/status", key);
}

}  // namespace aeroloom::parallel
