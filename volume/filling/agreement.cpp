#include "volume/filling/agreement.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/sort_unique.hpp"
#include "mesh/exchange/rendezvous.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::volume {

namespace {

/// A face as it is sent to the rank that matches it.
struct WireFace {
  std::array<mesh::SharedVertexKey, 3> vertices;
  ZoneIndex zone;
  mesh::RegionId region;
  std::int32_t index;  ///< in its rank's list, times two, plus its orientation

  bool odd() const { return index & 1; }
};

bool are_partners(const WireFace& a, const WireFace& b) {
  return a.zone != b.zone && a.region == b.region && a.odd() != b.odd();
}

}  // namespace

std::vector<ZoneFace> find_unmatched(const parallel::Communicator& communicator,
                                     std::span<const ZoneFace> faces) {
  std::vector<ZoneFace> mine;
  {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    std::vector<WireFace> sent;
    sent.reserve(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const ZoneFace& face = faces[i];
      sent.push_back({face.vertices, face.zone, face.region, static_cast<std::int32_t>(2 * i) + face.odd});
    }
    const mesh::Rendezvous meeting(communicator, sent, &WireFace::vertices, &WireFace::zone);
    const auto unmatched = meeting.answer<std::int32_t>([](const auto& group, const auto& reply) {
      if (group.size() == 2 && are_partners(group[0].item, group[1].item)) return;
      for (const auto& received : group) reply(received, received.item.index / 2);
    });
    for (const std::int32_t face : unmatched) mine.push_back(faces[face]);
  }
  return communicator.gather_sorted(
      mine, [](const ZoneFace& face) { return std::tie(face.vertices, face.zone, face.odd); });
}

std::vector<DisputedPlace> find_places(std::span<const ZoneFace> unmatched) {
  struct Use {
    mesh::SharedVertexKey vertex;
    std::int32_t face;
  };
  std::vector<Use> uses;
  for (std::size_t f = 0; f < unmatched.size(); ++f) {
    for (const mesh::SharedVertexKey v : unmatched[f].vertices)
      uses.push_back({v, static_cast<std::int32_t>(f)});
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.face < b.face;
  });
  geometry::DisjointSets<std::int32_t> sets(unmatched.size());
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].vertex == uses[i - 1].vertex) sets.unite(uses[i - 1].face, uses[i].face);
  }
  std::vector<std::int32_t> number(unmatched.size(), -1);
  std::vector<DisputedPlace> places;
  for (std::size_t f = 0; f < unmatched.size(); ++f) {
    std::int32_t& n = number[sets.root(static_cast<std::int32_t>(f))];
    if (n < 0) {
      n = static_cast<std::int32_t>(places.size());
      places.emplace_back();
    }
    DisputedPlace& place = places[n];
    ++place.faces;
    place.zones.push_back(unmatched[f].zone);
    for (const LeafNumber leaf : unmatched[f].leaves) {
      if (leaf >= 0) place.leaves.push_back(leaf);
    }
  }
  for (DisputedPlace& place : places) {
    geometry::sort_unique(place.zones);
    geometry::sort_unique(place.leaves);
  }
  return places;
}

}  // namespace aeroloom::volume
