#include "mesh/transfer/piece_size.hpp"
#include "parallel/communication/collective_error.hpp"
#include "volume/filling/decomposition_data.hpp"
#include "volume/filling/evidence.hpp"
#include "volume/filling/filling_limits.hpp"
#include "volume/lattice/neighbourhood.hpp"
#include "volume/zones/cut_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

namespace aeroloom::volume {

using parallel::ScopedCpu;

namespace {

/// The box of the surface, the same on every rank.
geometry::Box box_of(const mesh::DistributedMesh& surface) {
  const parallel::Communicator& communicator = surface.communicator;
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

/// The finest cubes that hold the centres of this rank's triangles.
std::vector<std::uint64_t> keys_of(const LatticeFrame& frame, const mesh::DistributedMesh& surface) {
  std::vector<std::uint64_t> keys;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const geometry::Vec3 centre = (1.0 / 3.0) * (piece.point(v[0]) + piece.point(v[1]) + piece.point(v[2]));
      keys.push_back(sizing::morton_key(frame.cell_at(frame.to_grid(centre))));
    }
  }
  return keys;
}

/// The surface near each rank's blocks.
void fetch_surface(const VolumeInput& input, Decomposition::Data& data) {
  const parallel::Communicator& communicator = input.surface.communicator;
  data.triangles = deliver_surface(*data.frame, *data.tree, input.surface, input.numbering);
  {
    const ScopedCpu task(ScopedCpu::As::task);
    data.table = tabulate_surface(*data.frame, *data.tree, data.triangles);
  }
  learn_what_touches(communicator, data.known(), data.triangles);
  data.changes.assign(data.tree->block_count(), {});
  learn_what_is_far_finer(communicator, data.known(), data.source(input));
  data.changes.assign(data.tree->block_count(), {});
  // One rank has the whole surface at hand. Which triangles are looked at decides no region: any of them that
  // is seen first tells the same.
  if (communicator.size() > 1) {
    const ScopedCpu task(ScopedCpu::As::task);
    data.radii = search_radii_of_blocks(data.source(input), data.tree->first(), data.tree->last());
  }
  data.triangles =
      add_those_near(communicator, *data.frame, *data.tree, data.radii, std::move(data.triangles));
  const ScopedCpu task(ScopedCpu::As::task);
  data.surface = std::make_unique<NearSurface>(data.triangles);
}

/// Once there are points, the triangles that do not meet this rank's blocks have served.
void keep_own_triangles(const parallel::Communicator& communicator, Decomposition::Data& data) {
  const ScopedCpu task(ScopedCpu::As::task);
  std::vector<SurfaceTriangle> own;
  if (communicator.size() > 1) {
    for (const SurfaceTriangle& triangle : data.triangles) {
      if (data.tree->any_own_block_in(grid_box(*data.frame, triangle.points),
                                      [](BlockIndex) { return true; }))
        own.push_back(triangle);
    }
    own.shrink_to_fit();
    data.triangles = std::move(own);
  }
}

/// Zones of equal expected size.
void divide(const VolumeInput& input, Decomposition::Data& data) {
  const parallel::Communicator& communicator = input.surface.communicator;
  const ShellShare& shell = data.shell;
  std::vector<Load> loads;
  for (BlockIndex b = data.tree->first(); b < data.tree->last(); ++b)
    loads.push_back(load_of(shell.points.count(b), data.table.triangles[b],
                            static_cast<std::int64_t>(shell.borders.of(b).size())));
  const Load all = communicator.sum(std::accumulate(loads.begin(), loads.end(), Load{0}));
  data.report.expected_tetrahedra = tetrahedra_of(all) + static_cast<double>(data.report.core_tetrahedra);
  const auto suitable = [&](double tetrahedra) {
    return input.options.piece_tets.value_or(partition::suitable_piece_tets(tetrahedra));
  };
  data.core_piece_tets = suitable(data.report.expected_tetrahedra);
  const ZoneIndex count = wanted_zones(tetrahedra_of(all), suitable(tetrahedra_of(all)));
  const std::vector<CoarseCell> cells =
      coarsen(communicator, *data.tree, loads, all / (ZoneCuts::cells_per_zone * count));
  std::optional<ZoneCuts> cuts;
  {
    const ScopedCpu repeated(ScopedCpu::As::repeated);
    cuts.emplace(cells, count);
  }
  const double widest =
      input.options.halo * std::pow(wider, std::min<int>(input.options.retries, std::size(ladder)));
  learn_what_is_cut(communicator, data.known(), *cuts, widest);
  data.changes.assign(data.tree->block_count(), {});
  data.shell.points.first = data.shell.borders.first = data.tree->first();
  data.core->follow(*data.tree);
  data.zones = std::make_unique<Zones>(*data.tree, std::move(*cuts));
  data.report.zones = count;
  std::vector<Load> of_zones(count, 0);
  for (BlockIndex b = data.tree->first(); b < data.tree->last(); ++b)
    of_zones[data.zones->of(b, 0)] += loads[b - data.tree->first()];
  for (const Load load : sum_by_zone(communicator, std::move(of_zones)))
    data.expected.push_back(tetrahedra_of(load));
}

/// Decides what zones know, and who fills them.
void plan_all(const VolumeInput& input, Decomposition::Data& data) {
  const parallel::Communicator& communicator = input.surface.communicator;
  std::vector<ZoneIndex> all(data.zones->count());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<double> widths(all.size(), input.options.halo);
  data.plan = plan_zones(communicator, data.store(input), all, widths);
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

std::vector<BlockIndex> make_all_points(const VolumeInput& input, Decomposition::Data& data) {
  const parallel::Communicator& communicator = input.surface.communicator;
  const BlockIndex first = data.tree->first(), last = data.tree->last();
  BlockPoints points;
  std::vector<SurfaceTriangle> again;
  if (!data.surface)
    again = add_those_near(communicator, *data.frame, *data.tree, data.radii, data.triangles);
  parallel::agree(communicator, [&] {
    const ScopedCpu task(ScopedCpu::As::task);
    if (!data.surface) data.surface = std::make_unique<NearSurface>(again);
    points = make_points(data.source(input), first, last, *data.surface, data.radii);
    data.surface.reset();
  });
  data.report.lattice_points = communicator.sum(static_cast<std::int64_t>(points.points.size()));
  const std::unique_ptr<CoreLeaves> before =
      std::exchange(data.core, std::make_unique<CoreLeaves>(communicator, data.source(input), points));
  std::vector<BlockIndex> changed;
  {
    const ScopedCpu task(ScopedCpu::As::task);
    data.shell = find_shell(*data.tree, *data.core, *data.squares, std::move(points));
    for (BlockIndex b = first; b < last; ++b) {
      if (before && before->of(b) != data.core->of(b)) changed.push_back(b);
    }
  }
  data.report.shell_points = communicator.sum(static_cast<std::int64_t>(data.shell.points.points.size()));
  data.report.core_tetrahedra = communicator.sum(data.shell.core_cells());
  return changed;
}

Decomposition decompose(const VolumeInput& input) {
  const parallel::Communicator& communicator = input.surface.communicator;
  auto data = std::make_unique<Decomposition::Data>();
  const geometry::Box box = box_of(input.surface);
  data->frame = std::make_unique<LatticeFrame>(input.field, box);
  data->tree = std::make_unique<LatticeTree>(communicator, *data->frame, input.field, box,
                                             keys_of(*data->frame, input.surface));
  data->squares = std::make_unique<CoreSquares>(*data->frame);
  data->report.blocks = data->tree->total();
  fetch_surface(input, *data);
  BlockRegions regions =
      find_block_regions(communicator, data->known(), {data->triangles, *data->surface, data->radii});
  if (regions.contradiction)
    refuse_surface(*regions.contradiction, data->triangles, *data->surface, input.surface);
  data->regions = std::move(regions.of_block);
  make_all_points(input, *data);
  keep_own_triangles(communicator, *data);
  divide(input, *data);
  plan_all(input, *data);
  return Decomposition(std::move(data));
}

}  // namespace aeroloom::volume
