/// The distinct numbers in lists of all ranks. Internal to io/.
#pragma once

#include "geometry/sort_unique.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The distinct numbers in the lists of all ranks, ascending. Throws CollectiveError (input) with `message`
/// where there are more than `most`. Takes memory for a few times `most` numbers. Collective.
template <class Number>
std::vector<Number> distinct_numbers(const parallel::Communicator& communicator,
                                     const std::vector<std::span<const Number>>& lists, std::size_t most,
                                     const std::string& message) {
  std::vector<Number> found;
  const auto is_too_many = [&] {
    geometry::sort_unique(found);
    return found.size() > most;
  };
  bool fails = false;
  parallel::agree(communicator, [&] {
    for (const std::span<const Number> list : lists) {
      for (const Number number : list) {
        if (found.empty() || found.back() != number) found.push_back(number);
        if (found.size() > 2 * most && (fails = is_too_many())) return;
      }
    }
    fails = is_too_many();
  });
  // The text does not depend on how many ranks find too many in their lists.
  const auto require_few = [&] {
    if (communicator.maximum(std::int64_t{fails}) > 0)
      throw parallel::CollectiveError(parallel::FailureKind::input, message);
  };
  require_few();
  found = communicator.all_gather_items(std::span<const Number>(found));
  parallel::agree(communicator, [&] { fails = is_too_many(); });
  require_few();
  return found;
}

}  // namespace aeroloom::io
