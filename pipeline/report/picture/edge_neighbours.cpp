#include "pipeline/report/picture/edge_neighbours.hpp"

#include "mesh/exchange/rendezvous.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace aeroloom::picture {
namespace {

using geometry::Vec3;
using mesh::GlobalIndex;
using mesh::LocalIndex;

/// A side of an edge: which triangle has it, and what others may know of that.
struct TriangleSide {
  std::array<GlobalIndex, 2> ends;  // ascending
  mesh::PieceId piece;
  std::int32_t item;  // 3 * triangle + edge
  Vec3 normal;
  std::int32_t face, patch;
  std::int32_t place;  // of the piece on its rank
  std::int32_t shown;
};

/// The order of the sides of one edge.
std::tuple<mesh::PieceId, std::int32_t> place_of(const TriangleSide& side) {
  return {side.piece, side.item};
}

/// The answer to the rank of a triangle.
struct Answer {
  std::int32_t place, item;
  EdgeNeighbour neighbour;
};

std::vector<TriangleSide> sides_of(const mesh::NumberedMesh& surface, const Shown& shown, std::size_t place) {
  const mesh::Piece& piece = surface.pieces[place];
  const std::vector<GlobalIndex>& numbers = surface.numbering.vertices[place];
  std::vector<TriangleSide> sides;
  sides.reserve(3 * static_cast<std::size_t>(piece.cell_count()));
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    const Vec3 normal = normalized(area_normal(piece, t));
    for (int i = 0; i < 3; ++i) {
      std::array<GlobalIndex, 2> ends = {numbers[v[i]], numbers[v[(i + 1) % 3]]};
      if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
      sides.push_back({ends, piece.id, 3 * t + i, normal, piece.triangle_face[t], piece.triangle_patch[t],
                       static_cast<std::int32_t>(place), shown[place][t]});
    }
  }
  return sides;
}

const TriangleSide& side_of(const TriangleSide& side) {
  return side;
}
const TriangleSide& side_of(const mesh::Received<TriangleSide>& received) {
  return received.item;
}

/// Calls visit(member, fold) for each side of an edge that others have too.
template <class Member, class Visit>
void for_each_neighbour(std::span<const Member> run, const Visit& visit) {
  if (run.size() < 2) return;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const TriangleSide& next = side_of(run[(i + 1) % run.size()]);
    visit(run[i], EdgeNeighbour{next.normal, next.face, next.patch, run.size() > 2, next.shown != 0});
  }
}

}  // namespace

double angle_at(Vec3 normal, Vec3 edge, const EdgeNeighbour& neighbour) {
  // Normals point into the wall: what is convex for the flow is concave from there.
  return -std::atan2(dot(cross(normal, neighbour.normal), normalized(edge)), dot(normal, neighbour.normal));
}

EdgeNeighbours find_edge_neighbours(const mesh::NumberedMesh& surface, const Shown& shown) {
  const parallel::Communicator& communicator = surface.communicator;
  EdgeNeighbours neighbours(surface.pieces.size());
  std::vector<TriangleSide> travelling;
  const auto match_within = [&](std::size_t p) {
    const mesh::Piece& piece = surface.pieces[p];
    neighbours[p].resize(3 * static_cast<std::size_t>(piece.cell_count()));
    std::vector<std::uint8_t> shared(piece.vertex_count(), 0);
    for (const LocalIndex v : piece.shared_vertices) shared[v] = 1;
    std::vector<TriangleSide> sides = sides_of(surface, shown, p);
    std::sort(sides.begin(), sides.end(), [](const TriangleSide& a, const TriangleSide& b) {
      return a.ends != b.ends ? a.ends < b.ends : place_of(a) < place_of(b);
    });
    mesh::for_each_key(sides, &TriangleSide::ends, [&](std::span<const TriangleSide> run) {
      const std::int32_t item = run.front().item;
      const LocalIndex* v = piece.cell(item / 3);
      if (run.size() == 1 && shared[v[item % 3]] && shared[v[(item % 3 + 1) % 3]]) {
        travelling.push_back(run.front());
      } else {
        for_each_neighbour(run, [&](const TriangleSide& side, const EdgeNeighbour& neighbour) {
          neighbours[p][side.item] = neighbour;
        });
      }
    });
  };
  parallel::agree(communicator, [&] {
    for (std::size_t p = 0; p < surface.pieces.size(); ++p) match_within(p);
  });
  const mesh::Rendezvous meeting(communicator, travelling, &TriangleSide::ends, place_of);
  const auto answers = meeting.answer<Answer>([](const auto& run, const auto& reply) {
    for_each_neighbour(run,
                       [&](const mesh::Received<TriangleSide>& received, const EdgeNeighbour& neighbour) {
                         reply(received, {received.item.place, received.item.item, neighbour});
                       });
  });
  for (const Answer& answer : answers) neighbours[answer.place][answer.item] = answer.neighbour;
  return neighbours;
}

}  // namespace aeroloom::picture
