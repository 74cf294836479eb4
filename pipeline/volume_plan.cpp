#include "pipeline/volume_plan.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "partition/decompose_volume.hpp"
#include "pipeline/region_background.hpp"
#include "pipeline/surface_rims.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::RegionId;

/// Background tetrahedra a part has, about.
constexpr double tets_per_part = 600;
/// Width of a background element in local sizes, at least: finer ones would have nothing to simplify.
constexpr double smallest_width = 3;
constexpr int most_rounds = 24;
/// Regions of less than this many wanted parts stay whole.
constexpr double whole_below = 1.5;

/// Collects the interfaces of all regions.
class PlanBuilder {
public:
  PlanBuilder(const partition::CoarseSurface& coarse, const std::vector<partition::Cell>& cells)
      : _coarse(coarse), _chords(coarse) {
    _plan.part_of_cell.assign(cells.size(), {-1, -1});
    _plan.report.cells = static_cast<std::int64_t>(cells.size());
    _plan.report.coarse_triangles = static_cast<std::int64_t>(coarse.triangles.size());
  }

  const ChordIndex& chords() const { return _chords; }

  /// A region that stays whole.
  void add_whole(RegionId region, double load, const std::vector<partition::Cell>& cells,
                 const mesh::DistributedMesh& surface) {
    for (const partition::Cell& cell : cells) {
      const mesh::FaceSides sides = surface.sides_of(cell.face);
      if (sides.front == region) _plan.part_of_cell[cell.id][0] = _plan.parts;
      if (sides.back == region) _plan.part_of_cell[cell.id][1] = _plan.parts;
    }
    _plan.region_of.push_back(region);
    _plan.loads.push_back(load);
    ++_plan.parts;
  }

  void add(RegionId region, const RegionBackground& background, const partition::VolumeDecomposition& parts,
           const std::vector<partition::Cell>& cells, const mesh::DistributedMesh& surface) {
    const std::int32_t first = _plan.parts;
    _plan.parts += parts.parts;
    _plan.region_of.resize(_plan.parts, region);
    _plan.loads.resize(_plan.parts, 0);
    for (std::size_t t = 0; t < parts.part.size(); ++t)
      _plan.loads[first + parts.part[t]] += background.volume.loads[t];
    for (const BoundaryFace& face : background.boundary) {
      const mesh::FaceSides sides = surface.sides_of(cells[face.cell].face);
      _plan.part_of_cell[face.cell][sides.front == region ? 0 : 1] = first + parts.part[face.tet];
    }
    add_faces(region, background, parts.part, first);
    VolumePlanReport& report = _plan.report;
    report.background_tets += static_cast<std::int64_t>(parts.part.size());
    report.clusters += parts.clusters;
    report.largest_cluster = std::max(report.largest_cluster, parts.largest_cluster);
    report.unresolved += parts.unresolved;
    report.moves += parts.moves;
    report.pinches += parts.pinches;
  }

  VolumePlan take() {
    number_edges();
    return std::move(_plan);
  }

private:
  void add_faces(RegionId region, const RegionBackground& background, const std::vector<std::int32_t>& part,
                 std::int32_t first) {
    const partition::BackgroundVolume& volume = background.volume;
    std::vector<std::int32_t> number(volume.points.size(), -1);
    for (std::size_t t = 0; t < volume.tets.size(); ++t) {
      for (int k = 0; k < 4; ++k) {
        const std::int32_t n = volume.neighbours[t][k];
        if (n < 0 || part[t] >= part[n]) continue;
        InterfaceFace face{{}, {}, first + part[t], first + part[n]};
        for (int i = 0; i < 3; ++i) {
          const std::int32_t v = volume.tets[t][mesh::tetrahedron_faces[k][i]];
          if (number[v] < 0) {
            number[v] = static_cast<std::int32_t>(_plan.vertices.size());
            const std::int32_t c = background.coarse_vertex[v];
            _coarse_vertex.push_back(c);
            _plan.vertices.push_back(c < 0 ? BoundaryPoint{-1, volume.points[v], 3, region}
                                           : _coarse.vertices[c]);
          }
          face.vertices[i] = number[v];
        }
        _plan.faces.push_back(face);
      }
    }
  }

  void number_edges() {
    std::vector<std::array<std::int32_t, 2>> edges;
    for (const InterfaceFace& face : _plan.faces) {
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(face.vertices[k], face.vertices[(k + 1) % 3]);
        edges.push_back({low, high});
      }
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    for (InterfaceFace& face : _plan.faces) {
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(face.vertices[k], face.vertices[(k + 1) % 3]);
        face.edges[k] = static_cast<std::int32_t>(
            std::lower_bound(edges.begin(), edges.end(), std::array<std::int32_t, 2>{low, high}) -
            edges.begin());
      }
    }
    for (const auto& [from, to] : edges) {
      const auto start = static_cast<std::int32_t>(_plan.path.size());
      const std::int32_t a = _coarse_vertex[from], b = _coarse_vertex[to];
      const std::int32_t chord = a < 0 || b < 0 ? -1 : _chords.find(a, b);
      if (chord >= 0) append_path(_coarse.chords[chord], a);
      _plan.edges.push_back({from, to, start, static_cast<std::int32_t>(_plan.path.size())});
    }
  }

  void append_path(const partition::Chord& chord, std::int32_t start) {
    const auto add_vertex = [&](std::int32_t v) { _plan.path.push_back(_coarse.rim[v]); };
    if (chord.from == start) {
      std::for_each(chord.path.begin(), chord.path.end(), add_vertex);
    } else {
      std::for_each(chord.path.rbegin(), chord.path.rend(), add_vertex);
    }
  }

  const partition::CoarseSurface& _coarse;
  ChordIndex _chords;
  VolumePlan _plan;
  std::vector<std::int32_t> _coarse_vertex;  // per vertex of the plan, -1 inside
};

parallel::Bytes pack(const VolumePlan& plan) {
  parallel::Packer packer;
  packer.value(plan.parts);
  packer.array(plan.region_of);
  packer.array(plan.loads);
  packer.array(plan.part_of_cell);
  packer.array(plan.vertices);
  packer.array(plan.edges);
  packer.array(plan.faces);
  packer.array(plan.path);
  packer.value(plan.report);
  return packer.take();
}

VolumePlan unpack_plan(const parallel::Bytes& bytes) {
  parallel::Unpacker unpacker(bytes);
  VolumePlan plan;
  plan.parts = unpacker.value<std::int32_t>();
  plan.region_of = unpacker.array<RegionId>();
  plan.loads = unpacker.array<double>();
  plan.part_of_cell = unpacker.array<std::array<std::int32_t, 2>>();
  plan.vertices = unpacker.array<BoundaryPoint>();
  plan.edges = unpacker.array<InterfaceEdge>();
  plan.faces = unpacker.array<InterfaceFace>();
  plan.path = unpacker.array<BoundaryPoint>();
  plan.report = unpacker.value<VolumePlanReport>();
  return plan;
}

/// The coarse surface of one round: either what is wrong with it or its filled regions.
struct Round {
  std::vector<std::int32_t> unfit;  ///< cells to halve, ascending
  std::optional<VolumePlan> plan;
};

void sort_and_unite(std::vector<std::int32_t>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

/// On rank 0: coarse surface, background, decomposition.
Round try_round(SurfaceCells::Rims rims, const mesh::DistributedMesh& surface, const sizing::SizeField& field,
                const VolumePlanOptions& options, double width, parallel::StageClock& clock) {
  Round round;
  const partition::CoarseSurface coarse =
      partition::build_coarse_surface(std::move(rims.edges), std::move(rims.vertices), rims.cells);
  std::vector<RegionSurface> regions;
  round.unfit = coarse.unfit;
  if (round.unfit.empty()) {
    for (RegionId r = 0; r < surface.region_count(); ++r) {
      regions.push_back(surface_of(coarse, rims.cells, surface, r));
      for (const std::int32_t cell : cells_to_cut(regions.back())) round.unfit.push_back(cell);
    }
  }
  sort_and_unite(round.unfit);
  if (!round.unfit.empty()) return round;
  PlanBuilder builder(coarse, rims.cells);
  for (RegionId r = 0; r < surface.region_count(); ++r) {
    RegionBackground background;
    try {
      background = fill_background(regions[r], coarse, builder.chords(), field, width, clock);
    } catch (const volume::VolumeError& error) {
      for (const std::int32_t t : error.triangles()) round.unfit.push_back(regions[r].cell[t]);
      if (round.unfit.empty()) round.unfit = regions[r].cell;  // finer everywhere
      sort_and_unite(round.unfit);
      return round;
    }
    const auto& loads = background.volume.loads;
    const double load = std::accumulate(loads.begin(), loads.end(), 0.0);
    if (load < whole_below * options.piece_tets) {
      builder.add_whole(r, load, rims.cells, surface);
      continue;
    }
    const auto parts = static_cast<std::int32_t>(std::lround(load / options.piece_tets));
    builder.add(r, background,
                partition::decompose_volume(background.volume, {parts, options.smallest_angle}), rims.cells,
                surface);
  }
  round.plan = builder.take();
  return round;
}

/// Every region one part.
VolumePlan whole_regions(const mesh::DistributedMesh& surface, double load) {
  VolumePlan plan;
  plan.parts = surface.region_count();
  for (RegionId r = 0; r < plan.parts; ++r) {
    plan.region_of.push_back(r);
    plan.loads.push_back(load / plan.parts);
  }
  for (std::size_t f = 0; f < std::max<std::size_t>(1, surface.faces.size()); ++f) {
    const mesh::FaceSides sides = surface.sides_of(static_cast<std::int32_t>(f));
    plan.part_of_cell.push_back({sides.front, sides.back});
  }
  for (const mesh::Piece& piece : surface.pieces)
    plan.cell.push_back(std::vector<std::int32_t>(piece.cell_count(), std::max(0, piece.common_face())));
  return plan;
}

}  // namespace

VolumePlan plan_volume(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                       const mesh::Numbering& numbering, const sizing::SizeField& field,
                       const VolumePlanOptions& options, parallel::StageClock& clock) {
  if (options.predicted_tets < whole_below * options.piece_tets)
    return whole_regions(surface, options.predicted_tets);
  const double width = std::max(smallest_width, std::cbrt(options.piece_tets / tets_per_part));
  std::optional<SurfaceCells> cells;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    cells.emplace(communicator, surface, numbering, partition::CellOptions{2 * width});
  }
  for (int round = 0; round < most_rounds; ++round) {
    SurfaceCells::Rims rims = cells->gather();
    Round outcome;
    parallel::agree(communicator, [&] {
      if (!communicator.is_root()) return;
      const parallel::ScopedCpu serial(clock, parallel::ScopedCpu::As::serial);
      outcome = try_round(std::move(rims), surface, field, options, width, clock);
    });
    communicator.broadcast_items(outcome.unfit);
    if (!outcome.unfit.empty()) {
      parallel::log_verbose(
          fmt::format("decompose: {} cells of the coarse surface are made finer", outcome.unfit.size()));
      const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
      cells->cut(outcome.unfit);
      continue;
    }
    parallel::Bytes bytes;
    if (communicator.is_root()) {
      outcome.plan->report.rounds = round;
      bytes = pack(*outcome.plan);
    }
    communicator.broadcast(bytes);
    const parallel::ScopedCpu repeated(clock, parallel::ScopedCpu::As::serial);
    VolumePlan plan = unpack_plan(bytes);
    plan.cell = cells->cell_of_triangle();
    double heaviest = 0, sum = 0;
    for (const double load : plan.loads) heaviest = std::max(heaviest, load), sum += load;
    plan.report.imbalance = heaviest * plan.parts / sum;
    return plan;
  }
  parallel::log_info("decompose: no coarse surface free of intersections was found; regions stay whole");
  return whole_regions(surface, options.predicted_tets);
}

}  // namespace aeroloom::pipeline
