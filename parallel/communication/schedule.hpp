/// Assignment of tasks to ranks by predicted load.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <span>
#include <vector>

namespace aeroloom::parallel {

/// Largest load first, each to the rank with the least so far (Graham, SIAM J. Appl. Math. 17, 1969,
/// doi:10.1137/0117039); ties go to the lower task and the lower rank. Returns the rank of each task. The
/// same on every rank, without communication. Loads are any non-negative unit.
std::vector<Rank> assign_largest_first(std::span<const double> loads, int ranks);

/// Assigns tasks to ranks that have something already: `burdens`, one for each.
std::vector<Rank> assign_largest_first(std::span<const double> loads, std::span<const double> burdens);

/// Runs of tasks in their order, one for each rank, so that neighbours in that order stay together: the
/// largest load of a rank is the least that runs allow. The same on every rank, without communication.
std::vector<Rank> assign_in_order(std::span<const double> loads, int ranks);

/// Moves tasks from where they are `now` only where that rank would get more than the mean: largest load
/// first they stay or are taken away, then assign_largest_first gives those taken away to ranks with the
/// rest. May be less even than assign_largest_first. The same on every rank, without communication.
std::vector<Rank> move_excess(std::span<const double> loads, std::span<const Rank> now, int ranks);

/// The shares of an assignment, each as a whole on another rank, so that much of the load stays where it is
/// `now`: what a share and a rank have in common decides, the most first; ties go to the lower share and the
/// lower rank. The same on every rank, without communication.
std::vector<Rank> keep_in_place(std::span<const double> loads, std::span<const Rank> shares,
                                std::span<const Rank> now, int ranks);

/// The largest sum over ranks of the loads each one has.
double heaviest(std::span<const double> loads, std::span<const Rank> assignment, int ranks);

/// Where tasks that lie on ranks are to be worked on: where they are while no rank has more than 1.05 times
/// the mean, or nothing would be gained; else few move where that makes the work even enough, and as few as
/// go with the most even assignment where it does not. The same on every rank, without communication.
std::vector<Rank> rebalance(std::span<const double> loads, std::span<const Rank> now, int ranks);

/// The tasks of `rank` in the order it should run them: largest first.
std::vector<int> tasks_of_rank(std::span<const Rank> assignment, std::span<const double> loads, Rank rank);

/// The batch of each task where every rank runs its tasks as tasks_of_rank() has them, so many at a time.
std::vector<int> batches_of_tasks(std::span<const Rank> assignment, std::span<const double> loads,
                                  int at_a_time);

}  // namespace aeroloom::parallel
