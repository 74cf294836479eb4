/// What retries do with zones that cannot be filled, and how often zones may be filled again.
#pragma once

#include "parallel/communication/collective_error.hpp"

#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace aeroloom::volume {

/// What a retry does differently to get a stubborn zone filled. Each makes its halo wider.
struct RetryStep {
  const char* name;
  bool other_points;     ///< or only this zone is filled again, and the mesh stays what it was to be
  std::uint8_t farther;  ///< see BlockChange
};
inline constexpr RetryStep retry_steps[] = {
    {"a wider halo", false, 0},
    {"a wider halo, other perturbations of its points", true, 0},
    {"a wider halo, points farther off the surface", true, 1},
};
inline constexpr double wider = 1.5;  // the halo, each time

/// Zones that know too little of their neighbours disagree nearly everywhere, and so do those that are made
/// of them. A real aircraft takes less than one filling again in all. The same on every rank.
class FillingBudget {
public:
  explicit FillingBudget(std::size_t zones) : _zones(zones) {}

  /// Throws CollectiveError (input) where this is more than there is.
  void spend(std::size_t zones, std::int64_t rounds, double halo) {
    constexpr std::size_t most_on_average = 10, few = 50;
    _again += zones;
    if (_again <= most_on_average * _zones + few) return;
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format("{} zones were filled {} times again in {} rounds, and their tetrahedra still do not fit "
                    "together: what they know of each other is too little. Remedy: a wider "
                    "VolumeOptions::halo ({:g}), or larger pieces (VolumeOptions::piece_tets)",
                    _zones, _again, rounds, halo));
  }

private:
  std::size_t _zones, _again = 0;
};

}  // namespace aeroloom::volume
