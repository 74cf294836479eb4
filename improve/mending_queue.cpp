#include "improve/mending_queue.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

// The heap's top is its greatest element: the worst quality, then the lowest slot.
constexpr auto later = [](const auto& a, const auto& b) {
  return a.quality != b.quality ? a.quality > b.quality : a.tet > b.tet;
};

/// Tries of one sweep, in tetrahedra that it began with, so that it ends where the surface leaves no room for
/// good ones (docs/improvement.md). Chosen, not measured.
constexpr std::int64_t tries_per_task = 4;
constexpr std::int64_t least_tries = 1000;
/// A sweep with fewer gains is the last one. Chosen, not measured.
constexpr std::int64_t tasks_per_gain = 50;
/// Of the target: below these the costly means are tried, which refill a whole cavity. Chosen, not measured.
constexpr double worth_moving = 0.9;
constexpr double worth_adding = 0.75;

/// The edges of a tetrahedron by their dihedral angles, largest first: those whose removal promises most.
std::array<int, 6> widest_first(const TetMesh& mesh, LocalIndex t) {
  const Corners& c = mesh.corners(t);
  Vec3 normals[4];
  for (int f = 0; f < 4; ++f) {
    const auto& face = mesh::tetrahedron_faces[f];
    const Vec3 a = mesh.point(c[face[0]]);
    normals[f] = normalized(cross(mesh.point(c[face[1]]) - a, mesh.point(c[face[2]]) - a));
  }
  std::array<double, 6> cosine{};  // of the angle between outward normals: large where the dihedral is
  std::array<int, 6> order{};
  for (int e = 0; e < 6; ++e) {
    // The faces at an edge are opposite to the other two vertices.
    const auto& other = mesh::tetrahedron_edges[5 - e];
    cosine[e] = dot(normals[other[0]], normals[other[1]]);
    order[e] = e;
  }
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return cosine[a] != cosine[b] ? cosine[a] > cosine[b] : a < b; });
  return order;
}

}  // namespace

MendingQueue::MendingQueue(TetMesh& mesh, const AttainableQuality& attainable, const ChangeLimits& limits,
                           Effort effort, cad::PointLocator* locator)
    : _mesh(mesh),
      _attainable(attainable),
      _limits(limits),
      _effort(effort),
      _smoothing(limits),
      _slots(mesh.slot_count()),
      _vertices(mesh.vertex_count()) {
  if (locator) _sliding.emplace(*locator, limits);
}

void MendingQueue::run(int sweeps) {
  Means means = Means::swaps_and_smoothing;
  for (int i = 0; i < sweeps; ++i) {
    const Sweep done = sweep(means);
    if (means == Means::new_vertices && done.gains <= done.tasks / tasks_per_gain) return;
    if (i >= 1 && means != Means::new_vertices) means = static_cast<Means>(static_cast<int>(means) + 1);
  }
}

void MendingQueue::follow_relief(const std::vector<LocalIndex>& fresh) {
  for (SlotHistory& slot : _slots) slot.attempt = _now, slot.attempt_means = Means::new_vertices;
  for (const LocalIndex t : fresh) _slots[t].attempt = 0;
  note_change(fresh, -1);
  _corners.emplace();
}

MendingQueue::Sweep MendingQueue::sweep(Means means) {
  fill_heap();
  Sweep done{static_cast<std::int64_t>(_heap.size()), 0};
  // A change may leave others below the target, without end where every gain is small.
  std::int64_t tries = tries_per_task * done.tasks + least_tries;
  while (!_heap.empty() && tries > 0) {
    std::pop_heap(_heap.begin(), _heap.end(), later);
    const Task task = _heap.back();
    _heap.pop_back();
    if (task.version != _slots[task.tet].version || !_mesh.is_alive(task.tet) ||
        !worth_trying(task.tet, means))
      continue;
    --tries;
    if (mend(task.tet, means)) {
      ++done.gains;
    } else {
      _slots[task.tet].attempt = _now;
      _slots[task.tet].attempt_means = means;
    }
  }
  return done;
}

void MendingQueue::fill_heap() {
  _heap.clear();
  for (LocalIndex t = 0; t < _mesh.slot_count(); ++t) {
    if (_mesh.is_alive(t) && _mesh.quality(t) < target_of(t)) {
      _heap.push_back({_mesh.quality(t), t, _slots[t].version});
    }
  }
  std::make_heap(_heap.begin(), _heap.end(), later);
}

void MendingQueue::push(LocalIndex t) {
  if (_mesh.quality(t) >= target_of(t)) return;
  _heap.push_back({_mesh.quality(t), t, _slots[t].version});
  std::push_heap(_heap.begin(), _heap.end(), later);
}

bool MendingQueue::worth_trying(LocalIndex t, Means means) const {
  if (_slots[t].attempt == 0) return true;
  // Beside a strip every try moves what the next one finds, little comes of it, and no other means follow.
  if (_slots[t].attempt_means >= Means::moving_cavities && is_spared(t)) return false;
  if (_slots[t].attempt_means < means) return true;
  const Corners& corners = _mesh.corners(t);
  return std::any_of(corners.begin(), corners.end(),
                     [&](LocalIndex v) { return _vertices[v].changed > _slots[t].attempt; });
}

bool MendingQueue::mend(LocalIndex t, Means means) {
  if (swap(t) || smooth(t)) return true;
  const double fraction = _mesh.quality(t) / target_of(t);
  if (means >= Means::moving_cavities && fraction < worth_moving && (contract(t) || move_cavity(t)))
    return true;
  if (is_spared(t)) return false;
  return (means >= Means::new_vertices && fraction < worth_adding && insert_vertex(t)) ||
         (means >= Means::moving_cavities && slide(t)) || (means >= Means::new_vertices && reconnect(t));
}

bool MendingQueue::swap(LocalIndex t) {
  _best.clear();
  const auto keep_trial = [&] { std::swap(_best, _trial); };
  const double least = _mesh.quality(t);
  const double enough = _mesh.measure().target();
  for (const int edge : widest_first(_mesh, t)) {
    const double floor = std::max(least, _best.after);
    if (_edge_removal.propose(_mesh, t, edge, floor, _trial) ||
        _boundary_flip.propose(_mesh, t, edge, floor, _trial)) {
      keep_trial();
    }
    if (_best.after >= enough) break;
  }
  for (int face = 0; face < 4 && _best.after < enough; ++face) {
    if (_face_removal.propose(_mesh, t, face, std::max(least, _best.after), _trial)) keep_trial();
  }
  if (!_best.improves() || !apply(_best)) return false;
  ++_replaced;
  return true;
}

bool MendingQueue::smooth(LocalIndex t) {
  const Corners corners = _mesh.corners(t);
  bool moved = false;
  for (const LocalIndex v : corners) {
    if (_mesh.quality(t) >= target_of(t)) break;
    if (_mesh.is_fixed(v) || !has_changed_since(_vertices[v].smoothed_in_vain, v)) continue;
    if (!_smoothing.smooth(_mesh, v, _star)) {
      _vertices[v].smoothed_in_vain = _now;
      continue;
    }
    moved = true;
    ++_smoothed;
    note_change(_star, t);
  }
  return moved;
}

bool MendingQueue::slide(LocalIndex t) {
  if (!_sliding) return false;
  const Corners corners = _mesh.corners(t);
  bool moved = false;
  for (const LocalIndex v : corners) {
    if (_mesh.quality(t) >= target_of(t)) break;
    if (!has_changed_since(_vertices[v].slid_in_vain, v)) continue;
    if (!_sliding->slide(_mesh, v, _star)) {
      _vertices[v].slid_in_vain = _now;
      continue;
    }
    moved = true;
    ++_slid;
    note_change(_star, t);
  }
  return moved;
}

bool MendingQueue::contract(LocalIndex t) {
  _best.clear();
  const double least = _mesh.quality(t);
  for (const auto& [i, k] : mesh::tetrahedron_edges) {
    const LocalIndex a = _mesh.corners(t)[i], b = _mesh.corners(t)[k];
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      if (_contraction.propose(_mesh, from, to, std::max(least, _best.after), _trial))
        std::swap(_best, _trial);
    }
  }
  if (!_best.improves() || !apply(_best)) return false;
  ++_replaced;
  return true;
}

bool MendingQueue::move_cavity(LocalIndex t) {
  const Corners corners = _mesh.corners(t);
  for (const LocalIndex v : corners) {
    if (_mesh.is_fixed(v) || !has_changed_since(_vertices[v].moved_in_vain, v)) continue;
    _vertices[v].moved_in_vain = _now;
    if (!_insertion.propose_around_vertex(_mesh, v, _trial)) continue;
    const Vec3 origin = _mesh.point(v);
    _mesh.move_vertex(v, _insertion.position(), {});
    if (apply(_trial)) {
      ++_replaced;
      return true;
    }
    _mesh.move_vertex(v, origin, {});
  }
  return false;
}

bool MendingQueue::insert_vertex(LocalIndex t) {
  const int starts = _effort == Effort::unsparing ? CavityInsertion::starts : 1;
  const LocalIndex beside = _mesh.corners(t)[0];
  _best.clear();
  Vec3 position;
  for (int start = 0; start < starts; ++start) {
    if (!_insertion.propose_new_vertex(_mesh, t, start, _trial) || _trial.after <= _best.after) continue;
    if (starts > 1 && !is_allowed_with_vertex(_insertion.position(), beside)) continue;
    std::swap(_best, _trial);
    position = _insertion.position();
  }
  if (!_best.improves()) return false;
  _mesh.add_vertex(position, beside);
  _vertices.push_back({.changed = _now});
  if (apply(_best)) {
    ++_replaced;
    return true;
  }
  _mesh.drop_last_vertex();
  _vertices.pop_back();
  return false;
}

bool MendingQueue::is_allowed_with_vertex(Vec3 position, LocalIndex beside) {
  _mesh.add_vertex(position, beside);
  const bool allowed = is_allowed(_trial);
  _mesh.drop_last_vertex();
  return allowed;
}

bool MendingQueue::reconnect(LocalIndex t) {
  if (!_polyhedron.propose(_mesh, t, _mesh.quality(t), _trial) || !apply(_trial)) return false;
  ++_replaced;
  return true;
}

bool MendingQueue::is_allowed(const Replacement& cavity) {
  for (const Corners& c : cavity.new_tets) {
    if (_mesh.quality_of(c) <= cavity.before || !_mesh.is_positive(c)) return false;
  }
  return _attainable.pays(_mesh, cavity) && _limits.allow(_mesh, cavity) &&
         (!_corners || _corners->added_by(_mesh, cavity) <= 0);
}

bool MendingQueue::apply(const Replacement& cavity) {
  if (!is_allowed(cavity)) return false;
  _mesh.replace(cavity, _placed);
  _slots.resize(_mesh.slot_count());
  for (const LocalIndex t : _placed) _slots[t].attempt = 0;
  note_change(_placed, -1);
  return true;
}

void MendingQueue::note_change(const std::vector<LocalIndex>& tets, LocalIndex deferred) {
  ++_now;
  for (const LocalIndex t : tets) {
    ++_slots[t].version;
    for (const LocalIndex v : _mesh.corners(t)) _vertices[v].changed = _now;
    if (t != deferred) push(t);
  }
}

}  // namespace aeroloom::improve
