#include "mesh/quality/face_measures.hpp"

#include "mesh/data/shapes.hpp"
#include "mesh/quality/cell_measures.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using geometry::Vec3;

void expect_near(Vec3 a, Vec3 b, double tolerance = 1e-14) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

std::vector<Vec3> corners_of_side(CellShape shape, const std::vector<Vec3>& points, std::size_t side) {
  std::vector<Vec3> corners;
  for (const std::int8_t k : faces_of(shape)[side]) {
    if (k >= 0) corners.push_back(points[static_cast<std::size_t>(k)]);
  }
  return corners;
}

std::vector<FaceGeometry> faces_of_cell(CellShape shape, const std::vector<Vec3>& points) {
  std::vector<FaceGeometry> faces;
  for (std::size_t side = 0; side < faces_of(shape).size(); ++side)
    faces.push_back(measure_face(corners_of_side(shape, points, side)));
  return faces;
}

const std::vector<Vec3> regular_prism = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(3.0) / 2, 0},
                                         {0, 0, 1}, {1, 0, 1}, {0.5, std::sqrt(3.0) / 2, 1}};
const std::vector<Vec3> regular_tetrahedron = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};

TEST(FaceMeasuresLocal, PlaneAndWarpedFaces) {
  const FaceGeometry triangle = measure_face(std::vector<Vec3>{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}});
  expect_near(triangle.center, {1, 1, 0});
  expect_near(triangle.area, {0, 0, 4.5});
  // A trapezium: its centre is not the mean of its corners.
  const FaceGeometry plane = measure_face(std::vector<Vec3>{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {0, 3, 0}});
  expect_near(plane.area, {0, 0, 7.5});
  expect_near(plane.center, {1.4, 1.2, 0});
  // Two corners up: the area vector is that of any surface over the rim, the centre is in the middle.
  const FaceGeometry warped = measure_face(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0.5}, {1, 1, 0}, {0, 1, 0.5}});
  expect_near(warped.area, {0, 0, 1});
  expect_near(warped.center, {0.5, 0.5, 0.25});
  const FaceGeometry point = measure_face(std::vector<Vec3>(4, Vec3{1, 2, 3}));
  expect_near(point.center, {1, 2, 3});
  expect_near(point.area, {});
}

TEST(FaceMeasuresLocal, CentersAndVolumes) {
  const CellGeometry tetrahedron =
      measure_cell(faces_of_cell(CellShape::tetrahedron, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_NEAR(tetrahedron.volume, 1.0 / 6, 1e-15);
  expect_near(tetrahedron.center, {0.25, 0.25, 0.25});
  const CellGeometry pyramid = measure_cell(
      faces_of_cell(CellShape::pyramid, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0.4, 0, 2}}));
  EXPECT_NEAR(pyramid.volume, 8.0 / 3, 1e-14);
  expect_near(pyramid.center, {0.1, 0, 0.5});
  const CellGeometry prism = measure_cell(faces_of_cell(CellShape::prism, regular_prism));
  EXPECT_NEAR(prism.volume, std::sqrt(3.0) / 4, 1e-15);
  expect_near(prism.center, {0.5, std::sqrt(3.0) / 6, 0.5});
  const CellGeometry turned =
      measure_cell(faces_of_cell(CellShape::tetrahedron, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}));
  EXPECT_NEAR(turned.volume, -1.0 / 6, 1e-15);
  expect_near(turned.center, {0.25, 0.25, 0.25});
}

TEST(FaceMeasuresLocal, Angles) {
  EXPECT_NEAR(degrees_of_cosine(cosine_at_face({0, 0, 2}, {0, 0, 0}, {3, 0, 3})), 45, 1e-12);
  EXPECT_NEAR(degrees_of_cosine(cosine_at_face({0, 0, 2}, {0, 0, 0}, {0, 0, -3})), 180, 1e-12);
  EXPECT_EQ(degrees_of_cosine(cosine_at_face({}, {1, 0, 0}, {1, 0, 0})), 90) << "no area, no line";
  EXPECT_EQ(degrees_of_cosine(1 + 1e-15), 0);
  EXPECT_EQ(degrees_of_cosine(cosine_at_face({std::nan(""), 0, 0}, {}, {1, 0, 0})), 180);
}

TEST(FaceMeasuresLocal, SkewnessIsWhatTheLineMisses) {
  const std::vector<Vec3> square = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const FaceGeometry face = measure_face(square);
  // The line meets the plane at x = 0.5; the corners are 1 away in x.
  EXPECT_NEAR(skewness_inside(face, square, {0.5, 0, -1}, {0.5, 0, 1}), 0.5, 1e-14);
  EXPECT_NEAR(skewness_inside(face, square, {-1, 0, -1}, {1, 0, 1}), 0, 1e-14) << "oblique, not skewed";
  EXPECT_NEAR(skewness_inside(face, square, {0.5, 0, -10}, {0.5, 0, 10}), 0.125, 1e-14) << "a fifth of 20";
  EXPECT_NEAR(skewness_at_boundary(face, square, {0.5, 0, -1}), 0.5, 1e-14);
  EXPECT_NEAR(skewness_at_boundary(face, square, {0.5, 0, -10}), 0.125, 1e-14) << "four tenths of 10";
  EXPECT_LE(skewness_inside(measure_face(std::vector<Vec3>(3)), std::vector<Vec3>(3), {1, 0, 0}, {1, 0, 0}),
            largest_ratio);
  EXPECT_EQ(skewness_inside(face, square, {std::nan(""), 0, 0}, {}), largest_ratio);
}

TEST(FaceMeasuresLocal, WhatMayReachALimitDoes) {
  const std::vector<Vec3> square = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const FaceGeometry face = measure_face(square);
  for (const double height : {1e-6, 0.1, 1.0, 10.0, 1e3}) {
    for (const double beside : {0.0, 1e-3, 0.5, 30.0}) {
      const Vec3 own{beside, beside / 3, -height}, other{beside, 0, 2 * height};
      const double skewness = skewness_inside(face, square, own, other);
      EXPECT_TRUE(may_be_skewed(face, square, own, other, skewness));
      EXPECT_TRUE(may_be_skewed(face, square, own, other, 0));
      EXPECT_FALSE(may_be_skewed(face, square, own, other, 1.001 * skewness + 1e-3 / height));
    }
    std::vector<Vec3> points = regular_prism;
    for (Vec3& p : points) p.z *= height;
    const auto faces = faces_of_cell(CellShape::prism, points);
    const double volume = height * std::sqrt(3.0) / 4, ratio = aspect_ratio(faces, volume);
    EXPECT_TRUE(may_be_stretched(faces, volume, ratio));
    EXPECT_FALSE(may_be_stretched(faces, volume, 1.001 * ratio));
    EXPECT_TRUE(may_be_stretched(faces, -volume, 1e20)) << "inside out";
  }
  EXPECT_TRUE(may_be_skewed(face, square, {std::nan(""), 0, 0}, {}, 1e20));
}

TEST(FaceMeasuresLocal, AspectRatios) {
  const double root3 = std::sqrt(3.0);
  // Sums of components: sqrt(3), 2 and sqrt(3) / 2.
  EXPECT_NEAR(aspect_ratio(faces_of_cell(CellShape::prism, regular_prism), root3 / 4), 4 / root3, 1e-14);
  // Components are equal there; then it is the area over the volume.
  const auto faces = faces_of_cell(CellShape::tetrahedron, regular_tetrahedron);
  EXPECT_NEAR(aspect_ratio(faces, 8.0 / 3), 4.0 / std::pow(8.0 / 3, 2.0 / 3), 1e-14);
  EXPECT_GT(aspect_ratio(faces, 0), 1e20);
  EXPECT_LE(aspect_ratio(std::vector<FaceGeometry>(4), 0), largest_ratio);
}

TEST(FaceMeasuresLocal, Determinants) {
  DeterminantSum cube, column, tetrahedron;
  EXPECT_EQ(cube.determinant(), 0) << "no inner face";
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-3.0, 3.0}) {
      Vec3 area;
      area[axis] = sign;
      cube.add(area);
      if (axis > 0) column.add(area);
    }
  }
  EXPECT_NEAR(cube.determinant(), 1, 1e-14);
  EXPECT_NEAR(column.determinant(), 0, 1e-14);
  for (const FaceGeometry& face : faces_of_cell(CellShape::tetrahedron, regular_tetrahedron))
    tetrahedron.add(face.area);
  EXPECT_NEAR(tetrahedron.determinant(), 8.0 / 27, 1e-14);
  DeterminantSum none;
  none.add({});
  EXPECT_EQ(none.determinant(), 0);
}

TEST(FaceMeasuresLocal, VolumeFractions) {
  EXPECT_EQ(volume_fraction(2, 8), 0.25);
  EXPECT_EQ(volume_fraction(8, 2), 0.25);
  EXPECT_LT(volume_fraction(-1, 2), 0);
  EXPECT_EQ(volume_fraction(0, 0), 0);
}

}  // namespace
}  // namespace aeroloom::mesh
