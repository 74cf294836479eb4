/// Diagnostics of zones that could not be filled, and the messages for the user.
#pragma once

#include "volume/filling/surface_check.hpp"
#include "volume/filling/zone_inputs.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/volume_failure.hpp"
#include "volume/volume_report.hpp"

#include <string>
#include <vector>

namespace aeroloom::volume {

/// Why a zone was not filled.
struct ZoneFailure {
  ZoneIndex zone;
  std::string reason;
};

/// Keeps the triangles of this rank's zones that failed.
class FailureDiagnostics {
public:
  /// Whether to search the triangles for defects. It is slow, and a first failure often has another cause.
  enum class Look { later, for_defects };
  /// Refers to the surface.
  explicit FailureDiagnostics(const mesh::DistributedMesh& surface) : _surface(surface) {}
  /// Notes that a zone failed.
  void note(const ZoneInput& input, const std::string& reason, Look look);

  /// The failures of all ranks, by zone. Collective.
  std::vector<ZoneFailure> gather(const std::vector<ZoneFailure>& mine) const;

  /// Throws VolumeFailure on every rank if the triangles of a zone on any rank have a defect: retries cannot
  /// mend a surface that intersects itself. Collective.
  void stop_at_defects() const;
  /// Throws VolumeFailure on every rank: no retry is left for this zone. Collective.
  [[noreturn]] void give_up(ZoneIndex zone, const std::vector<Retry>& tried) const;

private:
  struct Item {
    ZoneIndex zone = no_zone;
    bool has_defect = false;
    std::string message;
    std::vector<geometry::Vec3> points;
    std::vector<LocalTriangle> triangles;
  };
  /// The item with the lowest zone; each rank gives one or null. Its zone is no_zone if all are null.
  /// Collective.
  Item lowest(const Item* mine) const;
  [[noreturn]] static void raise(const Item& item, const std::string& tried);

  const mesh::DistributedMesh& _surface;
  std::vector<Item> _items;
};

/// Throws VolumeFailure on every rank. The message names triangles that intersect each other, or else the
/// gap. `triangles` and `near` are the triangles near this rank's blocks. Collective.
[[noreturn]] void refuse_surface(const Contradiction& contradiction,
                                 std::span<const SurfaceTriangle> triangles, const LocalSurface& near,
                                 const mesh::DistributedMesh& surface);

}  // namespace aeroloom::volume
