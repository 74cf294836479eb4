/// Faults injected on purpose, for tests of sandboxed tasks. No option of the program injects one.
#pragma once

#include <cstdint>
#include <string_view>

namespace aeroloom::parallel {

/// A fault that a sandboxed task has before its work, so that tests see what comes of it.
enum class Fault : std::uint8_t { none, throws, aborts, hangs, exhausts_memory };

/// Acts as the fault says; returns for `none` only. Throws std::runtime_error for `throws`, std::bad_alloc
/// where memory is limited.
void inject_fault(Fault fault);

/// A fault wanted of one kind of task, and of which of them: -1: of all.
struct FaultRequest {
  Fault fault = Fault::none;
  std::int64_t number = -1;
};

/// The fault that the environment variable AEROLOOM_FAULT asks for: `TASK=FAULT` or `TASK=FAULT@NUMBER`.
/// Tasks: "domain", the preparation of the CAD; "zone", with the number of the zone. Throws
/// std::invalid_argument for what is neither.
FaultRequest requested_fault(std::string_view task);

}  // namespace aeroloom::parallel
