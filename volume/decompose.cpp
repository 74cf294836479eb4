#include "parallel/collective_error.hpp"
#include "volume/decomposition_parts.hpp"
#include "volume/failure.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::volume {

using parallel::ScopedCpu;

namespace {

/// The box of the surface, the same on every rank.
geometry::Box box_of(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface) {
  geometry::Box box;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) box.add(piece.point(v));
  }
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = communicator.minimum(box.low[axis]);
    box.high[axis] = communicator.maximum(box.high[axis]);
  }
  return box;
}

/// The surface near each rank's blocks.
void share_surface(const parallel::Communicator& communicator, const VolumeInput& input,
                   Decomposition::Parts& parts, parallel::StageClock& clock) {
  parts.table = tabulate_surface(communicator, *parts.frame, *parts.tree, input.surface, clock);
  parts.changes.assign(parts.tree->block_count(), {});
  parts.shares = share_blocks(*parts.tree, parts.table, communicator.size());
  const BlockIndex first = parts.shares[communicator.rank()], last = parts.shares[communicator.rank() + 1];
  std::vector<double> reach;
  if (communicator.size() > 1) {
    const ScopedCpu task(clock, ScopedCpu::As::task);
    for (BlockIndex b = first; b < last; ++b) reach.push_back(reach_of_block(parts.source(input), b));
  }
  parts.triangles = deliver_surface(communicator, *parts.frame, *parts.tree, parts.table, parts.shares, reach,
                                    input.surface, input.numbering, clock);
  const ScopedCpu task(clock, ScopedCpu::As::task);
  parts.surface = std::make_unique<NearSurface>(parts.triangles);
  parts.of_blocks =
      std::make_unique<TrianglesOfBlocks>(*parts.frame, *parts.tree, first, last, parts.triangles);
}

/// Zones of equal expected size.
void divide(const VolumeInput& input, Decomposition::Parts& parts, parallel::StageClock& clock) {
  const ScopedCpu repeated(clock, ScopedCpu::As::serial);
  const std::vector<double> loads = block_loads(parts.table, parts.counts);
  parts.report.expected_tetrahedra = std::accumulate(loads.begin(), loads.end(), 0.0);
  const ZoneIndex count = wanted_zones(parts.report.expected_tetrahedra, input.options.piece_tets);
  parts.zones = std::make_unique<Zones>(bisect(*parts.tree, loads, count));
  parts.expected.assign(count, 0);
  for (BlockIndex b = 0; b < parts.tree->block_count(); ++b)
    parts.expected[parts.zones->of(b, 0)] += loads[b];
  parts.report.zones = count;
}

/// What zones know, and who fills them.
void plan_all(const parallel::Communicator& communicator, const VolumeInput& input,
              Decomposition::Parts& parts, parallel::StageClock& clock) {
  std::vector<ZoneIndex> all(parts.zones->count());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<double> widths(all.size(), input.options.halo);
  parts.plan = plan_zones(communicator, parts.tables(), all, widths, clock);
  double work = 0, heaviest = 0;
  for (const ZoneLoad& load : parts.plan.loads) {
    work += load.work();
    heaviest = std::max(heaviest, load.work());
  }
  parts.report.imbalance = heaviest * static_cast<double>(all.size()) / std::max(1.0, work);
}

}  // namespace

Decomposition::Decomposition(std::unique_ptr<Parts> parts) : _parts(std::move(parts)) {}
Decomposition::Decomposition(Decomposition&&) noexcept = default;
Decomposition& Decomposition::operator=(Decomposition&&) noexcept = default;
Decomposition::~Decomposition() = default;

const DecompositionReport& Decomposition::report() const {
  return _parts->report;
}

void make_all_points(const parallel::Communicator& communicator, const VolumeInput& input,
                     Decomposition::Parts& parts, parallel::StageClock& clock) {
  const BlockIndex first = parts.shares[communicator.rank()], last = parts.shares[communicator.rank() + 1];
  std::vector<std::uint8_t> mine;
  parallel::agree(communicator, [&] {
    const ScopedCpu task(clock, ScopedCpu::As::task);
    parts.points = make_points(parts.source(input), first, last, *parts.surface);
    for (BlockIndex b = first; b < last; ++b)
      mine.push_back(static_cast<std::uint8_t>(parts.points.count(b)));
  });
  parts.counts = communicator.all_gather_items<std::uint8_t>(mine);
  parts.report.lattice_points = communicator.sum(static_cast<std::int64_t>(parts.points.points.size()));
}

Decomposition decompose(const parallel::Communicator& communicator, const VolumeInput& input,
                        parallel::StageClock& clock) {
  auto parts = std::make_unique<Decomposition::Parts>();
  const geometry::Box box = box_of(communicator, input.surface);
  parts->frame = std::make_unique<LatticeFrame>(input.field, box);
  parts->tree = std::make_unique<LatticeTree>(communicator, *parts->frame, input.field,
                                              parts->frame->grid_box(box), clock);
  parts->report.blocks = parts->tree->block_count();
  share_surface(communicator, input, *parts, clock);
  BlockRegions regions = find_block_regions(communicator, *parts->frame, *parts->tree, parts->table,
                                            parts->shares, parts->triangles, *parts->surface, clock);
  if (regions.contradiction)
    refuse_surface(communicator, *regions.contradiction, parts->triangles, *parts->surface, input.surface);
  parts->regions = std::move(regions.of_block);
  make_all_points(communicator, input, *parts, clock);
  divide(input, *parts, clock);
  plan_all(communicator, input, *parts, clock);
  return Decomposition(std::move(parts));
}

}  // namespace aeroloom::volume
