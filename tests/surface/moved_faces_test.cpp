/// Curved faces behind layers: their mesh follows boundaries that have moved, on the CAD.
#include "surface/moved_faces.hpp"

#include "tests/references.hpp"
#include "tests/surface/plane_fixture.hpp"

#include <cmath>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>

namespace aeroloom::surface {
namespace {

using namespace testing;

/// The fluid in a ball that a rod of a radius of 0.2 pierces along z; optionally the half of it at y > 0.
Model pierced_ball(bool is_half) {
  const gp_Ax2 axis(gp_Pnt(0, 0, -2), gp_Dir(0, 0, 1));
  TopoDS_Shape shape = BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape(),
                                       BRepPrimAPI_MakeCylinder(axis, 0.2, 4).Shape())
                           .Shape();
  if (is_half)
    shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeBox(gp_Pnt(-2, -2, -2), gp_Pnt(2, 0, 2)).Shape()).Shape();
  return cad::shapes::prepare_fluid(shape).model;
}

const sizing::SizingOptions ball_sizes{0.05, 0.1, 12, 1.3};

struct Ends {
  std::vector<cad::FaceId> ball, planes;
};

Ends ends_of(const Model& model) {
  Ends ends;
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    const auto place = model.face_place(face).box;
    if (model.is_planar(face)) {
      ends.planes.push_back(face);
    } else if (place.high.x > 0.5) {
      ends.ball.push_back(face);
    }
  }
  return ends;
}

/// Vertices of the rod go outwards; at its ends they stay on the ball.
void thicken_rod(double thickness, mesh::DistributedMesh& surface) {
  const double shorter = std::sqrt(1 - std::pow(0.2 + thickness, 2)) / std::sqrt(1 - 0.04);
  for (mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      const double radius = std::hypot(p.x, p.y);
      if (std::abs(radius - 0.2) > 1e-6) continue;
      const double outer = (0.2 + thickness) / radius;
      piece.set_point(v, {outer * p.x, p.y == 0 ? 0 : outer * p.y, shorter * p.z});
    }
  }
}

struct Followed {
  double least_angle = 180, farthest = 0, area = 0;
  std::int64_t turned = 0, bent = 0;
};

Followed measure(const std::vector<cad::FaceId>& faces, const mesh::DistributedMesh& surface) {
  Followed found;
  for (const mesh::Piece& piece : surface.pieces) {
    if (!is_of(faces, piece)) continue;
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
      found.farthest = std::max(found.farthest, std::abs(norm(piece.point(v)) - 1));
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      found.least_angle = std::min(found.least_angle, mesh::smallest_angle(a, b, c));
      found.area += 0.5 * norm(cross(b - a, c - a));
      found.turned += dot(cross(b - a, c - a), a + b + c) <= 0;
    }
  }
  const parallel::Communicator& communicator = surface.communicator;
  return {communicator.minimum(found.least_angle), communicator.maximum(found.farthest),
          communicator.sum(found.area), communicator.sum(found.turned)};
}

/// A ball whose face follows the rod, in its parts.
struct Pierced {
  Model model;
  Ends ends = ends_of(model);
  SurfaceOptions options{.piece_triangles = 400};

  Meshed mesh(const Communicator& communicator) const {
    return mesh_model(communicator, model, ball_sizes, options);
  }
  PlaneConflicts follow(const mesh::DistributedMesh& before, Meshed& meshed) const {
    return remesh_moved_faces(model, meshed.surface.field, {ends.ball, ends.planes}, options, before,
                              meshed.surface);
  }
};

TEST(MovedFaces, FollowTheirBoundariesOnTheCad) {
  const Communicator world = Communicator::world();
  const Pierced ball{pierced_ball(false)};
  ASSERT_FALSE(ball.ends.ball.empty());
  const Meshed before = ball.mesh(world);
  for (const double thickness : {0.03, 0.15, 0.3}) {
    Meshed meshed = before;
    thicken_rod(thickness, meshed.surface);
    EXPECT_TRUE(ball.follow(before.surface, meshed).empty());
    expect_closed(meshed);
    EXPECT_TRUE(mesh::find_intersections(meshed.surface).empty());
    const Followed is = measure(ball.ends.ball, meshed.surface),
                   was = measure(ball.ends.ball, before.surface);
    EXPECT_EQ(is.turned, 0);
    EXPECT_LT(is.farthest, 1e-9);
    EXPECT_GT(is.least_angle, 15);
    const auto cap = [](double radius) { return 2 * M_PI * (1 - std::sqrt(1 - radius * radius)); };
    const double lost = 2 * (cap(0.2 + thickness) - cap(0.2));
    EXPECT_NEAR(was.area - is.area, lost, 0.05 * lost);
  }
}

TEST(MovedFaces, SlideAlongTheEdgeWithAPlane) {
  const Communicator world = Communicator::world();
  const Pierced ball{pierced_ball(true)};
  ASSERT_EQ(ball.ends.planes.size(), 2u) << "one on either side of the rod";
  const Meshed before = ball.mesh(world);
  Meshed meshed = before;
  thicken_rod(0.2, meshed.surface);
  EXPECT_TRUE(ball.follow(before.surface, meshed).empty());
  EXPECT_TRUE(
      remesh_planes(ball.model, meshed.surface.field, {ball.ends.planes, ball.options}, meshed.surface)
          .empty());
  expect_closed(meshed);
  EXPECT_TRUE(mesh::find_intersections(meshed.surface).empty());
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    if (!is_of(ball.ends.planes, piece)) continue;
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) EXPECT_EQ(piece.point(v).y, 0);
  }
}

TEST(MovedFaces, AreTheSameOnAnyNumberOfRanks) {
  const Pierced ball{pierced_ball(true)};
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    const Meshed before = ball.mesh(communicator);
    Meshed meshed = before;
    thicken_rod(0.2, meshed.surface);
    EXPECT_TRUE(ball.follow(before.surface, meshed).empty());
    return hash_of(meshed.surface);
  });
}

/// A rod that grows over half of the ball leaves no room for its rim.
TEST(MovedFaces, BlameTheVerticesThatWentTooFar) {
  const Communicator world = Communicator::world();
  const Pierced ball{pierced_ball(false)};
  const Meshed before = ball.mesh(world);
  Meshed meshed = before;
  thicken_rod(-0.35, meshed.surface);
  const PlaneConflicts conflicts = ball.follow(before.surface, meshed);
  EXPECT_FALSE(conflicts.empty());
  EXPECT_NE(conflicts.message.find("turned over near"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::surface
