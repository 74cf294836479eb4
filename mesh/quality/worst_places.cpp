#include "mesh/quality/worst_places.hpp"

#include <algorithm>
#include <cstddef>
#include <set>
#include <span>

namespace aeroloom::mesh {

namespace {

constexpr std::size_t kept_places = 10;

/// Collective.
std::vector<FlawedCell> worst_of_ranks(const parallel::Communicator& communicator,
                                       const std::vector<FlawedCell>& mine) {
  std::vector<FlawedCell> all = communicator.all_gather_items(std::span<const FlawedCell>(mine));
  std::sort(all.begin(), all.end(), is_worse);
  if (all.size() > kept_places) all.resize(kept_places);
  return all;
}

}  // namespace

void PlaceSearch::keep(List& list, const FlawedCell& candidate) {
  if (list.size() == kept_places && !is_worse(candidate, list.back())) return;
  list.insert(std::upper_bound(list.begin(), list.end(), candidate, is_worse), candidate);
  if (list.size() > kept_places) list.pop_back();
}

void PlaceSearch::add(const CellToJudge& cell) {
  const auto flawed = [&](Flaw flaw, double value) {
    return FlawedCell{value, severity_of(flaw, value), cell.cell, cell.shape, flaw, cell.center};
  };
  const auto list = [&](Flaw flaw) -> List& { return _of[static_cast<std::size_t>(flaw)]; };
  if (cell.in_layers || cell.shape != CellShape::tetrahedron) {
    keep(list(Flaw::bad_shape), flawed(Flaw::bad_shape, cell.shape_value));
  } else {
    keep(list(Flaw::small_angle), flawed(Flaw::small_angle, cell.angle));
    keep(_tets_by_shape, flawed(Flaw::bad_shape, cell.shape_value));
  }
  if (cell.jump > 0) keep(list(Flaw::size_jump), flawed(Flaw::size_jump, cell.jump));
}

WorstPlaces PlaceSearch::find(const parallel::Communicator& communicator, bool layers_unknown) const {
  std::array<List, flaw_count> lists = _of;
  if (layers_unknown) {
    lists[static_cast<std::size_t>(Flaw::small_angle)].clear();
    for (const FlawedCell& tet : _tets_by_shape) keep(lists[static_cast<std::size_t>(Flaw::bad_shape)], tet);
  }
  WorstPlaces places;
  for (const Flaw flaw : {Flaw::small_angle, Flaw::bad_shape, Flaw::size_jump}) {
    const auto f = static_cast<std::size_t>(flaw);
    places.of[f] = worst_of_ranks(communicator, lists[f]);
  }
  list_worst_of_all(places);
  return places;
}

void list_worst_of_all(WorstPlaces& places) {
  std::vector<FlawedCell> candidates;
  for (const std::vector<FlawedCell>& of : places.of)
    candidates.insert(candidates.end(), of.begin(), of.end());
  std::stable_sort(candidates.begin(), candidates.end(), is_worse);
  places.all.clear();
  std::set<GlobalIndex> seen;
  for (const FlawedCell& each : candidates) {
    if (places.all.size() < kept_places && seen.insert(each.cell).second) places.all.push_back(each);
  }
}

}  // namespace aeroloom::mesh
