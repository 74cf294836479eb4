/// Remedies for zones that cannot be filled or do not fit together, and how often zones may be filled again.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "volume/filling/agreement.hpp"
#include "volume/filling/failure_diagnostics.hpp"
#include "volume/volume_options.hpp"
#include "volume/zones/shell.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::volume {

/// What a retry of a zone changes. Each retry also makes its halo wider.
struct RetryStep {
  const char* name;
  bool other_points;     ///< false: only this zone is filled again, and the mesh does not change
  std::uint8_t farther;  ///< see BlockChange
};
inline constexpr RetryStep retry_steps[] = {
    {"a wider halo", false, 0},
    {"a wider halo, other perturbations of its points", true, 0},
    {"a wider halo, points farther off the surface", true, 1},
};
inline constexpr double wider = 1.5;  // factor of the halo's width, for each retry

/// Limits how often zones are filled. With halos that are too narrow, zones disagree nearly everywhere, and
/// so do merged ones. Real aircraft need less than one further filling in all. The same on every rank.
class FillingBudget {
public:
  explicit FillingBudget(std::size_t zones) : _zones(zones) {}

  /// `zones` more zones are filled. Throws CollectiveError (input) above the limit.
  void spend(std::size_t zones, std::int64_t rounds, double halo) {
    constexpr std::size_t most_on_average = 10, few = 50;
    _again += zones;
    if (_again <= most_on_average * _zones + few) return;
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format("{} zones were filled {} times again in {} rounds, and their tetrahedra still do not fit "
                    "together: their halos are too narrow. Remedy: a wider "
                    "VolumeOptions::halo ({:g}), or larger pieces (VolumeOptions::piece_tets)",
                    _zones, _again, rounds, halo));
  }

private:
  std::size_t _zones, _again = 0;
};

/// Chooses the remedies, and applies them to the shell. The same on every rank. Refers to its arguments.
class RetryPolicy {
public:
  RetryPolicy(const VolumeOptions& options, const Lattice& lattice, Shell& shell, VolumeReport& report)
      : _communicator(lattice.tree.communicator()),
        _options(options),
        _lattice(lattice),
        _tree(lattice.tree),
        _shell(shell),
        _report(report),
        _changes_of(shell.zones.count(), 0),
        _merged(shell.zones.count(), 0),
        _is_gone(shell.zones.count(), 0) {}

  /// The number of retries of a zone since it was last merged.
  int changes_of(ZoneIndex zone) const { return _changes_of[zone]; }
  bool is_merged(ZoneIndex zone) const { return _merged[zone] != 0; }
  /// Whether the zone was merged into another one.
  bool is_gone(ZoneIndex zone) const { return _is_gone[zone] != 0; }
  /// The width of the halo of each zone, in sizes.
  std::vector<double> widths() const;

  /// Applies the next remedy to zones that failed, and demotes core leaves to the shell. Returns the zones to
  /// be filled again. `failures` and `demoted` are those of this rank. Throws VolumeFailure. Collective.
  std::vector<ZoneIndex> change_failed(const std::vector<ZoneFailure>& failures,
                                       const std::vector<DemotedLeaf>& demoted,
                                       const FailureDiagnostics& diagnostics);
  /// Where zones disagree, reassigns leaves to the lowest zone, and after several rounds merges the zones.
  /// Returns the zones to be filled again. `faces` are those of this rank's zones. Throws CollectiveError.
  /// Collective.
  std::vector<ZoneIndex> resolve_disputes(std::span<const ZoneFace> faces);

private:
  /// A leaf where zones disagree, or near such a leaf.
  struct LeafOfPlace;
  /// Own blocks and zones that a remedy changed. All zones with a halo there are filled again.
  struct Changed {
    std::vector<std::uint8_t> blocks;
    std::vector<ZoneIndex> zones;
  };
  Changed nothing() const;
  using BlockChanges = std::vector<BlockChange>;
  void demote(const std::vector<DemotedLeaf>& demoted, BlockChanges& changes, Changed& changed);
  bool escalate(const ZoneFailure& failure, const FailureDiagnostics& diagnostics, BlockChanges& changes,
                Changed& changed);
  void make_points(BlockChanges changes, Changed& changed);
  ZoneIndex widest_neighbour(ZoneIndex zone) const;
  void merge(ZoneIndex a, ZoneIndex b);
  void touch_all(ZoneIndex zone, Changed& changed) const;
  std::vector<ZoneIndex> zones_reached(Changed changed);
  std::vector<LeafOfPlace> leaves_around(std::span<const DisputedPlace> places, int rings) const;
  LeafNumber lowest_leaf(ZoneIndex zone) const;
  void note_places(std::span<const DisputedPlace> places);
  void reassign(std::span<const DisputedPlace> places, Changed& changed);
  void merge_around(std::span<const DisputedPlace> places, Changed& changed);

  const parallel::Communicator& _communicator;
  const VolumeOptions& _options;
  const Lattice& _lattice;
  const LatticeTree& _tree;
  Shell& _shell;
  VolumeReport& _report;
  std::vector<int> _changes_of;
  std::vector<std::uint8_t> _merged, _is_gone;
  int _rounds_of_reassignment = 0;
};

}  // namespace aeroloom::volume
