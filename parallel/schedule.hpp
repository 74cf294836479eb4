/// Assignment of tasks to ranks by predicted load.
#pragma once

#include "parallel/communicator.hpp"

#include <span>
#include <vector>

namespace aeroloom::parallel {

/// Largest load first, each to the rank with the least so far (Graham, SIAM J. Appl. Math. 17, 1969,
/// doi:10.1137/0117039); ties go to the lower task and the lower rank. Returns the rank of each task. The
/// same on every rank, without communication. Loads are any non-negative unit.
std::vector<Rank> assign_largest_first(std::span<const double> loads, int ranks);

/// The tasks of `rank` in the order it should run them: largest first.
std::vector<int> tasks_of_rank(std::span<const Rank> assignment, std::span<const double> loads, Rank rank);

}  // namespace aeroloom::parallel
