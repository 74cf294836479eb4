/// Injected faults, for tests of sandboxed tasks. Only an environment variable asks for them.
#pragma once

#include <cstdint>
#include <string_view>

namespace aeroloom::parallel {

/// How a sandboxed task fails before its work begins.
enum class Fault : std::uint8_t { none, throws, aborts, hangs, exhausts_memory };

/// Performs the fault; returns only for `none`. Throws std::runtime_error for `throws`, and std::bad_alloc
/// for `exhausts_memory` if memory is limited.
void inject_fault(Fault fault);

/// The fault of one kind of task. `number`: the task that fails; -1 for all.
struct FaultRequest {
  Fault fault = Fault::none;
  std::int64_t number = -1;
};

/// The fault that the environment variable AEROLOOM_FAULT asks for: `TASK=FAULT` or `TASK=FAULT@NUMBER`.
/// Tasks are "domain", the preparation of the CAD, and "zone", with the number of the zone. Throws
/// std::invalid_argument for any other value.
FaultRequest requested_fault(std::string_view task);

}  // namespace aeroloom::parallel
