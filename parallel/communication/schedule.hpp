/// Assignment of tasks to ranks by predicted load.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <span>
#include <vector>

namespace aeroloom::parallel {

/// Assigns tasks in descending order of load, each to the rank with the smallest load so far (Graham, SIAM J.
/// Appl. Math. 17, 1969, doi:10.1137/0117039). Ties go to the lower task and the lower rank. Returns the rank
/// of each task. The same on every rank, without communication. Loads are in any non-negative unit.
std::vector<Rank> assign_largest_first(std::span<const double> loads, int ranks);

/// As above, for ranks that start with the loads `burdens`, one per rank.
std::vector<Rank> assign_largest_first(std::span<const double> loads, std::span<const double> burdens);

/// Assigns to each rank a run of consecutive tasks, so that neighbouring tasks stay together. Minimises the
/// largest load of a rank among such assignments; where that is one large task, also the largest load of the
/// other ranks. The same on every rank, without communication.
std::vector<Rank> assign_in_order(std::span<const double> loads, int ranks);

/// Moves tasks away from ranks whose load exceeds the mean. In descending order of load, each task stays on
/// its rank `now` unless that rank would exceed the mean; the others go by assign_largest_first. May be less
/// even than assign_largest_first for all. The same on every rank, without communication.
std::vector<Rank> move_excess(std::span<const double> loads, std::span<const Rank> now, int ranks);

/// Renumbers the ranks of an assignment so that much of the load stays where it is `now`. `shares` has the
/// assigned rank of each task. Pairs of assigned and present rank are matched greedily, largest common load
/// first; ties go to the lower ranks. The same on every rank, without communication.
std::vector<Rank> keep_in_place(std::span<const double> loads, std::span<const Rank> shares,
                                std::span<const Rank> now, int ranks);

/// The largest load of a rank.
double heaviest(std::span<const double> loads, std::span<const Rank> assignment, int ranks);

/// The ranks that shall work on tasks that lie on ranks `now`. Nothing moves if no rank has more than 1.05
/// times the mean, or if moving gains nothing. Else as move_excess() has it if that is even enough, else as
/// assign_largest_first() and keep_in_place(). The same on every rank, without communication.
std::vector<Rank> rebalance(std::span<const double> loads, std::span<const Rank> now, int ranks);

/// The tasks of `rank` in the order of their runs: largest load first.
std::vector<int> tasks_of_rank(std::span<const Rank> assignment, std::span<const double> loads, Rank rank);

/// The batch of each task, if every rank runs `at_a_time` tasks per batch in the order of tasks_of_rank().
std::vector<int> batches_of_tasks(std::span<const Rank> assignment, std::span<const double> loads,
                                  int at_a_time);

}  // namespace aeroloom::parallel
