#include "pipeline/volume_plan.hpp"

#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "partition/background_volume.hpp"
#include "partition/decompose_volume.hpp"
#include "pipeline/surface_rims.hpp"
#include "volume/surface_check.hpp"
#include "volume/volume_mesher.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
/// Growth of the background's sizes, per background element.
constexpr double background_growth = 2.5;
/// Regions of less than this many wanted parts stay whole.
constexpr double whole_below = 1.5;

/// The coarse surface around one region, turned outwards.
struct RegionSurface {
  volume::ClosedSurface surface;
  std::vector<std::int32_t> vertex;  ///< coarse vertex per point
  std::vector<std::int32_t> cell;    ///< per triangle
};

RegionSurface surface_of(const partition::CoarseSurface& coarse, const std::vector<partition::Cell>& cells,
                         const mesh::DistributedMesh& surface, RegionId region) {
  RegionSurface result;
  std::vector<std::int32_t> local(coarse.vertices.size(), -1);
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    const mesh::FaceSides sides = surface.sides_of(cells[coarse.cell_of[t]].face);
    if (sides.front != region && sides.back != region) continue;
    auto v = coarse.triangles[t];
    if (sides.front != region) std::swap(v[1], v[2]);
    for (std::int32_t& corner : v) {
      if (local[corner] < 0) {
        local[corner] = static_cast<std::int32_t>(result.vertex.size());
        result.vertex.push_back(corner);
        result.surface.points.push_back(coarse.vertices[corner].point);
      }
      corner = local[corner];
    }
    result.surface.triangles.push_back(v);
    result.cell.push_back(coarse.cell_of[t]);
  }
  return result;
}

/// Sizes of the background: as large as its boundary triangles, growing fast, at most `width` fine sizes.
sizing::SizeField background_field(const RegionSurface& region, const sizing::SizeField& field,
                                   double width) {
  std::vector<sizing::SizeSource> sources;
  double largest = 0;
  const auto& x = region.surface.points;
  for (const auto& v : region.surface.triangles) {
    const double edge =
        (distance(x[v[0]], x[v[1]]) + distance(x[v[1]], x[v[2]]) + distance(x[v[2]], x[v[0]])) / 3;
    sources.push_back({(x[v[0]] + x[v[1]] + x[v[2]]) / 3.0, edge});
    largest = std::max(largest, edge);
  }
  geometry::Box box;
  for (const Vec3& p : x) box.add(p);
  for (std::int64_t i = 0; i < field.leaf_count(); ++i) {
    const auto leaf = field.leaf(i);
    const Vec3 center = leaf.low + Vec3{0.5 * leaf.edge, 0.5 * leaf.edge, 0.5 * leaf.edge};
    if (box.contains(center)) sources.push_back({center, width * leaf.size});
  }
  sizing::SizingOptions options;
  options.minimum = std::min_element(sources.begin(), sources.end(), [](const auto& a, const auto& b) {
                      return a.size < b.size;
                    })->size;
  options.maximum = std::max(width * field.maximum(), largest);
  options.growth = background_growth;
  return sizing::SizeField::build(field.domain(), sources, options);
}

/// A tetrahedron with the sizes at its corners.
struct SizedTet {
  std::array<Vec3, 4> p;
  std::array<double, 4> h;
};

/// The integral of 6 sqrt(2) / h^3 over a tetrahedron, by halving until h varies little.
double load_of(SizedTet tet, const sizing::SizeField& field, int depth) {
  constexpr int deepest = 14;
  constexpr double even = 1.4;
  const auto [low, high] = std::minmax_element(tet.h.begin(), tet.h.end());
  if (depth == deepest || *high <= even * *low) {
    const double volume = std::abs(geometry::volume6(tet.p[0], tet.p[1], tet.p[2], tet.p[3])) / 6;
    const double mean = std::sqrt(std::sqrt(tet.h[0] * tet.h[1]) * std::sqrt(tet.h[2] * tet.h[3]));
    return 6 * std::numbers::sqrt2 * volume / (mean * mean * mean);
  }
  int i = 0, j = 1;
  double longest = 0;
  for (const auto& edge : mesh::tetrahedron_edges) {
    const Vec3 along = tet.p[edge[1]] - tet.p[edge[0]];
    if (dot(along, along) > longest) longest = dot(along, along), i = edge[0], j = edge[1];
  }
  const Vec3 middle = 0.5 * (tet.p[i] + tet.p[j]);
  const double size = field(middle);
  SizedTet other = tet;
  other.p[i] = tet.p[j] = middle;
  other.h[i] = tet.h[j] = size;
  return load_of(tet, field, depth + 1) + load_of(other, field, depth + 1);
}

using ChordIndex = std::vector<std::array<std::int32_t, 3>>;  // from, to, chord; sorted

ChordIndex index_chords(const partition::CoarseSurface& coarse) {
  ChordIndex index;
  for (std::size_t c = 0; c < coarse.chords.size(); ++c) {
    const auto [low, high] = std::minmax(coarse.chords[c].from, coarse.chords[c].to);
    index.push_back({low, high, static_cast<std::int32_t>(c)});
  }
  std::sort(index.begin(), index.end());
  return index;
}

/// The chord between two coarse vertices, -1 without one.
std::int32_t find_chord(const ChordIndex& index, std::int32_t a, std::int32_t b) {
  const std::array<std::int32_t, 3> wanted{std::min(a, b), std::max(a, b), -1};
  const auto at = std::lower_bound(index.begin(), index.end(), wanted);
  return at != index.end() && (*at)[0] == wanted[0] && (*at)[1] == wanted[1] ? (*at)[2] : -1;
}

/// One boundary triangle of the background: its tetrahedron and cell.
struct BoundaryFace {
  std::int32_t tet, cell;
};

/// The background of one region.
struct RegionBackground {
  partition::BackgroundVolume volume;
  std::vector<std::int32_t> coarse_vertex;  ///< per point, -1 inside
  std::vector<BoundaryFace> boundary;       ///< per triangle of the region's surface
};

void link_boundary(const RegionSurface& region, RegionBackground& background) {
  struct Face {
    std::array<std::int32_t, 3> v;
    std::int32_t owner;
  };
  std::vector<Face> open;
  const auto& volume = background.volume;
  for (std::size_t t = 0; t < volume.tets.size(); ++t) {
    for (int k = 0; k < 4; ++k) {
      if (volume.neighbours[t][k] >= 0) continue;
      const auto& v = volume.tets[t];
      Face face{{v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4]}, static_cast<std::int32_t>(t)};
      std::sort(face.v.begin(), face.v.end());
      open.push_back(face);
    }
  }
  std::sort(open.begin(), open.end(), [](const Face& a, const Face& b) { return a.v < b.v; });
  for (std::size_t t = 0; t < region.surface.triangles.size(); ++t) {
    auto v = region.surface.triangles[t];
    std::sort(v.begin(), v.end());
    const auto at =
        std::lower_bound(open.begin(), open.end(), v,
                         [](const Face& f, const std::array<std::int32_t, 3>& w) { return f.v < w; });
    background.boundary.push_back({at->owner, region.cell[t]});
  }
}

double corner_angle(Vec3 at, Vec3 b, Vec3 c) {
  return std::atan2(norm(cross(b - at, c - at)), dot(b - at, c - at)) * 180 / std::numbers::pi;
}

/// The angles of cells at their corners, and the edges no cut may pass.
void describe_boundary(const RegionSurface& region, const partition::CoarseSurface& coarse,
                       const ChordIndex& chords, RegionBackground& background) {
  struct Side {
    std::int32_t low, high, triangle;
  };
  const auto& triangles = region.surface.triangles;
  const auto& x = region.surface.points;
  std::vector<Side> sides;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t)});
      if (find_chord(chords, region.vertex[a], region.vertex[b]) < 0 && a < b)
        background.volume.closed_edges.push_back({a, b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.triangle < t.triangle;
  });
  const auto across = [&](std::int32_t t, std::int32_t a, std::int32_t b) {
    const Side wanted{std::min(a, b), std::max(a, b), -1};
    auto at = std::lower_bound(sides.begin(), sides.end(), wanted, [](const Side& s, const Side& w) {
      return s.low != w.low ? s.low < w.low : s.high < w.high;
    });
    for (; at != sides.end() && at->low == wanted.low && at->high == wanted.high; ++at) {
      if (at->triangle != t) return at->triangle;
    }
    return -1;
  };
  // From a triangle whose side before its corner is a chord, around the corner to the next chord.
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t v = triangles[t][k];
      std::int32_t to = triangles[t][(k + 1) % 3];
      if (coarse.is_apex[region.vertex[v]]) continue;
      if (find_chord(chords, region.vertex[v], region.vertex[to]) < 0) continue;
      const std::int32_t before = across(static_cast<std::int32_t>(t), v, to);
      auto at = static_cast<std::int32_t>(t);
      double angle = 0;
      for (int steps = 0; steps < 64; ++steps) {
        const auto& w = triangles[at];
        const int i = static_cast<int>(std::find(w.begin(), w.end(), v) - w.begin());
        const std::int32_t other = w[(i + 1) % 3] == to ? w[(i + 2) % 3] : w[(i + 1) % 3];
        angle += corner_angle(x[v], x[to], x[other]);
        const std::int32_t next = across(at, v, other);
        if (next < 0 || find_chord(chords, region.vertex[v], region.vertex[other]) >= 0) {
          const auto tet = [&](std::int32_t b) { return b < 0 ? -1 : background.boundary[b].tet; };
          background.volume.corners.push_back({background.boundary[t].tet, tet(before), tet(next), angle});
          break;
        }
        at = next;
        to = other;
      }
    }
  }
}

/// Fills the coarse surface. Throws VolumeError.
RegionBackground fill_background(const RegionSurface& region, const partition::CoarseSurface& coarse,
                                 const ChordIndex& chords, const sizing::SizeField& field, double width,
                                 parallel::StageClock& clock) {
  volume::FilledVolume filled =
      volume::fill_volume(region.surface, background_field(region, field, width), volume::VolumeOptions{});
  clock.note_child_memory(filled.child_peak_bytes);
  RegionBackground background;
  partition::BackgroundVolume& volume = background.volume;
  for (std::size_t i = 0; i < filled.coordinates.size(); i += 3)
    volume.points.push_back({filled.coordinates[i], filled.coordinates[i + 1], filled.coordinates[i + 2]});
  for (std::size_t i = 0; i < filled.tetrahedra.size(); i += 4) {
    const auto* v = &filled.tetrahedra[i];
    volume.tets.push_back({v[0], v[1], v[2], v[3]});
  }
  volume.neighbours = partition::link_tetrahedra(volume.tets);
  background.coarse_vertex = region.vertex;
  background.coarse_vertex.resize(volume.points.size(), -1);
  volume.closed_vertices.assign(volume.points.size(), 0);
  for (std::size_t v = 0; v < region.vertex.size(); ++v)
    volume.closed_vertices[v] = coarse.is_apex[region.vertex[v]];
  std::vector<double> sizes;
  for (const Vec3& p : volume.points) sizes.push_back(field(p));
  for (const auto& v : volume.tets) {
    SizedTet tet;
    double product = 1;
    for (int k = 0; k < 4; ++k) {
      tet.p[k] = volume.points[v[k]];
      tet.h[k] = sizes[v[k]];
      product *= std::sqrt(std::sqrt(tet.h[k]));
    }
    volume.loads.push_back(load_of(tet, field, 0));
    volume.sizes.push_back(product);
  }
  link_boundary(region, background);
  describe_boundary(region, coarse, chords, background);
  return background;
}

/// Collects the interfaces of all regions.
class PlanBuilder {
public:
  PlanBuilder(const partition::CoarseSurface& coarse, const std::vector<partition::Cell>& cells)
      : _coarse(coarse), _chords(index_chords(coarse)) {
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
      const std::int32_t chord = a < 0 || b < 0 ? -1 : find_chord(_chords, a, b);
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

/// Cells whose coarse triangles are degenerate or meet others.
void list_offenders(const RegionSurface& region, std::vector<std::int32_t>& unfit) {
  volume::SurfaceDefect defect = volume::find_defect(region.surface);
  if (defect.what.empty()) {
    const volume::BoundaryDistance tree(region.surface.points, region.surface.triangles);
    defect = volume::find_intersections(region.surface, tree);
  }
  for (const std::int32_t t : defect.triangles) unfit.push_back(region.cell[t]);
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
      list_offenders(regions.back(), round.unfit);
    }
  }
  std::sort(round.unfit.begin(), round.unfit.end());
  round.unfit.erase(std::unique(round.unfit.begin(), round.unfit.end()), round.unfit.end());
  if (!round.unfit.empty()) return round;
  PlanBuilder builder(coarse, rims.cells);
  for (RegionId r = 0; r < surface.region_count(); ++r) {
    const RegionBackground background =
        fill_background(regions[r], coarse, builder.chords(), field, width, clock);
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
