#include "parallel/collective_error.hpp"
#include "partition/piece_size.hpp"
#include "volume/decomposition_data.hpp"
#include "volume/evidence.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

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

/// The triangles that matter to the blocks of each rank.
std::vector<SurfaceTriangle> gather_triangles(const parallel::Communicator& communicator,
                                              const VolumeInput& input, Decomposition::Data& data,
                                              parallel::StageClock& clock) {
  if (communicator.size() > 1) {
    const ScopedCpu task(clock, ScopedCpu::As::task);
    data.reach = reach_of_blocks(data.source(input), data.shares[communicator.rank()],
                                 data.shares[communicator.rank() + 1]);
  }
  return deliver_surface(communicator, *data.frame, *data.tree, data.table, data.shares, data.reach,
                         input.surface, input.numbering, clock);
}

/// The surface near each rank's blocks.
void share_surface(const parallel::Communicator& communicator, const VolumeInput& input,
                   Decomposition::Data& data, parallel::StageClock& clock) {
  data.table = tabulate_surface(communicator, *data.frame, *data.tree, input.surface, clock);
  data.changes.assign(data.tree->block_count(), {});
  data.shares = share_blocks(*data.tree, data.table, communicator.size());
  data.triangles = gather_triangles(communicator, input, data, clock);
  const ScopedCpu task(clock, ScopedCpu::As::task);
  data.surface = std::make_unique<NearSurface>(data.triangles);
}

/// Once there are points, the triangles that do not meet this rank's blocks have served.
void keep_own_triangles(const parallel::Communicator& communicator, Decomposition::Data& data,
                        parallel::StageClock& clock) {
  const ScopedCpu task(clock, ScopedCpu::As::task);
  const BlockIndex first = data.shares[communicator.rank()], last = data.shares[communicator.rank() + 1];
  std::vector<SurfaceTriangle> own;
  if (communicator.size() > 1) {
    for (const SurfaceTriangle& triangle : data.triangles) {
      if (data.tree->any_block_in(grid_box(*data.frame, triangle.points),
                                  [&](BlockIndex b) { return b >= first && b < last; }))
        own.push_back(triangle);
    }
    own.shrink_to_fit();
    data.triangles = std::move(own);
  }
}

/// Zones of equal expected size.
void divide(const VolumeInput& input, Decomposition::Data& data, parallel::StageClock& clock) {
  const ScopedCpu repeated(clock, ScopedCpu::As::serial);
  const std::vector<double> loads = block_loads(data.table, data.counts, data.borders);
  const double of_shell = std::accumulate(loads.begin(), loads.end(), 0.0);
  data.report.expected_tetrahedra = of_shell + static_cast<double>(data.report.core_tetrahedra);
  const auto suitable = [&](double tetrahedra) {
    return input.options.piece_tets.value_or(partition::suitable_piece_tets(tetrahedra));
  };
  data.core_piece_tets = suitable(data.report.expected_tetrahedra);
  const ZoneIndex count = wanted_zones(of_shell, suitable(of_shell));
  data.zones = std::make_unique<Zones>(bisect(*data.tree, loads, count));
  data.expected.assign(count, 0);
  for (BlockIndex b = 0; b < data.tree->block_count(); ++b) data.expected[data.zones->of(b, 0)] += loads[b];
  data.report.zones = count;
}

/// What zones know, and who fills them.
void plan_all(const parallel::Communicator& communicator, const VolumeInput& input, Decomposition::Data& data,
              parallel::StageClock& clock) {
  std::vector<ZoneIndex> all(data.zones->count());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<double> widths(all.size(), input.options.halo);
  data.plan = plan_zones(communicator, data.store(input), all, widths, clock);
  double work = 0, heaviest = 0;
  for (const ZoneLoad& load : data.plan.loads) {
    work += load.work();
    heaviest = std::max(heaviest, load.work());
  }
  data.report.imbalance = heaviest * static_cast<double>(all.size()) / std::max(1.0, work);
}

}  // namespace

Decomposition::Decomposition(std::unique_ptr<Data> data) : _data(std::move(data)) {}
Decomposition::Decomposition(Decomposition&&) noexcept = default;
Decomposition& Decomposition::operator=(Decomposition&&) noexcept = default;
Decomposition::~Decomposition() = default;

const DecompositionReport& Decomposition::report() const {
  return _data->report;
}

std::vector<BlockIndex> make_all_points(const parallel::Communicator& communicator, const VolumeInput& input,
                                        Decomposition::Data& data, parallel::StageClock& clock) {
  const BlockIndex first = data.shares[communicator.rank()], last = data.shares[communicator.rank() + 1];
  BlockPoints points;
  std::vector<SurfaceTriangle> again;
  if (!data.surface) again = gather_triangles(communicator, input, data, clock);
  parallel::agree(communicator, [&] {
    const ScopedCpu task(clock, ScopedCpu::As::task);
    if (!data.surface) data.surface = std::make_unique<NearSurface>(again);
    points = make_points(data.source(input), first, last, *data.surface, data.reach);
    data.surface.reset();
  });
  data.report.lattice_points = communicator.sum(static_cast<std::int64_t>(points.points.size()));
  const std::unique_ptr<const CoreLeaves> before = std::exchange(
      data.core, std::make_unique<CoreLeaves>(communicator, data.source(input), data.shares, points, clock));
  std::vector<std::uint8_t> counts, borders;
  std::vector<BlockIndex> changed;
  {
    const ScopedCpu task(clock, ScopedCpu::As::task);
    data.shell = find_shell(*data.tree, *data.core, *data.squares, std::move(points));
    for (BlockIndex b = first; b < last; ++b) {
      counts.push_back(static_cast<std::uint8_t>(data.shell.points.count(b)));
      borders.push_back(
          static_cast<std::uint8_t>(std::min<std::size_t>(data.shell.borders.of(b).size(), 255)));
      if (before && before->of(b) != data.core->of(b)) changed.push_back(b);
    }
  }
  data.counts = communicator.all_gather_items<std::uint8_t>(counts);
  data.borders = communicator.all_gather_items<std::uint8_t>(borders);
  data.report.shell_points = communicator.sum(static_cast<std::int64_t>(data.shell.points.points.size()));
  data.report.core_tetrahedra = communicator.sum(data.shell.core_cells());
  return changed;
}

Decomposition decompose(const parallel::Communicator& communicator, const VolumeInput& input,
                        parallel::StageClock& clock) {
  auto data = std::make_unique<Decomposition::Data>();
  const geometry::Box box = box_of(communicator, input.surface);
  data->frame = std::make_unique<LatticeFrame>(input.field, box);
  data->tree = std::make_unique<LatticeTree>(communicator, *data->frame, input.field, box, clock);
  data->squares = std::make_unique<CoreSquares>(*data->frame);
  data->report.blocks = data->tree->block_count();
  share_surface(communicator, input, *data, clock);
  BlockRegions regions =
      find_block_regions(communicator, *data->frame, *data->tree, data->table, data->shares, data->triangles,
                         *data->surface, data->reach, clock);
  if (regions.contradiction)
    refuse_surface(communicator, *regions.contradiction, data->triangles, *data->surface, input.surface);
  data->regions = std::move(regions.of_block);
  make_all_points(communicator, input, *data, clock);
  keep_own_triangles(communicator, *data, clock);
  divide(input, *data, clock);
  plan_all(communicator, input, *data, clock);
  return Decomposition(std::move(data));
}

}  // namespace aeroloom::volume
