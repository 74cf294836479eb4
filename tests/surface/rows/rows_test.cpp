#include "mesh/checks/validity.hpp"
#include "surface/rows/face_rows.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/references.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::PrimitiveKind;
using geometry::Vec3;
using parallel::Communicator;

TEST(EdgeRows, AreAsHighAsSegmentsAreLong) {
  std::vector<Vec3> vertices;
  for (int i = 0; i <= 40; ++i) vertices.push_back({0.1 * i, 0, 0});
  const EdgeRows rows{0.01, 1.25};
  const std::vector<int> counts = count_rows(vertices, rows);
  EXPECT_EQ(counts.front(), 0);
  EXPECT_EQ(counts.back(), 0);
  for (std::size_t i = 1; i < counts.size(); ++i) EXPECT_LE(std::abs(counts[i] - counts[i - 1]), 1);
  const int most = counts[20];
  EXPECT_LE(row_height(rows, most - 1), 0.1);
  EXPECT_GT(row_height(rows, most), 0.1);
  EXPECT_NEAR(breadth_of(rows, most), 0.01 * (std::pow(1.25, most) - 1) / 0.25, 1e-12);
}

TEST(EdgeRows, AreNoneWhereSegmentsAreShort) {
  std::vector<Vec3> vertices{{0, 0, 0}};
  for (const double length : {1, 1, 1, 1, 5, 5, 5, 5, 5, 1, 1})
    vertices.push_back(vertices.back() + Vec3{length, 0, 0});
  const std::vector<int> counts = count_rows(vertices, {1, 1.2});
  for (const std::size_t i : {0, 1, 2, 3, 4, 9, 10, 11}) EXPECT_EQ(counts[i], 0) << i;
  for (const std::size_t i : {5, 6, 7, 8}) EXPECT_GT(counts[i], 0) << i;
}

/// The model meshed with rows along edges, both ends of which have the height as size.
SurfaceMesh mesh_with_rows(const Communicator& communicator, const cad::Model& model, const EdgeRows& asked,
                           const std::vector<cad::EdgeId>& along, double maximum = 0.06) {
  SurfaceOptions options;
  options.piece_triangles = 1'000;
  options.rows.resize(static_cast<std::size_t>(model.edge_count()));
  std::vector<sizing::SizeSource> ends;
  for (const cad::EdgeId e : along) {
    options.rows[e] = asked;
    if (!communicator.is_root()) continue;
    for (const cad::VertexId v : {model.edge(e).first, model.edge(e).last})
      ends.push_back({model.vertex(v), asked.height});
  }
  const sizing::SizingOptions sizes{
      .minimum = 1e-3, .maximum = maximum, .curvature_angle = 12, .growth = 1.3};
  const sizing::SizeField field = sizing::build_size_field(communicator, model, sizes);
  return mesh_surface(model, field.refined(ends), options);
}

std::vector<Vec3> points_of(const SurfaceMesh& surface) {
  std::vector<Vec3> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) mine.push_back(piece.point(v));
  }
  return surface.communicator.all_gather_items(std::span<const Vec3>(mine));
}

bool contains(const std::vector<Vec3>& points, Vec3 wanted, double tolerance) {
  return std::any_of(points.begin(), points.end(), [&](Vec3 p) { return distance(p, wanted) <= tolerance; });
}

/// The edge of a box of edge 1 between x = 0.5 and z = 0.5.
cad::EdgeId edge_of_box(const cad::Model& model) {
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const Vec3 middle = 0.5 * (model.vertex(model.edge(e).first) + model.vertex(model.edge(e).last));
    if (distance(middle, {0.5, 0, 0.5}) < 1e-9) return e;
  }
  return cad::no_entity;
}

TEST(FaceRows, LieAtRightAnglesOnBothSidesOfAnEdge) {
  const cad::Model box = cad::make_primitive_domain(PrimitiveKind::box);
  const EdgeRows asked{0.01, 1.2};
  const SurfaceMesh surface = mesh_with_rows(Communicator::world(), box, asked, {edge_of_box(box)});
  const auto report = mesh::check_surface_mesh(surface);
  ASSERT_TRUE(report.valid()) << report.violations.front();
  EXPECT_NEAR(report.volume, 1, 1e-12);
  const std::vector<Vec3> points = points_of(surface);
  int seen = 0;
  for (const Vec3 p : points) {
    if (p.x != 0.5 || p.z != 0.5 || std::abs(p.y) > 0.3) continue;
    ++seen;
    for (int row = 1; row <= 5; ++row) {
      const double off = breadth_of(asked, row);
      EXPECT_TRUE(contains(points, p - Vec3{off, 0, 0}, 1e-12)) << row;
      EXPECT_TRUE(contains(points, p - Vec3{0, 0, off}, 1e-12)) << row;
    }
  }
  EXPECT_GT(seen, 5);
}

TEST(FaceRows, LieOnTheSurface) {
  const cad::Model cylinder = cad::make_primitive_domain(PrimitiveKind::cylinder);
  std::vector<cad::EdgeId> circles;
  for (cad::EdgeId e = 0; e < cylinder.edge_count(); ++e) {
    if (cylinder.edge_curvature(e, 0.5) > 0) circles.push_back(e);
  }
  ASSERT_EQ(circles.size(), 2u);
  const SurfaceMesh surface = mesh_with_rows(Communicator::world(), cylinder, {0.004, 1.2}, circles, 0.03);
  const auto report = mesh::check_surface_mesh(surface);
  ASSERT_TRUE(report.valid()) << report.violations.front();
  int on_first_row = 0;
  for (const Vec3 p : points_of(surface)) {
    if (std::abs(p.z) < 0.499) EXPECT_NEAR(std::hypot(p.x, p.y), 0.25, 1e-12);
    on_first_row += std::abs(0.5 - std::abs(p.z) - 0.004) < 1e-12 ? 1 : 0;
  }
  EXPECT_GT(on_first_row, 20);
}

TEST(FaceRows, AreReported) {
  const cad::Model box = cad::make_primitive_domain(PrimitiveKind::box);
  const SurfaceReport report =
      mesh_with_rows(Communicator::world(), box, {0.01, 1.2}, {edge_of_box(box)}).report;
  ASSERT_EQ(report.rows.size(), 1u);
  const RowsMade& made = report.rows[0];
  EXPECT_EQ(made.edge, edge_of_box(box));
  EXPECT_EQ(made.height, 0.01);
  EXPECT_NEAR(made.length, 1, 1e-12);
  EXPECT_LT(made.with_rows, 1);  // not at the ends
  EXPECT_GT(made.with_rows, 0.9);
  EXPECT_LT(made.stretched, made.with_rows);
  EXPECT_GT(made.stretched, 0.3);
  EXPECT_NEAR(made.longest, 0.05, 0.011);
  EXPECT_LE(row_height({0.01, 1.2}, made.most - 1), made.longest);
  EXPECT_GT(row_height({0.01, 1.2}, made.most), made.longest);
}

TEST(FaceRows, AreNotAlongASeam) {
  const cad::Model cylinder = cad::make_primitive_domain(PrimitiveKind::cylinder);
  cad::EdgeId seam = cad::no_entity;
  for (cad::EdgeId e = 0; e < cylinder.edge_count(); ++e) {
    if (!is_constraining(cylinder, e)) seam = e;
  }
  ASSERT_NE(seam, cad::no_entity);
  const SurfaceReport report = mesh_with_rows(Communicator::world(), cylinder, {0.004, 1.2}, {seam}).report;
  ASSERT_EQ(report.rows.size(), 1u);
  EXPECT_EQ(report.rows[0].edge, seam);
  EXPECT_EQ(report.rows[0].with_rows, 0);
  EXPECT_EQ(report.rows[0].most, 0);
}

TEST(FaceRows, BecomeFewerWhereTheFaceIsNarrow) {
  const cad::Model slab = cad::make_primitive_domain(PrimitiveKind::box, {.box = {1, 1, 0.1}});
  cad::EdgeId edge = cad::no_entity;
  for (cad::EdgeId e = 0; e < slab.edge_count(); ++e) {
    const Vec3 middle = 0.5 * (slab.vertex(slab.edge(e).first) + slab.vertex(slab.edge(e).last));
    if (distance(middle, {0.5, 0, 0.05}) < 1e-9) edge = e;
  }
  const EdgeRows asked{0.01, 1.2};
  const SurfaceMesh surface = mesh_with_rows(Communicator::world(), slab, asked, {edge});
  const auto report = mesh::check_surface_mesh(surface);
  ASSERT_TRUE(report.valid()) << report.violations.front();
  const std::vector<Vec3> points = points_of(surface);
  EXPECT_TRUE(std::any_of(points.begin(), points.end(), [](Vec3 p) {
    return p.x == 0.5 && std::abs(p.y) < 0.3 && std::abs(p.z - 0.04) < 1e-12;
  })) << "a first row";
  for (const Vec3 p : points) {
    if (p.x == 0.5 && p.z > -0.05 && p.z < 0.05) EXPECT_GT(p.z + 0.05, 0.01) << "close to the other edge";
  }
}

TEST(FaceRows, AreTheSameOnAnyNumberOfRanks) {
  const cad::Model box = cad::make_primitive_domain(PrimitiveKind::box);
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    return mesh::hash_mesh(mesh_with_rows(communicator, box, {0.01, 1.2}, {edge_of_box(box)}));
  });
}

}  // namespace
}  // namespace aeroloom::surface
