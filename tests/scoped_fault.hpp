/// A fault in sandboxed tasks for as long as this lives.
#pragma once

#include <cstdlib>
#include <string>

namespace aeroloom {

class ScopedFault {
public:
  /// As parallel::requested_fault() reads it: "zone=aborts@3".
  explicit ScopedFault(const std::string& request) { setenv("AEROLOOM_FAULT", request.c_str(), 1); }
  ~ScopedFault() { unsetenv("AEROLOOM_FAULT"); }
  ScopedFault(const ScopedFault&) = delete;
  ScopedFault& operator=(const ScopedFault&) = delete;
};

}  // namespace aeroloom
