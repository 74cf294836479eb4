#include "partition/repair_volume.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::partition {
namespace {

using Label = std::int32_t;

constexpr int most_sweeps = 40;
constexpr int most_moves = 4;  ///< of one cluster

class Repair {
public:
  Repair(const BackgroundVolume& volume, const EdgeRings& rings, const VolumeClusters& clusters,
         double smallest_angle, std::vector<Label>& part)
      : _volume(volume),
        _rings(rings),
        _clusters(clusters),
        _smallest_angle(smallest_angle),
        _part(part),
        _moved(clusters.loads.size(), 0) {
    list_members();
    list_stars();
  }

  VolumeRepair run() {
    connect();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const std::int32_t before = _result.moves;
      mend_edges();
      mend_vertices();
      connect();
      if (_result.moves == before) break;
    }
    _result.pinches = count_pinches();
    return _result;
  }

private:
  /// Connected tetrahedra of a star, and what is across.
  struct StarGroup {
    std::vector<std::int32_t> tets;
    double load = 0;
  };

  void list_members() {
    _first_member.assign(_clusters.loads.size() + 1, 0);
    for (const std::int32_t c : _clusters.of_tet) ++_first_member[c + 1];
    std::partial_sum(_first_member.begin(), _first_member.end(), _first_member.begin());
    _members.resize(_clusters.of_tet.size());
    std::vector<std::int32_t> next(_first_member.begin(), _first_member.end() - 1);
    for (std::size_t t = 0; t < _clusters.of_tet.size(); ++t)
      _members[next[_clusters.of_tet[t]]++] = static_cast<std::int32_t>(t);
  }

  void list_stars() {
    _first_star.assign(_volume.points.size() + 1, 0);
    for (const auto& tet : _volume.tets) {
      for (const std::int32_t v : tet) ++_first_star[v + 1];
    }
    std::partial_sum(_first_star.begin(), _first_star.end(), _first_star.begin());
    _star.resize(4 * _volume.tets.size());
    std::vector<std::int32_t> next(_first_star.begin(), _first_star.end() - 1);
    for (std::size_t t = 0; t < _volume.tets.size(); ++t) {
      for (const std::int32_t v : _volume.tets[t]) _star[next[v]++] = static_cast<std::int32_t>(t);
    }
  }

  bool move(std::int32_t tet, Label to) {
    const std::int32_t c = _clusters.of_tet[tet];
    if (_moved[c] >= most_moves || _part[tet] == to) return false;
    ++_moved[c];
    assign(c, to);
    ++_result.moves;
    return true;
  }

  void assign(std::int32_t cluster, Label to) {
    for (std::int32_t i = _first_member[cluster]; i < _first_member[cluster + 1]; ++i)
      _part[_members[i]] = to;
  }

  /// Gives all but the heaviest component of each part to the neighbour it shares the most faces with.
  void connect() {
    for (bool again = true; again;) {
      again = false;
      std::vector<std::int32_t> component(_volume.tets.size(), -1);
      std::vector<double> loads;
      std::vector<Label> label;
      std::vector<std::int32_t> stack;
      for (std::size_t t = 0; t < component.size(); ++t) {
        if (component[t] >= 0) continue;
        const auto c = static_cast<std::int32_t>(loads.size());
        loads.push_back(0);
        label.push_back(_part[t]);
        component[t] = c;
        stack.push_back(static_cast<std::int32_t>(t));
        while (!stack.empty()) {
          const std::int32_t s = stack.back();
          stack.pop_back();
          loads[c] += _volume.loads[s];
          for (const std::int32_t n : _volume.neighbours[s]) {
            if (n < 0 || component[n] >= 0 || _part[n] != _part[t]) continue;
            component[n] = c;
            stack.push_back(n);
          }
        }
      }
      const Label parts = 1 + *std::max_element(label.begin(), label.end());
      std::vector<std::int32_t> heaviest(parts, -1);
      for (std::size_t c = 0; c < loads.size(); ++c) {
        std::int32_t& h = heaviest[label[c]];
        if (h < 0 || loads[c] > loads[h]) h = static_cast<std::int32_t>(c);
      }
      std::vector<std::vector<std::int32_t>> faces(loads.size());  // parts across, repeated
      for (std::size_t t = 0; t < component.size(); ++t) {
        const std::int32_t c = component[t];
        if (heaviest[label[c]] == c) continue;
        for (const std::int32_t n : _volume.neighbours[t]) {
          if (n >= 0 && _part[n] != _part[t]) faces[c].push_back(_part[n]);
        }
      }
      std::vector<Label> target(loads.size(), -1);
      for (std::size_t c = 0; c < loads.size(); ++c) {
        std::sort(faces[c].begin(), faces[c].end());
        std::size_t most = 0;
        for (std::size_t i = 0, j = 0; i < faces[c].size(); i = j) {
          while (j < faces[c].size() && faces[c][j] == faces[c][i]) ++j;
          if (j - i > most) most = j - i, target[c] = faces[c][i];
        }
        again = again || target[c] >= 0;
      }
      for (std::size_t t = 0; t < component.size(); ++t) {
        if (target[component[t]] >= 0) _part[t] = target[component[t]];
      }
    }
  }

  /// Around an edge a part has one stretch at most, and no stretch is narrow.
  void mend_edges() {
    std::vector<Stretch> stretches;
    for (std::int32_t r = 0; r < _rings.count(); ++r) {
      find_stretches(_rings, r, _part, stretches);
      const std::int32_t worst = worst_stretch(r, stretches);
      if (worst >= 0) give_away(r, stretches, worst);
    }
  }

  std::int32_t tet_at(std::int32_t ring, std::int32_t i) const {
    const std::int32_t size = _rings.size(ring);
    return _rings.tets[_rings.first[ring] + (i + size) % size];
  }

  double load_of(std::int32_t ring, const Stretch& s) const {
    double load = 0;
    std::int32_t last = -1;
    for (std::int32_t i = s.from; i < s.to; ++i) {
      const std::int32_t c = _clusters.of_tet[tet_at(ring, i)];
      if (c != last) load += _clusters.loads[c];
      last = c;
    }
    return load;
  }

  /// The stretch to give away: the narrowest below the threshold, else the lightest next to a part that
  /// occurs twice; -1: all is well.
  std::int32_t worst_stretch(std::int32_t ring, const std::vector<Stretch>& stretches) const {
    const auto count = static_cast<std::int32_t>(stretches.size());
    if (count < 2) return -1;
    std::int32_t worst = -1;
    double narrowest = _smallest_angle;
    for (std::int32_t s = 0; s < count; ++s) {
      if (stretches[s].angle < narrowest) narrowest = stretches[s].angle, worst = s;
    }
    if (worst >= 0 || count < 3) return worst;
    double lightest = 1e300;
    for (std::int32_t s = 0; s < count; ++s) {
      const Label label = _part[tet_at(ring, stretches[s].from)];
      const auto twice = std::count_if(stretches.begin(), stretches.end(), [&](const Stretch& other) {
        return _part[tet_at(ring, other.from)] == label;
      });
      if (twice < 2) continue;
      for (const std::int32_t n : {s - 1, s, s + 1}) {
        const std::int32_t candidate = _rings.closed[ring] ? (n + count) % count : n;
        if (candidate < 0 || candidate >= count) continue;
        const double load = load_of(ring, stretches[candidate]);
        if (load < lightest) lightest = load, worst = candidate;
      }
    }
    return worst;
  }

  void give_away(std::int32_t ring, const std::vector<Stretch>& stretches, std::int32_t which) {
    const auto count = static_cast<std::int32_t>(stretches.size());
    const Stretch& s = stretches[which];
    std::vector<Label> takers;
    if (_rings.closed[ring] || which > 0) takers.push_back(_part[tet_at(ring, s.from - 1)]);
    if (_rings.closed[ring] || which + 1 < count) takers.push_back(_part[tet_at(ring, s.to)]);
    if (takers.empty()) return;
    // The part that occurs on both sides, or most often, closes up.
    Label best = takers.front();
    std::ptrdiff_t most = -1;
    for (const Label taker : takers) {
      const auto uses = std::count_if(stretches.begin(), stretches.end(), [&](const Stretch& other) {
        return _part[tet_at(ring, other.from)] == taker;
      });
      if (uses > most) most = uses, best = taker;
    }
    for (std::int32_t i = s.from; i < s.to; ++i) move(tet_at(ring, i), best);
  }

  /// Groups of the star of a vertex by `same`, connected by faces at the vertex.
  template <class Same>
  std::vector<StarGroup> groups_of(std::int32_t vertex, const Same& same) {
    const std::int32_t first = _first_star[vertex], last = _first_star[vertex + 1];
    std::vector<char> seen(last - first, 0);
    std::vector<StarGroup> groups;
    const auto slot = [&](std::int32_t t) {
      return std::lower_bound(_star.begin() + first, _star.begin() + last, t) - (_star.begin() + first);
    };
    for (std::int32_t i = 0; i < last - first; ++i) {
      if (seen[i]) continue;
      StarGroup group;
      group.tets.push_back(_star[first + i]);
      seen[i] = 1;
      for (std::size_t g = 0; g < group.tets.size(); ++g) {
        const std::int32_t t = group.tets[g];
        for (int k = 0; k < 4; ++k) {
          const std::int32_t n = _volume.neighbours[t][k];
          if (_volume.tets[t][k] == vertex || n < 0 || !same(t, n)) continue;
          const auto s = slot(n);
          if (seen[s]) continue;
          seen[s] = 1;
          group.tets.push_back(n);
        }
      }
      groups.push_back(std::move(group));
    }
    return groups;
  }

  bool on_boundary(const StarGroup& group, std::int32_t vertex) const {
    return std::any_of(group.tets.begin(), group.tets.end(), [&](std::int32_t t) {
      for (int k = 0; k < 4; ++k) {
        if (_volume.tets[t][k] != vertex && _volume.neighbours[t][k] < 0) return true;
      }
      return false;
    });
  }

  double cluster_load(const StarGroup& group) const {
    std::vector<std::int32_t> clusters;
    for (const std::int32_t t : group.tets) clusters.push_back(_clusters.of_tet[t]);
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    double load = 0;
    for (const std::int32_t c : clusters) load += _clusters.loads[c];
    return load;
  }

  /// At one vertex: the group to move and where to; an empty group: all is well.
  struct Pinch {
    StarGroup group;
    Label to = -1;
  };

  Pinch find_pinch(std::int32_t vertex) {
    const auto by_part =
        groups_of(vertex, [&](std::int32_t s, std::int32_t t) { return _part[s] == _part[t]; });
    if (by_part.size() < 2) return {};
    Pinch pinch;
    double lightest = 1e300;
    for (const StarGroup& group : by_part) {  // a part that meets the vertex in two groups
      const Label label = _part[group.tets.front()];
      const auto same = std::count_if(by_part.begin(), by_part.end(), [&](const StarGroup& other) {
        return _part[other.tets.front()] == label;
      });
      if (same < 2 || cluster_load(group) >= lightest) continue;
      lightest = cluster_load(group);
      pinch = {group, neighbour_of(group, vertex)};
    }
    if (pinch.to >= 0) return pinch;
    for (const StarGroup& around : by_part) {  // a part that goes around something at the vertex
      const Label label = _part[around.tets.front()];
      const auto rest = groups_of(
          vertex, [&](std::int32_t s, std::int32_t t) { return (_part[s] == label) == (_part[t] == label); });
      std::int32_t beside = 0, outside = 0;
      for (const StarGroup& group : rest) {
        if (_part[group.tets.front()] == label) continue;
        ++beside;
        if (on_boundary(group, vertex)) ++outside;
      }
      const bool touches = on_boundary(around, vertex);
      // All groups on the boundary are one through the outside; so is the outside alone, where only the part
      // itself touches it all around.
      const std::int32_t complement = beside - std::max(0, outside - 1) + (touches && outside == 0 ? 1 : 0);
      if (complement < 2) continue;
      for (const StarGroup& group : rest) {
        if (_part[group.tets.front()] == label || on_boundary(group, vertex)) continue;
        if (cluster_load(group) >= lightest) continue;
        lightest = cluster_load(group);
        pinch = {group, label};
      }
    }
    return pinch;
  }

  Label neighbour_of(const StarGroup& group, std::int32_t vertex) const {
    std::vector<Label> across;
    for (const std::int32_t t : group.tets) {
      for (int k = 0; k < 4; ++k) {
        const std::int32_t n = _volume.neighbours[t][k];
        if (_volume.tets[t][k] != vertex && n >= 0 && _part[n] != _part[t]) across.push_back(_part[n]);
      }
    }
    std::sort(across.begin(), across.end());
    Label best = -1;
    std::size_t most = 0;
    for (std::size_t i = 0, j = 0; i < across.size(); i = j) {
      while (j < across.size() && across[j] == across[i]) ++j;
      if (j - i > most) most = j - i, best = across[i];
    }
    return best;
  }

  void mend_vertices() {
    for (std::size_t v = 0; v < _volume.points.size(); ++v) {
      const Pinch pinch = find_pinch(static_cast<std::int32_t>(v));
      if (pinch.to < 0) continue;
      for (const std::int32_t t : pinch.group.tets) move(t, pinch.to);
    }
  }

  std::int32_t count_pinches() {
    std::int32_t count = 0;
    for (std::size_t v = 0; v < _volume.points.size(); ++v)
      count += find_pinch(static_cast<std::int32_t>(v)).to >= 0;
    std::vector<Stretch> stretches;
    for (std::int32_t r = 0; r < _rings.count(); ++r) {
      find_stretches(_rings, r, _part, stretches);
      std::vector<Label> labels;
      for (const Stretch& s : stretches) labels.push_back(_part[tet_at(r, s.from)]);
      std::sort(labels.begin(), labels.end());
      count += std::adjacent_find(labels.begin(), labels.end()) != labels.end();
    }
    return count;
  }

  const BackgroundVolume& _volume;
  const EdgeRings& _rings;
  const VolumeClusters& _clusters;
  double _smallest_angle;
  std::vector<Label>& _part;
  std::vector<int> _moved;
  std::vector<std::int32_t> _first_member, _members;  // tetrahedra of each cluster
  std::vector<std::int32_t> _first_star, _star;       // tetrahedra around each point, ascending
  VolumeRepair _result;
};

}  // namespace

VolumeRepair repair_parts(const BackgroundVolume& volume, const EdgeRings& rings,
                          const VolumeClusters& clusters, double smallest_angle,
                          std::vector<std::int32_t>& part) {
  return Repair(volume, rings, clusters, smallest_angle, part).run();
}

}  // namespace aeroloom::partition
