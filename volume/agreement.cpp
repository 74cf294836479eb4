#include "volume/agreement.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/runs.hpp"
#include "mesh/delivery.hpp"
#include "mesh/mixing.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aeroloom::volume {

namespace {

/// What travels of a face.
struct WireFace {
  std::array<mesh::SharedToken, 3> vertices;
  ZoneIndex zone;
  mesh::RegionId region;
  parallel::Rank rank;  ///< where the face is
  std::int32_t index;   ///< in that rank's list, times two, plus its turn

  bool odd() const { return index & 1; }
};

bool before(const WireFace& a, const WireFace& b) {
  return a.vertices != b.vertices ? a.vertices < b.vertices : a.zone < b.zone;
}

}  // namespace

std::vector<ZoneFace> find_unmatched(const parallel::Communicator& communicator,
                                     std::span<const ZoneFace> faces, parallel::StageClock& clock) {
  std::vector<WireFace> outgoing;
  outgoing.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const ZoneFace& face = faces[i];
    outgoing.push_back({face.vertices, face.zone, face.region, communicator.rank(),
                        static_cast<std::int32_t>(2 * i) + face.odd});
  }
  std::vector<WireFace> met = mesh::deliver(communicator, std::move(outgoing), [&](const WireFace& face) {
    std::uint64_t mixed = 0;
    for (const mesh::SharedToken v : face.vertices) mixed = mesh::mix_in(mixed, v);
    return mesh::meeting_rank(mixed, communicator.size());
  });
  std::vector<WireFace> alone;
  {
    const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
    std::sort(met.begin(), met.end(), before);
    const auto same = [](const WireFace& a, const WireFace& b) { return a.vertices == b.vertices; };
    geometry::for_each_run(std::span<const WireFace>(met), same, [&](std::size_t i, std::size_t j) {
      const bool fit = j - i == 2 && met[i].zone != met[i + 1].zone && met[i].region == met[i + 1].region &&
                       met[i].odd() != met[i + 1].odd();
      if (!fit)
        alone.insert(alone.end(), met.begin() + static_cast<std::ptrdiff_t>(i),
                     met.begin() + static_cast<std::ptrdiff_t>(j));
    });
  }
  std::vector<ZoneFace> mine;
  for (const WireFace& face :
       mesh::deliver(communicator, std::move(alone), [](const WireFace& f) { return f.rank; }))
    mine.push_back(faces[face.index / 2]);
  std::vector<ZoneFace> all = communicator.all_gather_items<ZoneFace>(mine);
  std::sort(all.begin(), all.end(), [](const ZoneFace& a, const ZoneFace& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices
           : a.zone != b.zone       ? a.zone < b.zone
                                    : a.odd < b.odd;
  });
  return all;
}

std::vector<DisputedPlace> find_places(std::span<const ZoneFace> unmatched) {
  struct Use {
    mesh::SharedToken vertex;
    std::int32_t face;
  };
  std::vector<Use> uses;
  for (std::size_t f = 0; f < unmatched.size(); ++f) {
    for (const mesh::SharedToken v : unmatched[f].vertices) uses.push_back({v, static_cast<std::int32_t>(f)});
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
    std::sort(place.zones.begin(), place.zones.end());
    place.zones.erase(std::unique(place.zones.begin(), place.zones.end()), place.zones.end());
    std::sort(place.leaves.begin(), place.leaves.end());
    place.leaves.erase(std::unique(place.leaves.begin(), place.leaves.end()), place.leaves.end());
  }
  return places;
}

}  // namespace aeroloom::volume
