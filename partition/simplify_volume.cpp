#include "partition/simplify_volume.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::partition {
namespace {

constexpr int most_passes = 50;

/// Contraction by union of clusters (Tarjan, J. ACM 22, 1975, doi:10.1145/321879.321884).
class Contraction {
public:
  explicit Contraction(const BackgroundVolume& volume)
      : _parent(volume.tets.size()), _loads(volume.loads), _label(volume.tets.size()) {
    std::iota(_parent.begin(), _parent.end(), 0);
  }

  std::int32_t root(std::int32_t t) {
    while (_parent[t] != t) t = _parent[t] = _parent[_parent[t]];
    return t;
  }
  double load_together(std::int32_t s, std::int32_t t) {
    const std::int32_t a = root(s), b = root(t);
    return a == b ? _loads[a] : _loads[a] + _loads[b];
  }
  void join(std::int32_t s, std::int32_t t) {
    std::int32_t a = root(s), b = root(t);
    if (a == b) return;
    if (b < a) std::swap(a, b);
    _parent[b] = a;
    _loads[a] += _loads[b];
  }
  const std::vector<std::int32_t>& labels() {
    for (std::size_t t = 0; t < _label.size(); ++t) _label[t] = root(static_cast<std::int32_t>(t));
    return _label;
  }

private:
  std::vector<std::int32_t> _parent;
  std::vector<double> _loads;  // of roots
  std::vector<std::int32_t> _label;
};

void join_closed(const BackgroundVolume& volume, const EdgeRings& rings, Contraction& clusters) {
  std::vector<std::int32_t> first(volume.points.size(), -1);
  for (std::size_t t = 0; t < volume.tets.size(); ++t) {
    for (const std::int32_t v : volume.tets[t]) {
      if (!volume.closed_vertices[v]) continue;
      if (first[v] < 0) first[v] = static_cast<std::int32_t>(t);
      clusters.join(first[v], static_cast<std::int32_t>(t));
    }
  }
  std::vector<std::array<std::int32_t, 2>> closed = volume.closed_edges;
  std::sort(closed.begin(), closed.end());
  for (std::int32_t r = 0; r < rings.count(); ++r) {
    if (!std::binary_search(closed.begin(), closed.end(), rings.edges[r])) continue;
    for (std::int32_t i = rings.first[r] + 1; i < rings.first[r + 1]; ++i)
      clusters.join(rings.tets[i - 1], rings.tets[i]);
  }
}

/// Two cuts that are too close: what lies between them, and the tetrahedra beyond; -1: the boundary.
struct VolumeWedge {
  double angle;
  std::int32_t first, last, before, after;
};

void list_wedges(const EdgeRings& rings, const std::vector<std::int32_t>& label, double smallest_angle,
                 std::vector<VolumeWedge>& wedges) {
  std::vector<Stretch> stretches;
  for (std::int32_t r = 0; r < rings.count(); ++r) {
    find_stretches(rings, r, label, stretches);
    const std::int32_t size = rings.size(r), first = rings.first[r];
    if (rings.closed[r] && stretches.size() < 2) continue;
    for (const Stretch& s : stretches) {
      if (s.angle >= smallest_angle) continue;
      const auto at = [&](std::int32_t i) { return rings.tets[first + (i + size) % size]; };
      const bool begins = !rings.closed[r] && s.from == 0, ends = !rings.closed[r] && s.to == size;
      if (begins && ends) continue;  // the input's own angle
      wedges.push_back(
          {s.angle, at(s.from), at(s.to - 1), begins ? -1 : at(s.from - 1), ends ? -1 : at(s.to)});
    }
  }
}

void list_corners(const BackgroundVolume& volume, const std::vector<std::int32_t>& label,
                  double smallest_angle, std::vector<VolumeWedge>& wedges) {
  for (const TraceCorner& c : volume.corners) {
    if (c.angle >= smallest_angle) continue;
    const auto cut = [&](std::int32_t t) { return t >= 0 && label[t] != label[c.inside]; };
    if (!cut(c.before) || !cut(c.after)) continue;
    wedges.push_back({c.angle, c.inside, c.inside, c.before, c.after});
  }
}

/// Contracts one side of a wedge; false when both would make a cluster too heavy.
bool close_wedge(const VolumeWedge& wedge, double largest_load, Contraction& clusters) {
  const auto is_cut = [&](std::int32_t inner, std::int32_t outer) {
    return outer >= 0 && clusters.root(inner) != clusters.root(outer);
  };
  const bool before = is_cut(wedge.first, wedge.before), after = is_cut(wedge.last, wedge.after);
  if ((wedge.before >= 0 && !before) || (wedge.after >= 0 && !after)) return true;  // no longer a wedge
  const double load_before = before ? clusters.load_together(wedge.first, wedge.before) : 1e300;
  const double load_after = after ? clusters.load_together(wedge.last, wedge.after) : 1e300;
  if (std::min(load_before, load_after) > largest_load) return false;
  if (load_before <= load_after) {
    clusters.join(wedge.first, wedge.before);
  } else {
    clusters.join(wedge.last, wedge.after);
  }
  return true;
}

}  // namespace

VolumeClusters simplify(const BackgroundVolume& volume, const EdgeRings& rings, double smallest_angle,
                        double largest_load) {
  Contraction contraction(volume);
  join_closed(volume, rings, contraction);
  VolumeClusters result;
  std::vector<VolumeWedge> wedges;
  for (int pass = 0; pass < most_passes && smallest_angle > 0; ++pass) {
    wedges.clear();
    list_wedges(rings, contraction.labels(), smallest_angle, wedges);
    list_corners(volume, contraction.labels(), smallest_angle, wedges);
    std::stable_sort(wedges.begin(), wedges.end(),
                     [](const VolumeWedge& a, const VolumeWedge& b) { return a.angle < b.angle; });
    result.unresolved = 0;
    for (const VolumeWedge& wedge : wedges) {
      if (!close_wedge(wedge, largest_load, contraction)) ++result.unresolved;
    }
    if (static_cast<std::size_t>(result.unresolved) == wedges.size()) break;
  }
  std::vector<std::int32_t> number(volume.tets.size(), -1);
  for (const std::int32_t root : contraction.labels()) {
    if (number[root] < 0) {
      number[root] = result.count();
      result.loads.push_back(0);
    }
    result.of_tet.push_back(number[root]);
    result.loads[number[root]] += volume.loads[result.of_tet.size() - 1];
  }
  return result;
}

}  // namespace aeroloom::partition
