/// The borders of narrow faces vanish from the mesh, whole or in pieces, and the surface stays what it was.
#include "cad/model/topology/joined_faces.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "sizing/features/narrow_faces.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/strip_shapes.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::Model;
using geometry::Vec3;
using parallel::Communicator;

constexpr double size = 0.12, strip_degrees = 1.5;

Model joined_cylinder(const Communicator& communicator) {
  const Model apart = cad::shapes::split_cylinder(strip_degrees, 2);
  auto narrow = sizing::find_narrow_faces(communicator, apart, size, 0.05 * size);
  return cad::join_faces(apart, sizing::group_narrow_faces(apart, narrow, 0.05 * size));
}

/// The side in three faces, joined: a strip between two wide ones, splines that end where the faces do.
Model joined_spline_cylinder() {
  const Model apart = cad::shapes::spline_cylinder(strip_degrees, 2);
  std::vector<cad::FaceId> side;
  for (cad::FaceId f = 0; f < apart.face_count(); ++f) {
    if (!apart.is_planar(f)) side.push_back(f);
  }
  return cad::join_faces(apart, {side});
}

struct Meshed {
  SurfaceMesh surface;
};

Meshed mesh_model(const Communicator& communicator, const Model& model, const SurfaceOptions& options) {
  const sizing::SizeField field = sizing::build_size_field(communicator, model, {size, size, 30, 1.3, 0});
  return {mesh_surface(model, field, options)};
}

void expect_sound(const Meshed& meshed) {
  const Communicator& communicator = meshed.surface.communicator;
  const auto report = mesh::check_surface_mesh(meshed.surface);
  EXPECT_TRUE(report.valid()) << report.violations.front();
  const double volume = 2 * std::numbers::pi;
  EXPECT_NEAR(report.volume, volume, 0.01 * volume);
  std::int64_t small = 0, off = 0;
  for (const mesh::Piece& piece : meshed.surface.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 p = piece.point(v);
      const double radius = std::hypot(p.x, p.y);
      const bool on_side = std::abs(radius - 1) < 1e-7;
      const bool on_end = std::abs(p.z) < 1e-9 || std::abs(p.z - 2) < 1e-9;
      off += !(on_side || (on_end && radius < 1));
    }
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const Vec3 a = piece.point(v[0]), b = piece.point(v[1]), c = piece.point(v[2]);
      const double middle = (a.z + b.z + c.z) / 3;
      if (middle < 0.5 || middle > 1.5)
        continue;  // near the ends the strip's short edges ask for their length
      small += std::min({distance(a, b), distance(b, c), distance(c, a)}) < 0.5 * size;
    }
  }
  EXPECT_EQ(communicator.sum(off), 0);
  EXPECT_EQ(communicator.sum(small), 0);
}

void expect_no_trace(const Communicator& communicator, const Model& model) {
  ASSERT_EQ(model.face_count(), 3);
  for (const std::int64_t piece_triangles : {50'000, 150}) {
    const Meshed meshed = mesh_model(communicator, model, {.piece_triangles = piece_triangles});
    expect_sound(meshed);
    EXPECT_EQ(meshed.surface.report.divided_faces, piece_triangles == 150 ? 3 : 0);
    EXPECT_EQ(meshed.surface.report.mending_rounds, 0) << "pieces of a face intersect";
    if (communicator.size() == 1) continue;
    const std::string together = mesh::hash_mesh(meshed.surface);
    const Communicator alone = Communicator::self();
    const Meshed again = mesh_model(alone, model, {.piece_triangles = piece_triangles});
    EXPECT_EQ(together, mesh::hash_mesh(again.surface));
  }
}

TEST(JoinedFacesMesh, StripsLeaveNoTrace) {
  const Communicator communicator = Communicator::world();
  expect_no_trace(communicator, joined_cylinder(communicator));
}

TEST(JoinedFacesMesh, StripsThatEndWithTheirSurfaceLeaveNoTrace) {
  expect_no_trace(Communicator::world(), joined_spline_cylinder());
}

// The same solid as it is: the strip's long edges are in the mesh.
TEST(JoinedFacesMeshLocal, KeptStripsForceSmallElements) {
  const Communicator communicator = Communicator::world();
  const Model apart = cad::shapes::split_cylinder(strip_degrees, 2);
  const Meshed meshed = mesh_model(communicator, apart, {});
  const Meshed joined = mesh_model(communicator, joined_cylinder(communicator), {});
  EXPECT_GT(4 * meshed.surface.report.triangles, 5 * joined.surface.report.triangles);
}

}  // namespace
}  // namespace aeroloom::surface
