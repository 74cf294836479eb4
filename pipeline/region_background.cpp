#include "pipeline/region_background.hpp"

#include "volume/surface_check.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::RegionId;

/// Growth of the background's sizes, per background element.
constexpr double background_growth = 2.5;

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
      if (chords.find(region.vertex[a], region.vertex[b]) < 0 && a < b)
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
      if (chords.find(region.vertex[v], region.vertex[to]) < 0) continue;
      const std::int32_t before = across(static_cast<std::int32_t>(t), v, to);
      auto at = static_cast<std::int32_t>(t);
      double angle = 0;
      for (int steps = 0; steps < 64; ++steps) {
        const auto& w = triangles[at];
        const int i = static_cast<int>(std::find(w.begin(), w.end(), v) - w.begin());
        const std::int32_t other = w[(i + 1) % 3] == to ? w[(i + 2) % 3] : w[(i + 1) % 3];
        angle += corner_angle(x[v], x[to], x[other]);
        const std::int32_t next = across(at, v, other);
        if (next < 0 || chords.find(region.vertex[v], region.vertex[other]) >= 0) {
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

}  // namespace

ChordIndex::ChordIndex(const partition::CoarseSurface& coarse) {
  for (std::size_t c = 0; c < coarse.chords.size(); ++c) {
    const auto [low, high] = std::minmax(coarse.chords[c].from, coarse.chords[c].to);
    _rows.push_back({low, high, static_cast<std::int32_t>(c)});
  }
  std::sort(_rows.begin(), _rows.end());
}

std::int32_t ChordIndex::find(std::int32_t a, std::int32_t b) const {
  const std::array<std::int32_t, 3> wanted{std::min(a, b), std::max(a, b), -1};
  const auto at = std::lower_bound(_rows.begin(), _rows.end(), wanted);
  return at != _rows.end() && (*at)[0] == wanted[0] && (*at)[1] == wanted[1] ? (*at)[2] : -1;
}

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

std::vector<std::int32_t> cells_to_cut(const RegionSurface& region) {
  volume::SurfaceDefect defect = volume::find_defect(region.surface);
  if (defect.what.empty()) {
    const volume::BoundaryDistance tree(region.surface.points, region.surface.triangles);
    defect = volume::find_intersections(region.surface, tree);
  }
  std::vector<std::int32_t> cells;
  for (const std::int32_t t : defect.triangles) cells.push_back(region.cell[t]);
  return cells;
}

RegionBackground fill_background(const RegionSurface& region, const partition::CoarseSurface& coarse,
                                 const ChordIndex& chords, const sizing::SizeField& field, double width,
                                 parallel::StageClock& clock) {
  const sizing::SizeField coarse_field = background_field(region, field, width);
  const double start = parallel::cpu_seconds();
  volume::FilledVolume filled = volume::fill_volume(region.surface, coarse_field, volume::VolumeOptions{});
  // The caller's clock has this rank's own part already.
  const double in_child = filled.cpu_seconds - (parallel::cpu_seconds() - start);
  clock.add_task_cpu(in_child);
  clock.add_serial_cpu(in_child);
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

}  // namespace aeroloom::pipeline
