/// Harm done on purpose, in tests of containment.
#pragma once

#include <cstdint>

namespace aeroloom::parallel {

/// What a contained task does before its work.
enum class Sabotage : std::uint8_t { none, throws, aborts, hangs, exhausts_memory };

/// Does it; returns for `none` only. Throws std::runtime_error for `throws`, std::bad_alloc where memory is
/// limited.
void commit_sabotage(Sabotage sabotage);

}  // namespace aeroloom::parallel
