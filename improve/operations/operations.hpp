/// The list of all operations, in the order of use.
#pragma once

#include "improve/operations/operation.hpp"

#include <memory>
#include <span>
#include <string_view>

namespace aeroloom::improve {

/// An operation and when it is used.
struct ListedOperation {
  std::string_view name;  ///< as in docs/improvement.md
  int from_sweep;         ///< first sweep that uses it
  double below;           ///< used below this fraction of the local target; 1: everywhere
  bool is_costly;         ///< with reduced effort, skipped in narrow regions unless a tetrahedron is severe
  std::unique_ptr<LocalOperation> (*make)(const OperationContext& context);
};

/// The list; the table in docs/improvement.md (Steps, Sweeps) shows it.
std::span<const ListedOperation> operations();

/// The level of a sweep: the last sweep up to it that adds an operation. Equal levels use equal operations.
int level_of_sweep(int sweep);
/// The highest level of all operations, and of those used in narrow regions.
int last_level();
int last_level_in_narrow_regions();

}  // namespace aeroloom::improve
