#include "sizing/field/corner_sizes.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace aeroloom::sizing {
namespace {

constexpr std::size_t corners = 8;

/// Leaves of one size that fill a cube `generations` levels above them.
struct Family {
  int generations;

  std::size_t leaves() const { return std::size_t{1} << 3 * generations; }
  std::size_t corners_along() const { return CornerSizes::corners_along(generations); }
  std::size_t corners() const { return corners_along() * corners_along() * corners_along(); }
  /// Where the first corner of a leaf is among those of all, (z,y,x); leaves in Morton order.
  std::size_t place(std::size_t leaf) const {
    const GridPoint p = grid_point(leaf);
    return p.x + corners_along() * (p.y + corners_along() * p.z);
  }
  /// How far behind that another of its corners is.
  std::size_t step(std::size_t corner) const {
    return (corner & 1) + corners_along() * ((corner >> 1 & 1) + corners_along() * (corner >> 2));
  }
};

/// The largest family that begins with a leaf; leaves from `last` on do not count.
Family family_at(CellSpans leaves, std::size_t leaf, std::size_t last) {
  const int level = leaves.levels[leaf];
  const auto fills = [&](Family family) {
    if (family.generations > level || leaf + family.leaves() > last) return false;
    const std::uint64_t number = leaves.keys[leaf] >> 3 * (finest_level - level);
    if ((number & (family.leaves() - 1)) != 0) return false;
    const auto levels = leaves.levels.subspan(leaf, family.leaves());
    return std::all_of(levels.begin(), levels.end(), [&](int other) { return other == level; });
  };
  Family family{0};
  while (family.generations < CornerSizes::most_generations && fills({family.generations + 1}))
    ++family.generations;
  return family;
}

/// Calls visit(family, its first leaf) along the curve.
template <class Visit>
void for_each_family(CellSpans leaves, IndexRange range, const Visit& visit) {
  for (std::size_t leaf = range.first; leaf < range.last;) {
    const Family family = family_at(leaves, leaf, range.last);
    visit(family, leaf);
    leaf += family.leaves();
  }
}

}  // namespace

IndexRange CornerSizes::part_of(const Octree& octree, parallel::Rank rank) {
  const CellSpans leaves = octree.leaves();
  const auto begin = [&](std::size_t part) {
    const std::size_t even = leaves.size() * part / static_cast<std::size_t>(octree.communicator.size());
    // A family may have begun a few leaves back.
    for (std::size_t leaf = even - std::min(even, Family{most_generations}.leaves() - 1); leaf < even;) {
      leaf += family_at(leaves, leaf, leaves.size()).leaves();
      if (leaf > even) return leaf;
    }
    return even;
  };
  const auto r = static_cast<std::size_t>(rank);
  return {begin(r), begin(r + 1)};
}

std::vector<float> CornerSizes::pack(CellSpans leaves, IndexRange range,
                                     std::span<const float> corner_sizes) {
  std::vector<float> packed;
  for_each_family(leaves, range, [&](Family family, std::size_t first) {
    const std::size_t begin = packed.size();
    packed.resize(begin + family.corners());
    const float* size = corner_sizes.data() + (first - range.first) * corners;
    for (std::size_t leaf = 0; leaf < family.leaves(); ++leaf) {
      const std::size_t place = begin + family.place(leaf);
      for (std::size_t corner = 0; corner < corners; ++corner) packed[place + family.step(corner)] = *size++;
    }
  });
  return packed;
}

std::uint64_t CornerSizes::write_places(CellSpans leaves, IndexRange range, std::uint64_t begin,
                                        std::span<std::uint64_t> to) {
  auto at = to.begin();
  for_each_family(leaves, range, [&](Family family, std::size_t) {
    for (std::size_t leaf = 0; leaf < family.leaves(); ++leaf)
      *at++ = (begin + family.place(leaf)) << place_shift | static_cast<std::uint64_t>(family.generations);
    begin += family.corners();
  });
  return begin;
}

CornerSizes::CornerSizes(const Octree& octree, std::vector<float> own) {
  const parallel::Communicator& communicator = octree.communicator;
  std::vector<std::uint64_t> begins{0};
  for (const auto count : communicator.all_gather_values(static_cast<std::uint64_t>(own.size())))
    begins.push_back(begins.back() + count);
  _packed = parallel::NodeArray<float>::gathered(communicator, std::move(own));
  const auto write = [&](parallel::Rank rank, std::size_t, std::span<std::uint64_t> to) {
    write_places(octree.leaves(), part_of(octree, rank), begins[static_cast<std::size_t>(rank)], to);
  };
  const parallel::Rank rank = communicator.rank();
  std::vector<std::uint64_t> places(part_of(octree, rank).size());
  write(rank, 0, places);
  _places = parallel::NodeArray<std::uint64_t>::composed(communicator, std::move(places), write);
}

CornerSizes CornerSizes::unpacked(const Octree& octree, parallel::NodeArray<float> packed) {
  const CellSpans leaves = octree.leaves();
  std::vector<std::uint64_t> places(leaves.size());
  if (write_places(leaves, {0, leaves.size()}, 0, places) != packed.size())
    throw std::logic_error("corner sizes of an octree with other leaves");
  CornerSizes sizes;
  sizes._packed = packed.shared(octree.communicator);
  sizes._places = parallel::NodeArray<std::uint64_t>(octree.communicator, std::move(places));
  return sizes;
}

}  // namespace aeroloom::sizing
