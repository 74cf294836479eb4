/// The list of all operations, in the order in which they are tried.
#pragma once

#include "improve/operations/operation.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace aeroloom::improve {

/// An operation, and where it is tried.
struct ListedOperation {
  std::string_view name;  ///< as in docs/improvement.md
  int from_sweep;         ///< the first sweep that tries it
  double below;           ///< tried where quality is below this fraction of the local target; 1: everywhere
  bool is_costly;         ///< not tried beside strips with reduced effort, except on severe tetrahedra
  std::unique_ptr<LocalOperation> (*make)(const OperationContext& context);
};

/// The table in docs/improvement.md (Steps, Sweeps) is this array.
std::span<const ListedOperation> operations();

/// The level of a sweep: the last sweep up to it that adds an operation. At the same level the same
/// operations are tried.
int level_of_sweep(int sweep);
/// The highest level; of operations that are not costly alone, the highest beside strips.
int last_level();
int last_level_in_narrow_regions();

}  // namespace aeroloom::improve
