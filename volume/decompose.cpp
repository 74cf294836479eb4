#include "mesh/data/bounds.hpp"
#include "mesh/transfer/piece_size.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/filling/decomposition_data.hpp"
#include "volume/filling/failure_diagnostics.hpp"
#include "volume/filling/retry_policy.hpp"
#include "volume/lattice/block_regions.hpp"
#include "volume/zones/halo.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

namespace aeroloom::volume {

using parallel::ScopedCpu;

namespace {

/// Drops the triangles that meet no block of this rank. They are needed until regions are known.
void keep_own_triangles(const Lattice& lattice, std::vector<SurfaceTriangle>& triangles) {
  std::erase_if(triangles, [&](const SurfaceTriangle& triangle) {
    return !lattice.tree.any_own_block_in(grid_box(lattice.frame, triangle.points),
                                          [](BlockIndex) { return true; });
  });
  triangles.shrink_to_fit();
}

/// The lattice, and the triangles near this rank's blocks for the first points.
struct NewLattice {
  std::unique_ptr<const Lattice> lattice;
  std::unique_ptr<const LocalSurface> surface;
};

NewLattice make_lattice(const VolumeInput& input) {
  const bool is_alone = input.surface.communicator.size() == 1;
  auto lattice = std::make_unique<Lattice>(grow_lattice(input, mesh::box_of(input.surface)));
  // One rank has the whole surface. The search radii do not change the regions: any triangle gives the same.
  if (!is_alone) {
    const ScopedCpu task(ScopedCpu::As::task);
    lattice->radii = search_radii_of_blocks(*lattice, lattice->tree.first(), lattice->tree.last());
  }
  std::vector<SurfaceTriangle> near =
      add_ghost_triangles(lattice->frame, lattice->tree, lattice->radii, std::move(lattice->triangles));
  std::unique_ptr<const LocalSurface> surface;
  {
    const ScopedCpu task(ScopedCpu::As::task);
    surface = std::make_unique<LocalSurface>(near);
  }
  BlockRegions regions = find_block_regions(*lattice, near, *surface);
  if (regions.contradiction) refuse_surface(*regions.contradiction, near, *surface, input.surface);
  lattice->regions = std::move(regions.of_block);
  const ScopedCpu task(ScopedCpu::As::task);
  if (!is_alone) keep_own_triangles(*lattice, near);
  lattice->triangles = std::move(near);
  return {std::move(lattice), std::move(surface)};
}

/// The loads of this rank's blocks.
std::vector<Load> loads_of_blocks(const Lattice& lattice, const LocalShell& shell) {
  std::vector<Load> loads;
  for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last(); ++b)
    loads.push_back(load_of(shell.points.count(b), lattice.table.triangles[b - lattice.tree.first()],
                            static_cast<std::int64_t>(shell.borders.of(b).size())));
  return loads;
}

/// The wanted number of tetrahedra of a piece.
std::int64_t piece_tets_of(double tetrahedra, const VolumeOptions& options) {
  return options.piece_tets.value_or(partition::suitable_piece_tets(tetrahedra));
}

/// Planes between zones of equal load.
ZoneCuts cut_zones(const Lattice& lattice, std::span<const Load> loads, const VolumeOptions& options) {
  const Load all = lattice.tree.communicator().sum(std::accumulate(loads.begin(), loads.end(), Load{0}));
  const double tetrahedra = tetrahedra_of(all);
  const ZoneIndex count = wanted_zones(tetrahedra, piece_tets_of(tetrahedra, options));
  const std::vector<CoarseCell> cells =
      coarsen(lattice.tree, loads, all / (ZoneCuts::cells_per_zone * count));
  const ScopedCpu repeated(ScopedCpu::As::repeated);
  return {cells, count};
}

/// The width of halos after all retries.
double widest_halo(const VolumeOptions& options) {
  return options.halo * std::pow(wider, std::min<int>(options.retries, std::size(retry_steps)));
}

/// Of shell and core. All are multiples of 1/8, so the sum is exact. Collective.
double expected_tetrahedra(const Lattice& lattice, const Shell& shell) {
  return std::accumulate(shell.expected.begin(), shell.expected.end(),
                         static_cast<double>(lattice.tree.communicator().sum(shell.local.core_cells())));
}

Shell make_shell(const Lattice& lattice, std::unique_ptr<const LocalSurface> surface,
                 const VolumeOptions& options) {
  LocalShell local =
      make_local_shell(lattice, std::move(surface), std::vector<BlockChange>(lattice.tree.block_count()));
  const std::vector<Load> loads = loads_of_blocks(lattice, local);
  ZoneCuts cuts = cut_zones(lattice, loads, options);
  std::vector<GridCube> ghosts = fetch_cut_ghosts(lattice, cuts, widest_halo(options));
  Shell shell{std::move(local), Zones(lattice.tree, std::move(cuts), std::move(ghosts)), {}};
  std::vector<Load> of_zones(shell.zones.count(), 0);
  for (BlockIndex b = lattice.tree.first(); b < lattice.tree.last(); ++b)
    of_zones[shell.zones.of(b, 0)] += loads[b - lattice.tree.first()];
  for (const Load load : shell.zones.sum(std::move(of_zones))) shell.expected.push_back(tetrahedra_of(load));
  shell.core_piece_tets = piece_tets_of(expected_tetrahedra(lattice, shell), options);
  return shell;
}

/// The plan of the first filling.
ZonePlan plan_all_zones(const Lattice& lattice, const Shell& shell, double halo) {
  std::vector<ZoneIndex> all(shell.zones.count());
  std::iota(all.begin(), all.end(), 0);
  return plan_zones(lattice, shell, all, std::vector<double>(all.size(), halo));
}

DecompositionReport report_of(const Lattice& lattice, const Shell& shell, const ZonePlan& plan) {
  const parallel::Communicator& communicator = lattice.tree.communicator();
  DecompositionReport report;
  report.blocks = lattice.tree.total();
  report.lattice_points = communicator.sum(shell.local.lattice_points);
  report.shell_points = communicator.sum(static_cast<std::int64_t>(shell.local.points.points.size()));
  report.core_tetrahedra = communicator.sum(shell.local.core_cells());
  report.expected_tetrahedra = expected_tetrahedra(lattice, shell);
  report.zones = shell.zones.count();
  double work = 0, heaviest = 0;
  for (const ZoneLoad& load : plan.loads) {
    work += load.work();
    heaviest = std::max(heaviest, load.work());
  }
  report.imbalance = heaviest * static_cast<double>(report.zones) / std::max(1.0, work);
  return report;
}

}  // namespace

Decomposition::Decomposition(std::unique_ptr<Data> data) : _data(std::move(data)) {}
Decomposition::Decomposition(Decomposition&&) noexcept = default;
Decomposition& Decomposition::operator=(Decomposition&&) noexcept = default;
Decomposition::~Decomposition() = default;

const DecompositionReport& Decomposition::report() const {
  return _data->report;
}

Decomposition decompose(const VolumeInput& input) {
  auto [lattice, surface] = make_lattice(input);
  Shell shell = make_shell(*lattice, std::move(surface), input.options);
  ZonePlan plan = plan_all_zones(*lattice, shell, input.options.halo);
  const DecompositionReport report = report_of(*lattice, shell, plan);
  return Decomposition(std::make_unique<Decomposition::Data>(
      Decomposition::Data{std::move(lattice), std::move(shell), std::move(plan), report}));
}

}  // namespace aeroloom::volume
