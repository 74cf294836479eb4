#include "pipeline/widen_interfaces.hpp"

#include "mesh/delivery.hpp"
#include "parallel/schedule.hpp"
#include "pipeline/interface_angles.hpp"

#include <algorithm>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;

constexpr int most_rounds = 6;

struct VertexMove {
  GlobalIndex number;
  Vec3 displacement;
};

/// The mean of the wishes for each vertex, on every rank: few vertices are concerned.
std::vector<VertexMove> agree_on_moves(const parallel::Communicator& communicator,
                                       const std::vector<VertexWish>& mine) {
  std::vector<VertexWish> wishes = communicator.all_gather_items<VertexWish>(mine);
  std::stable_sort(wishes.begin(), wishes.end(), [](const VertexWish& a, const VertexWish& b) {
    return a.number != b.number ? a.number < b.number : a.part < b.part;
  });
  std::vector<VertexMove> moves;
  for (std::size_t i = 0, j = 0; i < wishes.size(); i = j) {
    Vec3 sum;
    for (; j < wishes.size() && wishes[j].number == wishes[i].number; ++j) sum += wishes[j].displacement;
    moves.push_back({wishes[i].number, sum / static_cast<double>(j - i)});
  }
  return moves;
}

void apply(const std::vector<VertexMove>& moves, InterfaceMesh& interfaces) {
  for (BoundaryPoint& vertex : interfaces.vertices) {
    const auto at =
        std::lower_bound(moves.begin(), moves.end(), vertex.number,
                         [](const VertexMove& m, GlobalIndex number) { return m.number < number; });
    if (at != moves.end() && at->number == vertex.number) vertex.point += at->displacement;
  }
}

}  // namespace

std::int64_t widen_interfaces(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              const VolumePlan& plan, double wanted, InterfaceMesh& interfaces,
                              parallel::StageClock& clock) {
  const MergedParts parts = merge_at_failed(plan, interfaces);
  const std::vector<parallel::Rank> owners = parallel::assign_largest_first(plan.loads, communicator.size());
  std::vector<char> concerned(plan.parts, 0);
  for (const InterfaceFace& face : plan.faces)
    concerned[parts.root(face.part)] = concerned[parts.root(face.beyond)] = 1;
  std::int64_t moved = 0;
  for (int round = 0; round < most_rounds; ++round) {
    if (std::find(concerned.begin(), concerned.end(), 1) == concerned.end()) break;
    std::vector<VertexWish> wishes;
    const std::vector<PieceBoundary> boundaries =
        gather_boundaries(communicator, {surface, numbering, interfaces}, plan, parts, concerned, owners);
    {
      const parallel::ScopedCpu task(clock, parallel::ScopedCpu::As::task);
      for (std::int32_t p = 0; p < plan.parts; ++p) {
        if (!concerned[p] || owners[p] != communicator.rank()) continue;
        const auto more = wish_wider_angles(boundaries[p], plan, parts, p, wanted);
        wishes.insert(wishes.end(), more.begin(), more.end());
      }
    }
    const std::vector<VertexMove> moves = agree_on_moves(communicator, wishes);
    moved += static_cast<std::int64_t>(moves.size());
    apply(moves, interfaces);
    std::vector<std::int32_t> touched;
    for (const VertexWish& wish : wishes) touched.push_back(wish.part);
    std::fill(concerned.begin(), concerned.end(), 0);
    for (const std::int32_t part : communicator.all_gather_items<std::int32_t>(touched)) concerned[part] = 1;
  }
  return moved;
}

}  // namespace aeroloom::pipeline
