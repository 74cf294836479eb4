/// The plane of symmetry of an aircraft, its outline moved outwards as layers move it.
#include "surface/curves/face_loops.hpp"
#include "tests/cad/made_once.hpp"
#include "tests/references.hpp"
#include "tests/surface/plane_fixture.hpp"

namespace aeroloom::surface {
namespace {

using namespace testing;

Model half_transport() {
  cad::DomainOptions options = half_domain(2);
  options.transport = cad::TransportDimensions{};
  return cad::prepare_domain(options).model;
}

/// How far each vertex of the body's outline on the plane y = 0 goes, and where to.
class Outline {
public:
  struct Move {
    SharedVertexKey key;
    Vec3 from, along;
    double distance;
    static constexpr auto fields() {
      return std::tuple(&Move::key, &Move::from, &Move::along, &Move::distance);
    }
  };

  Outline(const Communicator& communicator, const Model& model, const Meshed& meshed, double distance) {
    for (const auto& [face, loops] : gather_loops(meshed.surface, meshed.planes)) {
      std::vector<Vec3> inwards(loops.points.size());
      for (const auto& [a, b] : loops.edges) {
        // The fluid lies at y > 0: its normal out of the plane is (0, -1, 0).
        const Vec3 left = normalized(cross({0, -1, 0}, loops.points[b] - loops.points[a]));
        inwards[a] += left;
        inwards[b] += left;
        _edges.push_back({loops.vertex_keys[a], loops.vertex_keys[b]});
      }
      for (std::size_t v = 0; v < inwards.size(); ++v) {
        const Vec3 p = loops.points[v];
        if (model.body_bounds().contains(p))
          _moves.push_back({loops.vertex_keys[v], p, normalized(inwards[v]), distance});
      }
    }
    _moves = communicator.all_gather_items<Move>(_moves);
    _edges = communicator.all_gather_items<std::array<SharedVertexKey, 2>>(_edges);
    std::sort(_moves.begin(), _moves.end(), [](const Move& a, const Move& b) { return a.key < b.key; });
  }

  std::size_t size() const { return _moves.size(); }
  /// Of these vertices, and of others so that neighbours differ little.
  void shorten(const std::vector<SharedVertexKey>& vertices) {
    constexpr double slope = 0.2;
    for (const SharedVertexKey key : vertices) {
      if (Move* move = find(key)) move->distance *= 0.5;
    }
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& edge : _edges) {
        Move *a = find(edge[0]), *b = find(edge[1]);
        if (a == nullptr || b == nullptr) continue;
        if (a->distance > b->distance) std::swap(a, b);
        const double most = a->distance + slope * distance(a->from, b->from);
        if (b->distance > most) b->distance = most, changed = true;
      }
    }
  }
  std::optional<Vec3> place(SharedVertexKey key) {
    const Move* move = find(key);
    if (move == nullptr) return std::nullopt;
    return Vec3{move->from.x + move->distance * move->along.x, move->from.y,
                move->from.z + move->distance * move->along.z};
  }
  double longest() const { return std::max_element(_moves.begin(), _moves.end(), shorter)->distance; }
  double shortest() const { return std::min_element(_moves.begin(), _moves.end(), shorter)->distance; }

private:
  static bool shorter(const Move& a, const Move& b) { return a.distance < b.distance; }
  Move* find(SharedVertexKey key) {
    const auto at = std::lower_bound(_moves.begin(), _moves.end(), key,
                                     [](const Move& move, SharedVertexKey k) { return move.key < k; });
    return at != _moves.end() && at->key == key ? &*at : nullptr;
  }
  std::vector<Move> _moves;
  std::vector<std::array<SharedVertexKey, 2>> _edges;
};

/// The field hears of segments on the loops of planes that are shorter than it asks for.
void refine_at_loops(Meshed& meshed) {
  constexpr double much_shorter = 1.3;
  std::vector<sizing::SizeSource> sources;
  for (const auto& [face, loops] : gather_loops(meshed.surface, meshed.planes)) {
    for (const auto& [a, b] : loops.edges) {
      const Vec3 middle = 0.5 * (loops.points[a] + loops.points[b]);
      const double length = distance(loops.points[a], loops.points[b]);
      if (meshed.surface.field(middle) > much_shorter * length) sources.push_back({middle, length});
    }
  }
  meshed.surface.field = meshed.surface.field.refined(sources);
}

/// The hash of the surface whose outline has moved.
std::string hash_moved_outline(const Communicator& communicator, const Model& model) {
  const SurfaceOptions options{.piece_triangles = 200};
  Meshed meshed = mesh_model(communicator, model, {1, 20, 25, 1.8}, options);
  Outline outline(communicator, model, meshed, 0.02 * 37.6);
  EXPECT_GT(outline.size(), 30u);
  const auto move = [&] {
    move_vertices([&](SharedVertexKey key, Vec3) { return outline.place(key); }, meshed.surface);
  };
  move();
  int attempts = 1;
  for (; attempts < 40; ++attempts) {
    const PlaneConflicts found = remesh(model, options, meshed);
    if (found.empty()) break;
    outline.shorten(found.vertices);
    move();
  }
  EXPECT_LT(attempts, 40);
  EXPECT_GT(attempts, 1);
  EXPECT_EQ(outline.longest(), 0.02 * 37.6);
  refine_at_loops(meshed);
  EXPECT_TRUE(remesh(model, options, meshed).empty());
  expect_closed(meshed);
  EXPECT_EQ(count_plane_hits(communicator, meshed), 0);
  const PlaneMeasures measures = measure_planes(communicator, meshed);
  EXPECT_EQ(measures.off, 0);
  EXPECT_GT(measures.pieces, 1);
  EXPECT_GT(measures.least_angle, 10);
  return hash_of(meshed.surface);
}

/// An aircraft's outline moves by two hundredths of its length where it can; where it would cross itself, as
/// the stage of layers does it, less.
TEST(AircraftOutline, MovesOutwards) {
  const Model model = cad::made_once(Communicator::world(), half_transport);
  references::expect_as_on_one_rank(
      [&](const Communicator& communicator) { return hash_moved_outline(communicator, model); });
}

}  // namespace
}  // namespace aeroloom::surface
