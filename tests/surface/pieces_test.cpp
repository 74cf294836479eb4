/// Faces in pieces: the mesh has no seam, does not depend on ranks, and follows cuts whoever asks for them.
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "surface/division/coarse_loops.hpp"
#include "surface/division/imposed_cuts.hpp"
#include "surface/piece_mesher.hpp"
#include "surface/piece_pool.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/references.hpp"
#include "tests/surface/face_fixture.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using cad::make_primitive_domain;
using cad::PrimitiveKind;
using geometry::Vec3;
using parallel::Communicator;
using testing::graded_field;
using testing::uniform_field;

struct Meshed {
  SurfaceMesh surface;
};

Meshed mesh_model(const cad::Model& model, const sizing::SizeField& field, const SurfaceOptions& options,
                  const FaceDivider& divider = {}) {
  return {mesh_surface_with_cuts(model, field, {options, divider})};
}

std::string hash_of(const Meshed& meshed) {
  return mesh::hash_mesh(meshed.surface);
}

void expect_valid(const Meshed& meshed) {
  const auto report = mesh::check_surface_mesh(meshed.surface);
  EXPECT_TRUE(report.valid()) << report.violations.front();
}

/// Mean ratios of the triangles with a vertex on a cut, and of the others.
struct Seam {
  double count[2] = {0, 0}, mean[2] = {0, 0}, worst[2] = {1, 1};
};

Seam measure_seam(const mesh::DistributedMesh& surface) {
  const Communicator& communicator = surface.communicator;
  Seam seam;
  for (const mesh::Piece& piece : surface.pieces) {
    std::vector<char> on_cut(piece.vertex_count(), 0);
    for (std::size_t i = 0; i < piece.shared_vertices.size(); ++i) {
      on_cut[piece.shared_vertices[i]] = mesh::is_cut_vertex_key(piece.shared_keys[i]);
    }
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const int k = on_cut[v[0]] || on_cut[v[1]] || on_cut[v[2]];
      const double ratio = mesh::triangle_mean_ratio(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]));
      seam.count[k] += 1;
      seam.mean[k] += ratio;
      seam.worst[k] = std::min(seam.worst[k], ratio);
    }
  }
  for (int k = 0; k < 2; ++k) {
    seam.count[k] = communicator.sum(seam.count[k]);
    seam.mean[k] = communicator.sum(seam.mean[k]) / std::max(1.0, seam.count[k]);
    seam.worst[k] = communicator.minimum(seam.worst[k]);
  }
  return seam;
}

struct Shape {
  const char* name;
  PrimitiveKind kind;
  double size;
  bool graded;
};

void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.name;
}

class Pieces : public ::testing::TestWithParam<Shape> {
protected:
  cad::Model model = make_primitive_domain(GetParam().kind);
  sizing::SizeField field_on(const Communicator& ranks) const {
    const auto& [name, kind, size, graded] = GetParam();
    return graded ? graded_field(model, {0.25, 0, 0}, 0.4 * size, size, ranks)
                  : uniform_field(model, size, ranks);
  }
  SurfaceOptions options{.piece_triangles = 300};
};

TEST_P(Pieces, HaveNoSeamAndFollowTheSurface) {
  const Meshed meshed = mesh_model(model, field_on(Communicator::world()), options);
  expect_valid(meshed);
  EXPECT_GE(meshed.surface.piece_count, 16);
  EXPECT_EQ(meshed.surface.report.mending_rounds, 0);
  EXPECT_LT(meshed.surface.report.load_error_90, 0.15);
  ASSERT_FALSE(meshed.surface.report.cut_angles.empty());
  for (const CutAngle& angle : meshed.surface.report.cut_angles) {
    EXPECT_GE(angle.degrees, 30) << "near " << angle.point.x << ", " << angle.point.y << ", "
                                 << angle.point.z;
  }
  const Seam seam = measure_seam(meshed.surface);
  EXPECT_GT(seam.count[1], 100);
  EXPECT_GE(seam.mean[1], seam.mean[0] - 0.005);
  EXPECT_GE(seam.worst[1], 0.6);
  const auto quality = mesh::summarise_quality(meshed.surface);
  EXPECT_GT(quality.min_dihedral.minimum, 20);
  EXPECT_GT(quality.mean_ratio.mean, 0.95);
}

TEST_P(Pieces, AreTheSameOnAnyNumberOfRanks) {
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    return hash_of(mesh_model(model, field_on(communicator), options));
  });
}

INSTANTIATE_TEST_SUITE_P(Shapes, Pieces,
                         ::testing::Values(Shape{"sphere", PrimitiveKind::sphere, 0.014, false},
                                           Shape{"graded_sphere", PrimitiveKind::sphere, 0.018, true},
                                           Shape{"torus", PrimitiveKind::torus, 0.04, false},
                                           Shape{"cylinder", PrimitiveKind::cylinder, 0.03, false},
                                           Shape{"box", PrimitiveKind::box, 0.04, false}));

/// Very heavy faces are cut twice; the second cuts end on the first ones.
TEST(DividedTwice, HasNoSeamEither) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::sphere);
  const SurfaceOptions options{.piece_triangles = 500};
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    const Meshed meshed = mesh_model(model, uniform_field(model, 0.008, communicator), options);
    expect_valid(meshed);
    EXPECT_GT(meshed.surface.piece_count, 40);
    for (const CutAngle& angle : meshed.surface.report.cut_angles) EXPECT_GE(angle.degrees, 30);
    const Seam seam = measure_seam(meshed.surface);
    EXPECT_GE(seam.mean[1], seam.mean[0] - 0.005);
    return fmt::format("{} {}", hash_of(meshed), meshed.surface.report.cut_angles.size());
  });
}

/// However many pieces a face has, its parts are cut down to the size asked for.
TEST(DividedTwice, LeavesNoHeavyPiece) {
  const Communicator world = Communicator::world();
  const cad::Model model = make_primitive_domain(PrimitiveKind::sphere);
  const SurfaceOptions options{.piece_triangles = 100};
  const Meshed meshed = mesh_model(model, uniform_field(model, 0.005), options);
  expect_valid(meshed);
  std::int64_t most = 0;
  for (const mesh::Piece& piece : meshed.surface.pieces)
    most = std::max<std::int64_t>(most, piece.cell_count());
  EXPECT_LT(world.maximum(most), 2 * options.piece_triangles);
}

/// Any step of the division can be left out: other cuts, and a mesh all the same.
TEST(DivisionSteps, CanBeLeftOut) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::sphere);
  const sizing::SizeField field = graded_field(model, {0.25, 0, 0}, 0.008, 0.02);
  SurfaceOptions options{.piece_triangles = 300};
  const std::string complete = hash_of(mesh_model(model, field, options));
  for (bool DivisionSteps::*const step : {&DivisionSteps::contraction, &DivisionSteps::straightening}) {
    options.division = {};
    options.division.*step = false;
    const Meshed meshed = mesh_model(model, field, options);
    expect_valid(meshed);
    EXPECT_NE(hash_of(meshed), complete);
  }
  options.division = {false, false, false, false};
  expect_valid(mesh_model(model, field, options));
}

/// The stage takes cuts whoever asks for them: here a box that the surface reaches into.
TEST(ImposedCuts, FollowABox) {
  for (const PrimitiveKind kind : {PrimitiveKind::sphere, PrimitiveKind::torus, PrimitiveKind::cylinder}) {
    const cad::Model model = make_primitive_domain(kind);
    const SurfaceOptions options{.piece_triangles = 1'000'000};
    const auto is_inside = [](Vec3 p) { return p.x > -0.1 && p.y > -0.05 && p.z > -0.12; };
    const FaceDivider divider = [&](cad::FaceId, const partition::BackgroundSurface& surface) {
      std::vector<std::int32_t> part;
      for (const auto& [a, b, c] : surface.triangles) {
        part.push_back(is_inside((surface.points[a] + surface.points[b] + surface.points[c]) / 3.0) ? 1 : 0);
      }
      return part;
    };
    const auto mesh_on = [&](const Communicator& ranks) {
      return mesh_model(model, uniform_field(model, 0.03, ranks), options, divider);
    };
    const Meshed meshed = mesh_on(Communicator::world());
    expect_valid(meshed);
    EXPECT_GT(meshed.surface.piece_count, model.face_count());
    EXPECT_GT(meshed.surface.report.divided_faces, 0);
    EXPECT_GT(measure_seam(meshed.surface).count[1], 50);
    EXPECT_EQ(hash_of(meshed), hash_of(mesh_on(Communicator::self())));
  }
}

TEST(Decomposition, ByFacesKeepsOnePiecePerFace) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const SurfaceOptions options{.decomposition = SurfaceDecomposition::faces, .piece_triangles = 100};
  const Meshed meshed = mesh_model(model, uniform_field(model, 0.03), options);
  EXPECT_EQ(meshed.surface.piece_count, model.face_count());
  EXPECT_EQ(meshed.surface.report.divided_faces, 0);
  EXPECT_TRUE(meshed.surface.report.cut_angles.empty());
}

PieceProblem side_of_cylinder(const cad::Model& model, const sizing::SizeField& field) {
  const CurveMesh curves = discretise_curves(model, field);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (!model.is_planar(f)) return problem_of_face(model, f, curves, field, {}).rest;
  }
  throw std::logic_error("a cylinder without a side");
}

TEST(CoarseLoopsLocal, KeepASubsetInOrder) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const sizing::SizeField field = uniform_field(model, 0.02);
  const PieceProblem problem = side_of_cylinder(model, field);
  const auto fine = static_cast<std::size_t>(std::round(2 * std::numbers::pi * 0.25 / 0.02));
  ASSERT_NEAR(problem.surface.loop_edges.size(), 2 * fine, 2);
  const CoarseLoops by_size = coarsen_loops(problem, field.scaled(4), std::numbers::pi);
  EXPECT_NEAR(by_size.segments.size(), 0.5 * static_cast<double>(fine), 2);
  const CoarseLoops by_turn = coarsen_loops(problem, field.scaled(1000), 30 * std::numbers::pi / 180);
  EXPECT_GE(by_turn.segments.size(), 24u);
  EXPECT_LE(by_turn.segments.size(), 30u);
  for (const CoarseLoops& loops : {by_size, by_turn}) {
    std::set<std::int32_t> seen(loops.inside.begin(), loops.inside.end());
    EXPECT_EQ(seen.size(), loops.inside.size());
    for (const CoarseSegment& segment : loops.segments) {
      seen.insert(segment.from);
      EXPECT_EQ(loops.find(segment.to, segment.from), loops.find(segment.from, segment.to));
      // What lies between comes in order along the circle: every step is a fine edge.
      std::int32_t last = segment.from;
      const auto step = [&](std::int32_t v) {
        EXPECT_LT(distance(problem.vertices.points[last], problem.vertices.points[v]), 0.025);
        last = v;
      };
      for (std::int32_t i = segment.begin; i < segment.end; ++i) step(loops.inside[i]);
      step(segment.to);
    }
    EXPECT_EQ(seen.size(), problem.vertices.points.size());
  }
  EXPECT_EQ(by_size.find(-1, 0), nullptr);
}

TEST(PieceProblemsLocal, TravelBitForBit) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const sizing::SizeField field = uniform_field(model, 0.1);
  const PieceProblem problem = side_of_cylinder(model, field);
  const PieceProblem copy = parallel::from_wire<PieceProblem>(parallel::to_wire(problem));
  EXPECT_EQ(parallel::to_wire(copy), parallel::to_wire(problem));
  EXPECT_EQ(parallel::to_wire(mesh_piece(model, copy, field, {})),
            parallel::to_wire(mesh_piece(model, problem, field, {})));
}

TEST(SharedVertexKeysLocal, NameVerticesOfCurvesAndCuts) {
  const cad::Model model = make_primitive_domain(PrimitiveKind::cylinder);
  const CurveMesh curves = discretise_curves(model, uniform_field(model, 0.1));
  std::set<mesh::SharedVertexKey> names;
  for (CurveVertex v = 0; v < static_cast<CurveVertex>(curves.points.size()); ++v) {
    const mesh::SharedVertexKey vertex_key = curves.vertex_key(model, v);
    EXPECT_EQ(curves.vertex_of(vertex_key), v);
    EXPECT_EQ(mesh::edge_of_vertex_key(vertex_key), curves.edge_of(model, v));
    EXPECT_FALSE(mesh::is_cut_vertex_key(vertex_key));
    names.insert(vertex_key);
  }
  for (const auto& [face, group, index] : {std::array{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}}) {
    const mesh::SharedVertexKey vertex_key = mesh::cut_vertex_key(face, group, index);
    EXPECT_TRUE(mesh::is_cut_vertex_key(vertex_key));
    EXPECT_EQ(mesh::edge_of_vertex_key(vertex_key), cad::no_entity);
    names.insert(vertex_key);
  }
  EXPECT_EQ(names.size(), curves.points.size() + 4);
  EXPECT_THROW(mesh::cut_vertex_key(0, 1 << 16, 0), std::runtime_error);
}

}  // namespace
}  // namespace aeroloom::surface
