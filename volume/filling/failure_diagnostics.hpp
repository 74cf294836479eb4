/// Diagnostics of zones that could not be filled, and the message the user gets.
#pragma once

#include "volume/filling/surface_check.hpp"
#include "volume/filling/zone_inputs.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/volume_failure.hpp"
#include "volume/volume_report.hpp"

#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// Why a zone was not filled.
struct ZoneFailure {
  ZoneIndex zone;
  std::string reason;

  static constexpr auto fields() { return std::tuple(&ZoneFailure::zone, &ZoneFailure::reason); }
};

/// Keeps what this rank's failing zones looked like.
class FailureDiagnostics {
public:
  /// Whether triangles are looked at for defects: takes a while, and a first failure may have lighter causes.
  enum class Look { later, for_defects };
  /// Refers to the surface.
  explicit FailureDiagnostics(const mesh::DistributedMesh& surface) : _surface(surface) {}
  /// A zone failed: its triangles are kept.
  void note(const ZoneInput& input, const std::string& reason, Look look);

  /// The failures of all ranks, by zone. Collective.
  std::vector<ZoneFailure> gather(const std::vector<ZoneFailure>& mine) const;

  /// The remedy belongs to the cause: a surface that meets itself cannot be helped by trying again. Throws
  /// VolumeFailure on every rank where a zone's triangles have a defect. Collective.
  void stop_at_defects() const;
  /// Throws VolumeFailure on every rank: no retry was left for this zone. Collective.
  [[noreturn]] void give_up(ZoneIndex zone, const std::vector<Retry>& tried) const;

private:
  struct Item {
    ZoneIndex zone = no_zone;
    bool has_defect = false;
    std::string message;
    std::vector<geometry::Vec3> points;
    std::vector<LocalTriangle> triangles;

    static constexpr auto fields() {
      return std::tuple(&Item::zone, &Item::has_defect, &Item::message, &Item::points, &Item::triangles);
    }
  };
  /// The item of the lowest zone among all ranks' chosen ones; zone is no_zone when there is none.
  Item lowest(const Item* mine) const;
  [[noreturn]] static void raise(const Item& item, const std::string& tried);

  const mesh::DistributedMesh& _surface;
  std::vector<Item> _items;
};

/// Throws VolumeFailure: names the triangles that intersect each other, where there are such, or else the
/// gap. Each rank gives the triangles near its blocks, in both forms. Collective.
[[noreturn]] void refuse_surface(const Contradiction& contradiction,
                                 std::span<const SurfaceTriangle> triangles, const NearSurface& near,
                                 const mesh::DistributedMesh& surface);

}  // namespace aeroloom::volume
