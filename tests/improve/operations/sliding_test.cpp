#include "improve/operations/sliding.hpp"

#include "mesh/quality/quality.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/improve/fans.hpp"
#include "tests/improve/pieces.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using cad::Model;
using cad::PrimitiveKind;
using examples::close_boundary;
using examples::make_fan;
using examples::make_piece;
using examples::volume;

const mesh::TetQuality measure(28);

double least_quality(const mesh::Piece& piece) {
  double least = std::numeric_limits<double>::max();
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    least =
        std::min(least, measure(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3])));
  }
  return least;
}

bool slide_first_vertex(mesh::Piece& piece, const Model& model) {
  cad::PointLocator locator(model);
  TetMesh mesh(piece, measure);
  const ChangeLimits any;
  Sliding sliding(locator, any);
  std::vector<LocalIndex> star;
  const bool moved = sliding.slide(mesh, 0, star);
  EXPECT_EQ(mesh.changed_triangles() > 0, moved);
  mesh.finish();
  return moved;
}

TEST(Sliding, KeepsToTheFace) {
  for (const PrimitiveKind kind : {PrimitiveKind::box, PrimitiveKind::sphere, PrimitiveKind::torus}) {
    const Model model = make_primitive_domain(kind);
    const bool plane = kind == PrimitiveKind::box;
    const cad::Facets facets = model.facets(0, 0.05, 0.5);
    geometry::Vec2 middle;
    for (const geometry::Vec2 uv : facets.uv) middle += uv / static_cast<double>(facets.uv.size());
    mesh::Piece piece =
        make_fan(model, 0, middle, plane ? geometry::Vec2{0.1, 0.1} : geometry::Vec2{0.2, 0.2}, 0.05);
    const double before = least_quality(piece);
    const Vec3 old = piece.point(0);
    ASSERT_TRUE(slide_first_vertex(piece, model));
    EXPECT_GT(least_quality(piece), before);
    EXPECT_GT(distance(piece.point(0), old), 1e-3);
    EXPECT_TRUE(cad::PointLocator(model).on_face(0, piece.point(0), 1e-10));
    EXPECT_GT(volume(piece), 0);
  }
}

TEST(Sliding, LeavesWhatOthersKnow) {
  const Model model = make_primitive_domain(PrimitiveKind::box);
  const cad::Facets facets = model.facets(0, 0.05, 0.5);
  geometry::Vec2 middle;
  for (const geometry::Vec2 uv : facets.uv) middle += uv / static_cast<double>(facets.uv.size());
  mesh::Piece shared = make_fan(model, 0, middle, {0.1, 0.1}, 0.05);
  mesh::Piece elsewhere = shared, corner = shared;
  shared.shared_vertices = {0};
  shared.shared_keys = {7};
  EXPECT_FALSE(slide_first_vertex(shared, model)) << "another piece knows the vertex";
  elsewhere.vertex_entity[0] = 1;
  EXPECT_FALSE(slide_first_vertex(elsewhere, model)) << "the vertex does not lie on the face it names";
  corner.vertex_dimension[0] = mesh::CadDimension::vertex;
  EXPECT_FALSE(slide_first_vertex(corner, model)) << "CAD vertices stay";
}

TEST(Sliding, KeepsToTheCurve) {
  const Model model = make_primitive_domain(PrimitiveKind::cylinder);
  cad::EdgeId rim = 0;
  while (model.edge(rim).first != model.edge(rim).last || model.is_seam(rim)) ++rim;
  const cad::Edge& edge = model.edge(rim);
  const auto at = [&](double share) {
    return model.edge_point(rim, (1 - share) * edge.first_parameter + share * edge.last_parameter);
  };
  const Vec3 middle = at(0.5);
  const double inward = middle.z > 0 ? -1 : 1;
  const Vec3 down = middle + Vec3{0, 0, 0.08 * inward};
  const Vec3 radial{middle.x, middle.y, 0};
  mesh::Piece piece = make_piece({at(0.53), at(0.45), at(0.55), down, middle - 0.4 * radial,
                                  middle - 0.25 * radial + Vec3{0, 0, 0.06 * inward}},
                                 {0, 1, 3, 5, 0, 2, 3, 5, 0, 1, 4, 5, 0, 2, 4, 5});
  close_boundary(piece);
  for (LocalIndex v = 0; v < 3; ++v) {
    piece.vertex_dimension[v] = mesh::CadDimension::edge;
    piece.vertex_entity[v] = rim;
  }
  const double before = least_quality(piece);
  const Vec3 old = piece.point(0);
  ASSERT_TRUE(slide_first_vertex(piece, model));
  EXPECT_GT(least_quality(piece), before);
  EXPECT_GT(distance(piece.point(0), old), 1e-3);
  EXPECT_TRUE(cad::PointLocator(model).on_edge(rim, piece.point(0), 1e-10));
}

}  // namespace
}  // namespace aeroloom::improve
