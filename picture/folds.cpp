#include "picture/folds.hpp"

#include "geometry/runs.hpp"
#include "mesh/delivery.hpp"
#include "mesh/mixing.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

namespace aeroloom::picture {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;

/// A side of an edge: which triangle has it, and what others may know of that.
struct Side {
  std::array<GlobalIndex, 2> ends;  // ascending
  mesh::PieceId piece;
  std::int32_t item;  // 3 * triangle + edge
  Vec3 normal;
  std::int32_t face, patch;
  parallel::Rank rank;
  std::int32_t place;  // of the piece on its rank
  std::int64_t shown;
};

bool precedes(const Side& a, const Side& b) {
  return std::tie(a.ends, a.piece, a.item) < std::tie(b.ends, b.piece, b.item);
}

/// What is told to the rank of a triangle.
struct Answer {
  parallel::Rank rank;
  std::int32_t place, item;
  Fold fold;
};

std::vector<Side> sides_of(const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                           const Shown& shown, std::size_t place, parallel::Rank rank) {
  const mesh::Piece& piece = surface.pieces[place];
  const std::vector<GlobalIndex>& numbers = numbering.vertices[place];
  std::vector<Side> sides;
  sides.reserve(3 * static_cast<std::size_t>(piece.cell_count()));
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    const Vec3 normal = normalized(area_normal(piece, t));
    for (int i = 0; i < 3; ++i) {
      std::array<GlobalIndex, 2> ends = {numbers[v[i]], numbers[v[(i + 1) % 3]]};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      sides.push_back({ends, piece.id, 3 * t + i, normal, piece.triangle_face[t], piece.triangle_patch[t],
                       rank, static_cast<std::int32_t>(place), shown[place][t]});
    }
  }
  return sides;
}

/// Calls tell(side, fold) for each side of an edge that others have too.
template <class Tell>
void tell_each(std::span<const Side> run, const Tell& tell) {
  if (run.size() < 2) return;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const Side& next = run[(i + 1) % run.size()];
    tell(run[i], Fold{next.normal, next.face, next.patch, run.size() > 2, next.shown != 0});
  }
}

template <class Visit>
void for_each_edge(std::vector<Side>& sides, const Visit& visit) {
  std::sort(sides.begin(), sides.end(), precedes);
  const std::span<const Side> all(sides);
  geometry::for_each_run(
      all, [](const Side& a, const Side& b) { return a.ends == b.ends; },
      [&](std::size_t begin, std::size_t end) { visit(all.subspan(begin, end - begin)); });
}

}  // namespace

double turn(Vec3 normal, Vec3 edge, const Fold& beyond) {
  // Normals point into the wall: what is convex for the flow is concave from there.
  return -std::atan2(dot(cross(normal, beyond.normal), normalized(edge)), dot(normal, beyond.normal));
}

Folds find_folds(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                 const mesh::Numbering& numbering, const Shown& shown) {
  Folds folds(surface.pieces.size());
  std::vector<Side> travelling;
  const auto match_within = [&](std::size_t p) {
    const mesh::Piece& piece = surface.pieces[p];
    folds[p].resize(3 * static_cast<std::size_t>(piece.cell_count()));
    std::vector<std::uint8_t> shared(piece.vertex_count(), 0);
    for (const LocalIndex v : piece.shared_vertices) shared[v] = 1;
    std::vector<Side> sides = sides_of(surface, numbering, shown, p, communicator.rank());
    for_each_edge(sides, [&](std::span<const Side> run) {
      const std::int32_t item = run.front().item;
      const LocalIndex* v = piece.cell(item / 3);
      if (run.size() == 1 && shared[v[item % 3]] && shared[v[(item % 3 + 1) % 3]]) {
        travelling.push_back(run.front());
      } else {
        tell_each(run, [&](const Side& side, const Fold& fold) { folds[p][side.item] = fold; });
      }
    });
  };
  parallel::agree(communicator, [&] {
    for (std::size_t p = 0; p < surface.pieces.size(); ++p) match_within(p);
  });
  std::vector<Side> met = mesh::deliver(communicator, std::move(travelling), [&](const Side& side) {
    const std::uint64_t mixed =
        mesh::mix_in(static_cast<std::uint64_t>(side.ends[0]), static_cast<std::uint64_t>(side.ends[1]));
    return mesh::meeting_rank(mixed, communicator.size());
  });
  std::vector<Answer> answers;
  parallel::agree(communicator, [&] {
    for_each_edge(met, [&](std::span<const Side> run) {
      tell_each(run, [&](const Side& side, const Fold& fold) {
        answers.push_back({side.rank, side.place, side.item, fold});
      });
    });
  });
  for (const Answer& answer :
       mesh::deliver(communicator, std::move(answers), [](const Answer& each) { return each.rank; })) {
    folds[answer.place][answer.item] = answer.fold;
  }
  return folds;
}

}  // namespace aeroloom::picture
