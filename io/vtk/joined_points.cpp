#include "io/vtk/joined_points.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

/// A point on its way to the rank that compares those of its place.
struct PlacedPoint {
  std::array<std::uint64_t, 3> bits;
  GlobalIndex id;
};

PlacedPoint placed(const RawMesh& raw, std::size_t point) {
  PlacedPoint result{{}, raw.point_ids[point]};
  for (std::size_t k = 0; k < 3; ++k)
    result.bits[k] = std::bit_cast<std::uint64_t>(raw.coordinates[3 * point + k]);
  return result;
}

parallel::Rank comparing_rank(const PlacedPoint& point, int ranks) {
  std::uint64_t hash = 0;
  for (const std::uint64_t bits : point.bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29;
  }
  return static_cast<parallel::Rank>(hash % static_cast<std::uint64_t>(ranks));
}

/// The lowest id of the place of each point, in the order they came in.
std::vector<GlobalIndex> lowest_ids(const std::vector<PlacedPoint>& points) {
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].bits, points[a].id) < std::pair(points[b].bits, points[b].id);
  });
  std::vector<GlobalIndex> lowest(points.size());
  for (std::size_t i = 0, first = 0; i < order.size(); ++i) {
    if (points[order[i]].bits != points[order[first]].bits) first = i;
    lowest[order[i]] = points[order[first]].id;
  }
  return lowest;
}

/// The joined id of each point on this rank.
std::vector<GlobalIndex> find_joined(const RawMesh& raw) {
  const parallel::Communicator& communicator = raw.file.communicator;
  std::map<parallel::Rank, std::vector<PlacedPoint>> outgoing;
  for (std::size_t i = 0; i < raw.point_ids.size(); ++i) {
    const PlacedPoint point = placed(raw, i);
    outgoing[comparing_rank(point, communicator.size())].push_back(point);
  }
  std::vector<parallel::Parcel> parcels;
  for (auto& [rank, points] : outgoing) {
    parcels.push_back({rank, parallel::to_bytes(std::span<const PlacedPoint>(points))});
    std::vector<PlacedPoint>().swap(points);
  }
  std::vector<PlacedPoint> points;
  std::vector<std::pair<parallel::Rank, std::size_t>> counts;
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    const auto came = parallel::from_bytes<PlacedPoint>(parcel.content);
    parallel::Bytes().swap(parcel.content);
    counts.emplace_back(parcel.rank, came.size());
    points.insert(points.end(), came.begin(), came.end());
  }
  const std::vector<GlobalIndex> lowest = lowest_ids(points);
  std::vector<parallel::Parcel> replies;
  std::size_t begin = 0;
  for (const auto& [rank, count] : counts) {
    replies.push_back({rank, parallel::to_bytes(std::span(lowest).subspan(begin, count))});
    begin += count;
  }
  std::map<parallel::Rank, std::vector<GlobalIndex>> answers;
  for (const parallel::Parcel& parcel : communicator.exchange(std::move(replies)))
    answers[parcel.rank] = parallel::from_bytes<GlobalIndex>(parcel.content);
  std::map<parallel::Rank, std::size_t> taken;
  std::vector<GlobalIndex> joined(raw.point_ids.size());
  for (std::size_t i = 0; i < joined.size(); ++i) {
    const parallel::Rank rank = comparing_rank(placed(raw, i), communicator.size());
    joined[i] = answers[rank][taken[rank]++];
  }
  return joined;
}

}  // namespace

void join_equal_points(RawMesh& raw) {
  const std::vector<GlobalIndex> joined = find_joined(raw);
  const GlobalIndex first = raw.point_ids.empty() ? 0 : raw.point_ids.front();
  const auto replace = [&](std::vector<GlobalIndex>& corners) {
    for (GlobalIndex& v : corners) v = joined.at(static_cast<std::size_t>(v - first));
  };
  for (auto& corners : raw.cells) replace(corners);
  for (auto& corners : raw.faces) replace(corners);
  raw.point_ids = joined;
}

}  // namespace aeroloom::io
