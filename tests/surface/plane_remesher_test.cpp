/// Planes of symmetry behind layers: meshed again within boundaries that have moved, everything else as it
/// was.
#include "tests/references.hpp"
#include "tests/surface/plane_fixture.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <gp_Trsf.hxx>

namespace aeroloom::surface {
namespace {

using namespace testing;

Model half_ball() {
  return cad::shapes::prepare(BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape(), half_domain(2)).model;
}

/// All vertices of the ball move outwards: the front of layers of that thickness.
void thicken_ball(double thickness, mesh::DistributedMesh& surface) {
  for (mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      if (std::abs(norm(p) - 1) < 1e-6) piece.set_point(v, (1 + thickness) * p);
    }
  }
}

/// Pieces of other faces, without their numbers, in their order, from all ranks.
std::vector<parallel::Bytes> other_pieces(const std::vector<cad::FaceId>& planes,
                                          const mesh::DistributedMesh& surface) {
  const parallel::Communicator& communicator = surface.communicator;
  std::map<mesh::PieceId, parallel::Bytes> pieces;
  for (mesh::Piece piece : surface.pieces) {
    if (is_of(planes, piece)) continue;
    const mesh::PieceId id = std::exchange(piece.id, 0);
    pieces[id] = parallel::to_wire(piece);
  }
  std::map<mesh::PieceId, parallel::Bytes> all;
  for (auto& some : communicator.all_gather_values(pieces)) all.merge(some);
  std::vector<parallel::Bytes> result;
  for (auto& [id, bytes] : all) result.push_back(std::move(bytes));
  return result;
}

constexpr double ball_size = 0.1;
const sizing::SizingOptions ball_sizes{ball_size, 1, 12, 1.3};

TEST(PlaneRemesher, MeshesThePlaneAroundAThickenedBall) {
  const Communicator world = Communicator::world();
  const Model model = half_ball();
  const SurfaceOptions options;
  const Meshed before = mesh_model(world, model, ball_sizes, options);
  ASSERT_EQ(before.planes.size(), 1u);
  for (const double thickness : {0.5 * ball_size, 2 * ball_size, 4 * ball_size}) {
    Meshed meshed = before;
    thicken_ball(thickness, meshed.surface);
    const auto others = other_pieces(meshed.planes, meshed.surface);
    EXPECT_TRUE(remesh(model, options, meshed).empty());
    expect_closed(meshed);
    EXPECT_EQ(count_plane_hits(world, meshed), 0);
    EXPECT_EQ(other_pieces(meshed.planes, meshed.surface), others);
    const PlaneMeasures was = measure_planes(world, before), is = measure_planes(world, meshed);
    EXPECT_EQ(is.off, 0);
    EXPECT_GT(is.least_angle, 25);
    const double band = std::numbers::pi * (std::pow(1 + thickness, 2) - 1);
    EXPECT_NEAR(was.area - is.area, band, 0.02 * band);
  }
}

TEST(PlaneRemesher, IsTheSameOnAnyNumberOfRanks) {
  const Model model = half_ball();
  const SurfaceOptions options{.piece_triangles = 60};
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    Meshed meshed = mesh_model(communicator, model, ball_sizes, options);
    thicken_ball(2 * ball_size, meshed.surface);
    EXPECT_TRUE(remesh(model, options, meshed).empty());
    EXPECT_GT(measure_planes(communicator, meshed).pieces, 3);
    return hash_of(meshed.surface);
  });
}

/// A plane in many pieces, twice: the second time nothing has moved.
TEST(PlaneRemesher, CutsHeavyPlanesIntoPieces) {
  const Communicator world = Communicator::world();
  const Model model = half_ball();
  const SurfaceOptions options{.piece_triangles = 60};
  Meshed meshed = mesh_model(world, model, ball_sizes, options);
  thicken_ball(2 * ball_size, meshed.surface);
  EXPECT_TRUE(remesh(model, options, meshed).empty());
  expect_closed(meshed);
  const PlaneMeasures once = measure_planes(world, meshed);
  EXPECT_GT(once.pieces, 3);
  EXPECT_GT(once.least_angle, 20);
  EXPECT_EQ(once.off, 0);
  const std::string hash = hash_of(meshed.surface);
  EXPECT_TRUE(remesh(model, options, meshed).empty());
  EXPECT_EQ(hash_of(meshed.surface), hash);
}

/// The new pieces come last; what they share with others is classified as there.
TEST(PlaneRemesher, KeepsOrderAndClassification) {
  const Communicator world = Communicator::world();
  const Model model = half_ball();
  Meshed meshed = mesh_model(world, model, ball_sizes, {});
  for (mesh::Piece& piece : meshed.surface.pieces) {
    if (is_of(meshed.planes, piece)) continue;
    for (const mesh::LocalIndex v : piece.shared_vertices)
      piece.vertex_dimension[v] = mesh::CadDimension::region, piece.vertex_entity[v] = 7;
  }
  EXPECT_TRUE(remesh(model, {}, meshed).empty());
  mesh::PieceId last_other = -1, first_plane = meshed.surface.piece_count;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    if (!is_of(meshed.planes, piece)) {
      last_other = std::max(last_other, piece.id);
      continue;
    }
    first_plane = std::min(first_plane, piece.id);
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const bool shared = std::binary_search(piece.shared_vertices.begin(), piece.shared_vertices.end(), v);
      EXPECT_EQ(piece.vertex_dimension[v], shared ? mesh::CadDimension::region : mesh::CadDimension::face);
      EXPECT_EQ(piece.vertex_entity[v], shared ? 7 : meshed.planes.front());
    }
  }
  EXPECT_LT(world.maximum(std::int64_t{last_other}), world.minimum(std::int64_t{first_plane}));
}

/// One vertex goes too far, over the far field: its edges and those that they cross are to blame, and nothing
/// changes.
TEST(PlaneRemesher, BlamesTheVerticesOfEdgesThatCross) {
  const Communicator world = Communicator::world();
  const Model model = half_ball();
  Meshed meshed = mesh_model(world, model, ball_sizes, {});
  const auto on_ball = [](Vec3 p) { return p.y == 0 && std::abs(norm(p) - 1) < 1e-6; };
  std::vector<SharedVertexKey> ball;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
      if (on_ball(piece.point(piece.shared_vertices[s]))) ball.push_back(piece.shared_keys[s]);
  }
  ball = world.all_gather_items<SharedVertexKey>(ball);
  std::sort(ball.begin(), ball.end());
  const SharedVertexKey far = ball[ball.size() / 2];
  move_vertices(
      [&](SharedVertexKey key, Vec3 p) {
        return key == far && on_ball(p) ? std::optional(Vec3{9 * p.x, p.y, 9 * p.z}) : std::nullopt;
      },
      meshed.surface);
  const std::string hash = hash_of(meshed.surface);
  const PlaneConflicts conflicts = remesh(model, {}, meshed);
  EXPECT_TRUE(std::binary_search(conflicts.vertices.begin(), conflicts.vertices.end(), far));
  EXPECT_LT(conflicts.vertices.size(), 10u);
  EXPECT_NE(conflicts.message.find("crosses or touches itself"), std::string::npos) << conflicts.message;
  EXPECT_EQ(hash_of(meshed.surface), hash);
}

TEST(PlaneRemesher, RefusesVerticesBesideThePlane) {
  const Communicator world = Communicator::world();
  const Model model = half_ball();
  Meshed meshed = mesh_model(world, model, ball_sizes, {});
  move_vertices(
      [](SharedVertexKey, Vec3 p) {
        return p.y == 0 && norm(p) < 1.5 ? std::optional(Vec3{p.x, 1e-15, p.z}) : std::nullopt;
      },
      meshed.surface);
  EXPECT_THROW(remesh(model, {}, meshed), parallel::CollectiveError);
}

/// The ball in the corner of a box, turned about the ball's centre by so many degrees.
Model ball_in_corner(double degrees) {
  gp_Trsf turn;
  turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 2, 3)), degrees * std::numbers::pi / 180);
  const TopoDS_Shape fluid = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(3, 3, 3)).Shape(),
                                             BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape())
                                 .Shape();
  return cad::shapes::prepare_fluid(BRepBuilderAPI_Transform(fluid, turn, true).Shape()).model;
}

/// Out of the fluid, of a planar face.
Vec3 normal_of(const Model& model, cad::FaceId face) {
  return normalized(model.face_area_vector(face));
}

/// The planar faces through the ball's centre.
std::vector<cad::FaceId> planes_through_centre(const Model& model) {
  std::vector<cad::FaceId> planes;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_planar(f) && std::abs(dot(normal_of(model, f), model.face_place(f).centre)) < 1e-9)
      planes.push_back(f);
  }
  return planes;
}

/// How far vertices of planes through the centre are off them, at most.
double distance_off_planes(const Communicator& communicator, const Model& model, const Meshed& meshed) {
  double most = 0;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    if (!is_of(meshed.planes, piece)) continue;
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
      most = std::max(most, std::abs(dot(piece.point(v), normal_of(model, piece.common_face()))));
  }
  return communicator.maximum(most);
}

/// Columns at CAD vertices run along lines between two planes, far beyond the next vertices there.
TEST(PlaneRemesher, SpreadsVerticesOnLinesBetweenPlanesAnew) {
  for (const double degrees : {0.0, 25.0}) {
    const Model model = ball_in_corner(degrees);
    references::expect_as_on_one_rank([&](const Communicator& communicator) {
      Meshed meshed = mesh_model(communicator, model, {ball_size, 0.4, 12, 1.3}, {});
      meshed.planes = planes_through_centre(model);
      EXPECT_EQ(meshed.planes.size(), 3u);
      thicken_ball(4 * ball_size, meshed.surface);
      const PlaneConflicts conflicts = remesh(model, {}, meshed);
      EXPECT_TRUE(conflicts.empty()) << conflicts.message;
      expect_closed(meshed);
      EXPECT_EQ(count_plane_hits(communicator, meshed), 0);
      EXPECT_GT(measure_planes(communicator, meshed).least_angle, 20);
      EXPECT_LE(distance_off_planes(communicator, model, meshed), degrees == 0 ? 0 : 1e-13);
      std::string hash = hash_of(meshed.surface);
      EXPECT_TRUE(remesh(model, {}, meshed).empty());
      EXPECT_EQ(hash_of(meshed.surface), hash);
      return hash;
    });
  }
}

}  // namespace
}  // namespace aeroloom::surface
