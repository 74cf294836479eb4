/// The memory of this process, read from the system.
#pragma once

#include <cstdint>

namespace aeroloom::parallel {

inline constexpr double gibibyte = 1024.0 * 1024 * 1024;  ///< bytes

/// The value of a key in a file of /proc/self, in bytes; 0 if there is none.
std::int64_t process_memory(const char* path, const char* key);

/// A value of /proc/self/status. It replaces getrusage(), whose peak survives exec and may be that of the
/// launcher.
inline std::int64_t status_bytes(const char* key) {
  return process_memory("/proc/self/status", key);
}

}  // namespace aeroloom::parallel
