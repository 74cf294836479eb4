#include "layers/vertex_stars.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/checks/intersection.hpp"
#include "mesh/exchange/rendezvous.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;
using mesh::VertexName;

/// A triangle sent to the rank that collects the star of its vertex. `vertex` is its number here.
struct SentTriangle {
  mesh::SharedVertexKey key;
  std::int64_t vertex;
  StarTriangle triangle;
};

/// A triangle of the star of a local vertex, sent back.
struct StarAnswer {
  std::int64_t vertex;
  StarTriangle triangle;
  auto place() const { return std::tie(vertex, triangle.piece, triangle.cell); }
};

Vec3 normal_of(const LocalWall& wall, std::int32_t t) {
  const auto& [a, b, c] = wall.triangles[t];
  return normalized(cross(wall.points[b] - wall.points[a], wall.points[c] - wall.points[a]));
}

/// The triangles of one piece seen from their corners.
class PieceStars {
public:
  PieceStars(const LocalWall& wall, std::size_t position)
      : _wall(wall), _position(position), _names(mesh::name_vertices(wall.mesh.pieces[position])) {}

  StarTriangle triangle(std::int32_t t, std::int32_t vertex) const {
    const LocalWall::Corners& corners = _wall.triangles[t];
    const int at = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    const std::int32_t base = _wall.first_vertex[_position];
    return {normal_of(_wall, t),
            _wall.points[corners[(at + 1) % 3]],
            _wall.points[corners[(at + 2) % 3]],
            _names[corners[(at + 1) % 3] - base],
            _names[corners[(at + 2) % 3] - base],
            _wall.mesh.pieces[_position].id,
            t - _wall.first_triangle[_position],
            static_cast<std::int32_t>(_wall.roles[t]),
            _wall.faces[t],
            _wall.patches[t],
            static_cast<std::int32_t>(_wall.turn_at(_position, corners[(at + 1) % 3] - base))};
  }

private:
  const LocalWall& _wall;
  std::size_t _position;
  std::vector<VertexName> _names;
};

/// Whether two triangles that share the last edge of the first one are the sides of one triangle of a baffle.
bool are_sides(const StarTriangle& first, const StarTriangle& second) {
  return first.next_point == second.previous_point;
}

/// The triangles in order, each one's last edge the first of the next; empty unless they form one closed fan.
/// Between two vertices on the rim of a baffle may run an edge inside of it, where four triangles meet: those
/// of each side go on with each other.
std::vector<StarTriangle> in_order(std::span<const StarTriangle> star) {
  std::vector<StarTriangle> ordered;
  for (std::size_t at = 0; ordered.empty() || at != 0;) {
    ordered.push_back(star[at]);
    std::size_t following = star.size(), other_side = star.size();
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (!(star[i].next == star[at].previous)) continue;
      std::size_t& found = are_sides(star[at], star[i]) ? other_side : following;
      if (found != star.size()) return {};
      found = i;
    }
    if (following == star.size()) following = other_side;
    if (following == star.size() || ordered.size() > star.size()) return {};
    at = following;
  }
  return ordered.size() == star.size() ? ordered : std::vector<StarTriangle>();
}

StarKind kind_of(std::span<const StarTriangle> star, bool is_closed) {
  const auto has = [&](WallRole role) {
    return std::any_of(star.begin(), star.end(),
                       [&](const StarTriangle& t) { return static_cast<WallRole>(t.role) == role; });
  };
  if (!has(WallRole::layered)) return StarKind::off_wall;
  if (has(WallRole::other)) return StarKind::ending;
  return is_closed ? StarKind::plain : StarKind::broken;
}

/// Normals of the different planes around a vertex that layers end on.
std::vector<Vec3> planes_around(const LocalWall& wall, std::span<const StarTriangle> star) {
  constexpr double same_plane = 1 - 1e-12;  // cosine; as planes are told from other faces
  std::vector<Vec3> planes;
  for (const StarTriangle& t : star) {
    if (static_cast<WallRole>(t.role) != WallRole::plane) continue;
    const Vec3 normal = wall.end_planes[t.face];
    const bool known = std::any_of(planes.begin(), planes.end(),
                                   [&](Vec3 other) { return std::abs(dot(other, normal)) >= same_plane; });
    if (!known) planes.push_back(normal);
  }
  return planes;
}

/// The faces around a vertex that layers end on, ascending; empty unless one is curved.
std::vector<std::int32_t> curved_faces_around(const LocalWall& wall, std::span<const StarTriangle> star) {
  std::vector<std::int32_t> faces;
  bool is_curved = false;
  for (const StarTriangle& t : star) {
    if (t.wall_role() != WallRole::plane) continue;
    faces.push_back(t.face);
    is_curved = is_curved || wall.is_curved_end(t.face);
  }
  if (!is_curved) return {};
  geometry::sort_unique(faces);
  return faces;
}

/// What a column at the rim of these faces follows; nothing where the wall meets one of them too obliquely.
std::optional<EndPlace> find_end(const LocalWall& wall, Vec3 point, std::span<const StarTriangle> star,
                                 std::span<const std::int32_t> faces) {
  const double most_oblique = std::cos(std::numbers::pi / 6);
  for (const std::int32_t face : faces) {
    const Vec3 normal = wall.ends->normal(face, point);
    if (normal == Vec3{}) return std::nullopt;
    for (const StarTriangle& t : star) {
      if (t.wall_role() == WallRole::layered && std::abs(dot(t.normal, normal)) > most_oblique)
        return std::nullopt;
    }
  }
  return wall.ends->place(faces, point);
}

/// Appends the normals of layered triangles, and their mirror images at the planes.
void append_normals(std::span<const StarTriangle> star, std::span<const Vec3> planes,
                    std::vector<Vec3>& normals) {
  const std::size_t first = normals.size();
  for (const StarTriangle& t : star) {
    if (static_cast<WallRole>(t.role) == WallRole::layered) normals.push_back(t.normal);
  }
  for (const Vec3 plane : planes) {
    for (std::size_t i = first, end = normals.size(); i < end; ++i)
      normals.push_back(normals[i] - 2 * dot(plane, normals[i]) * plane);
  }
}

/// The triangles around shared vertices, by vertex of this rank, then piece and triangle.
std::vector<StarAnswer> meet_at_shared_vertices(const LocalWall& wall) {
  std::vector<SentTriangle> sent;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    const PieceStars of_piece(wall, p);
    for (std::size_t c = wall.shared.first(p); c < wall.shared.first(p + 1); ++c) {
      if (!wall.shared.is_shared(c)) continue;
      const std::int32_t v = wall.vertex_of_copy[c];
      const mesh::SharedVertexKey key = wall.mesh.pieces[p].shared_keys[c - wall.shared.first(p)];
      for (const std::int32_t t : wall.triangles_around(v)) sent.push_back({key, v, of_piece.triangle(t, v)});
    }
  }
  const mesh::Rendezvous meeting(
      wall.mesh.communicator, sent, &SentTriangle::key,
      [](const SentTriangle& each) { return std::pair(each.triangle.piece, each.triangle.cell); });
  std::vector<StarAnswer> answers = meeting.answer<StarAnswer>([](const auto& group, const auto& reply) {
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (i > 0 && group[i].item.triangle.piece == group[i - 1].item.triangle.piece) continue;
      for (const auto& other : group) reply(group[i], {group[i].item.vertex, other.item.triangle});
    }
  });
  std::sort(answers.begin(), answers.end(),
            [](const StarAnswer& a, const StarAnswer& b) { return a.place() < b.place(); });
  return answers;
}

/// Adds the ridge of a plain star, if it has one.
void add_ridge(const StarCentre& centre, std::int32_t v, std::span<const StarTriangle> ordered,
               const LocalWall& wall, VertexStars& stars) {
  std::vector<RidgeSide> sides;
  std::optional<Ridge> ridge = find_ridge(centre, ordered, sides);
  if (!ridge) return;
  stars.ridge_of[v] = static_cast<std::int32_t>(stars.ridges.size());
  stars.ridges.push_back(std::move(*ridge));
  for (const std::int32_t t : wall.triangles_around(v)) {
    const TrianglePlace place = wall.place_of(t);
    const auto at = std::find_if(ordered.begin(), ordered.end(), [&](const StarTriangle& other) {
      return other.piece == place.piece && other.cell == place.cell;
    });
    const LocalWall::Corners& corners = wall.triangles[t];
    const auto corner = std::find(corners.begin(), corners.end(), v) - corners.begin();
    stars.sides[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(corner)] =
        sides[static_cast<std::size_t>(at - ordered.begin())];
  }
}

/// The planes of the last vertex that columns there lie in, or what they follow on curved faces.
std::vector<Vec3> find_planes(const LocalWall& wall, std::int32_t v, std::span<const StarTriangle> star,
                              VertexStars& stars) {
  StarKind& kind = stars.kinds.back();
  if (kind != StarKind::plain) return {};
  const std::vector<std::int32_t> faces = curved_faces_around(wall, star);
  if (faces.empty()) {
    std::vector<Vec3> planes = planes_around(wall, star);
    if (planes.size() > 2) kind = StarKind::ending, planes.clear();
    return planes;
  }
  const std::optional<EndPlace> end = find_end(wall, wall.points[v], star, faces);
  if (!end) {
    kind = StarKind::ending;
    return {};
  }
  stars.ends.of[v] = static_cast<std::int32_t>(stars.ends.places.size());
  stars.ends.places.push_back(*end);
  std::vector<Vec3> planes(end->across.begin(), end->across.end());
  if (planes[1] == Vec3{}) planes.pop_back();
  return planes;
}

}  // namespace

VertexStars gather_stars(const LocalWall& wall) {
  const std::vector<StarAnswer> met = meet_at_shared_vertices(wall);
  VertexStars stars;
  stars.first.reserve(wall.points.size() + 1);
  stars.first.push_back(0);
  stars.first_plane.push_back(0);
  stars.ridge_of.assign(wall.points.size(), -1);
  stars.ends.of.assign(wall.points.size(), -1);
  stars.sides.assign(3 * wall.triangles.size(), 0);
  std::vector<StarTriangle> star;
  std::size_t next = 0;
  for (std::size_t p = 0; p < wall.mesh.pieces.size(); ++p) {
    const PieceStars of_piece(wall, p);
    for (std::int32_t v = wall.first_vertex[p]; v < wall.first_vertex[p + 1]; ++v) {
      star.clear();
      for (; next < met.size() && met[next].vertex == v; ++next) star.push_back(met[next].triangle);
      if (star.empty()) {
        for (const std::int32_t t : wall.triangles_around(v)) star.push_back(of_piece.triangle(t, v));
      }
      const std::vector<StarTriangle> ordered = in_order(star);
      stars.kinds.push_back(kind_of(star, !ordered.empty()));
      std::vector<Vec3> planes = find_planes(wall, v, star, stars);
      const EdgeTurn turn = wall.turn_at(p, v - wall.first_vertex[p]);
      const bool may_have = may_be_ridge(turn) && planes.size() < 2 && stars.ends.at(v) == nullptr;
      if (stars.kinds.back() == StarKind::plain && may_have)
        add_ridge({wall.points[v], turn, planes.empty() ? Vec3{} : planes[0]}, v, ordered, wall, stars);
      append_normals(star, planes, stars.normals);
      stars.plane_normals.insert(stars.plane_normals.end(), planes.begin(), planes.end());
      stars.first.push_back(static_cast<std::int64_t>(stars.normals.size()));
      stars.first_plane.push_back(static_cast<std::int64_t>(stars.plane_normals.size()));
    }
  }
  return stars;
}

}  // namespace aeroloom::layers
