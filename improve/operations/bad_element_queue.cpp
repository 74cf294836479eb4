#include "improve/operations/bad_element_queue.hpp"

#include <algorithm>

namespace aeroloom::improve {
namespace {

// The heap's top is its greatest element: the worst quality, then the lowest slot.
constexpr auto later = [](const auto& a, const auto& b) {
  return a.quality != b.quality ? a.quality > b.quality : a.tet > b.tet;
};

}  // namespace

BadElementQueue::BadElementQueue(const TetMesh& mesh, const LocalTarget& local_target,
                                 int last_level_in_narrow_regions)
    : _mesh(mesh),
      _local_target(local_target),
      _last_level_in_narrow_regions(last_level_in_narrow_regions),
      _slots(mesh.slot_count()),
      _changed(mesh.vertex_count(), start) {}

std::int64_t BadElementQueue::fill() {
  _heap.clear();
  for (LocalIndex t = 0; t < _mesh.slot_count(); ++t) {
    if (_mesh.is_alive(t) && _mesh.quality(t) < target_of(t)) {
      _heap.push_back({_mesh.quality(t), t, _slots[t].version});
    }
  }
  std::make_heap(_heap.begin(), _heap.end(), later);
  return static_cast<std::int64_t>(_heap.size());
}

std::optional<LocalIndex> BadElementQueue::pop(int level) {
  while (!_heap.empty()) {
    std::pop_heap(_heap.begin(), _heap.end(), later);
    const Task task = _heap.back();
    _heap.pop_back();
    if (task.version == _slots[task.tet].version && _mesh.is_alive(task.tet) &&
        is_worth_trying(task.tet, level))
      return task.tet;
  }
  return std::nullopt;
}

void BadElementQueue::push(LocalIndex t) {
  if (_mesh.quality(t) >= target_of(t)) return;
  _heap.push_back({_mesh.quality(t), t, _slots[t].version});
  std::push_heap(_heap.begin(), _heap.end(), later);
}

bool BadElementQueue::is_worth_trying(LocalIndex t, int level) const {
  const SlotHistory& slot = _slots[t];
  if (slot.attempt == 0) return true;
  // In narrow regions a try rarely succeeds, but changes what the next one finds, and no other operation
  // follows.
  if (slot.attempt_level >= _last_level_in_narrow_regions && skips_costly(t)) return false;
  if (slot.attempt_level < level) return true;
  const Corners& corners = _mesh.corners(t);
  return std::any_of(corners.begin(), corners.end(),
                     [&](LocalIndex v) { return has_changed_since(slot.attempt, v); });
}

void BadElementQueue::note_failure(LocalIndex t, int level) {
  _slots[t].attempt = _now;
  _slots[t].attempt_level = static_cast<std::int8_t>(level);
}

void BadElementQueue::note_new(const std::vector<LocalIndex>& tets) {
  _slots.resize(_mesh.slot_count());
  _changed.resize(_mesh.vertex_count(), start);
  for (const LocalIndex t : tets) _slots[t].attempt = 0;
  note_moved(tets, -1);
}

void BadElementQueue::note_moved(const std::vector<LocalIndex>& tets, LocalIndex deferred) {
  ++_now;
  for (const LocalIndex t : tets) {
    ++_slots[t].version;
    for (const LocalIndex v : _mesh.corners(t)) _changed[v] = _now;
    if (t != deferred) push(t);
  }
}

void BadElementQueue::rest_all_but(const std::vector<LocalIndex>& fresh, int level) {
  for (LocalIndex t = 0; t < _mesh.slot_count(); ++t) note_failure(t, level);
  note_new(fresh);
}

}  // namespace aeroloom::improve
