#include "cad/domain/trailing_edges.hpp"
#include "cad/model/patches.hpp"
#include "cad/model/topology/joined_faces.hpp"
#include "tests/cad/blunt_shapes.hpp"
#include "tests/cad/half_models.hpp"
#include "tests/cad/prisms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using shapes::blunt_wing;
using shapes::changes_about;
using shapes::sharpened;

constexpr double thickness = 0.01;
const char* const closed_words = "was closed to a curve";

/// Edges of the model that end at both places.
std::vector<EdgeId> edges_between(const Model& model, Vec3 a, Vec3 b) {
  std::vector<EdgeId> found;
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const Vec3 first = model.vertex(model.edge(e).first), last = model.vertex(model.edge(e).last);
    if (std::max(distance(first, a), distance(last, b)) < 1e-12 ||
        std::max(distance(first, b), distance(last, a)) < 1e-12) {
      found.push_back(e);
    }
  }
  return found;
}

/// Loops go from vertex to vertex, edges know their faces, parameters lead to the edges' points.
void expect_sound(const Model& model, double largest_move) {
  std::map<EdgeId, int> uses;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    for (const auto& loop : model.face(f).loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Coedge &use = loop[i], &next = loop[(i + 1) % loop.size()];
        const Edge &edge = model.edge(use.edge), &behind = model.edge(next.edge);
        if (!edge.degenerate) ++uses[use.edge];
        EXPECT_EQ(use.reversed ? edge.first : edge.last, next.reversed ? behind.last : behind.first);
        EXPECT_TRUE(std::count(edge.faces.begin(), edge.faces.end(), f));
        if (edge.degenerate) continue;
        for (const double share : {0.0, 0.3, 1.0}) {
          const double t = edge.first_parameter + share * (edge.last_parameter - edge.first_parameter);
          const Vec3 on_face = model.face_point(f, model.edge_uv(f, use, t));
          EXPECT_LE(distance(on_face, model.edge_point(use.edge, t)), largest_move + 1e-9);
        }
        EXPECT_LT(distance(model.edge_point(use.edge, edge.first_parameter), model.vertex(edge.first)),
                  1e-12);
        EXPECT_LT(distance(model.edge_point(use.edge, edge.last_parameter), model.vertex(edge.last)), 1e-12);
      }
    }
  }
  for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2) << "edge " << edge;
}

/// Facets keep to the edges, and nothing but edges bounds them.
void expect_facets_follow(const Model& model) {
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, 0.01 * model.bounds().diagonal(), 0.3);
    std::map<std::array<std::int32_t, 2>, int> open;
    for (const auto& t : facets.triangles) {
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3];
        ASSERT_NE(a, b);
        ++open[{std::min(a, b), std::max(a, b)}];
      }
    }
    std::erase_if(open, [](const auto& side) { return side.second == 2; });
    std::size_t sides = 0;
    for (const Facets::BoundaryLine& line : facets.boundary) {
      EXPECT_TRUE(std::is_sorted(line.parameters.begin(), line.parameters.end()));
      for (std::size_t i = 0; i < line.nodes.size(); ++i) {
        EXPECT_LT(distance(facets.points[line.nodes[i]], model.edge_point(line.use.edge, line.parameters[i])),
                  1e-9);
        if (i == 0) continue;
        ++sides;
        const auto [a, b] = std::minmax(line.nodes[i - 1], line.nodes[i]);
        EXPECT_TRUE(open.count({a, b})) << model.face(f).name << ", edge " << line.use.edge;
      }
    }
    EXPECT_EQ(open.size(), sides) << model.face(f).name;
  }
}

TEST(ClosedEdges, StripBecomesAnEdge) {
  const TopoDS_Shape wing = blunt_wing({{0, 0, thickness}, {1, 0, thickness}});
  DomainOptions blunt = sharpened();
  blunt.trailing_edges.treatment = TrailingEdges::keep;
  const Domain before = shapes::prepare(wing, blunt), domain = shapes::prepare(wing, sharpened());
  const Model& model = domain.model;
  EXPECT_EQ(model.face_count(), before.model.face_count() - 1);
  EXPECT_EQ(model.edge_count(), before.model.edge_count() - 3);
  EXPECT_EQ(model.vertex_count(), before.model.vertex_count() - 2);
  const auto edges = edges_between(model, {1, 0, 0}, {1, 1, 0});
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(model.edge(edges[0]).faces.size(), 2u);
  EXPECT_FALSE(model.is_seam(edges[0]));
  const auto closed = changes_about(domain.report.changes, closed_words);
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_NEAR(closed[0].how_much, 0.5 * thickness, 1e-9);
  EXPECT_NE(closed[0].what.find("1 long"), std::string::npos) << closed[0].what;
  expect_sound(model, 0.5 * thickness);
  expect_facets_follow(model);
}

TEST(ClosedEdges, BytesGiveTheSameModel) {
  const Model model =
      shapes::prepare(blunt_wing({{0, 0, thickness}, {1, 0.3, thickness}}), sharpened()).model;
  const Model again = Model::from_bytes(model.serialise());
  EXPECT_EQ(again.serialise(), model.serialise());
  ASSERT_EQ(again.face_count(), model.face_count());
  ASSERT_EQ(again.edge_count(), model.edge_count());
  EXPECT_EQ(again.patches(), model.patches());
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const double t = 0.3 * model.edge(e).first_parameter + 0.7 * model.edge(e).last_parameter;
    EXPECT_EQ(again.edge_point(e, t), model.edge_point(e, t));
  }
  for (FaceId f = 0; f < model.face_count(); ++f) {
    EXPECT_EQ(again.face(f).name, model.face(f).name);
    EXPECT_EQ(again.facets(f, 0.1, 0.3).points, model.facets(f, 0.1, 0.3).points);
  }
}

TEST(ClosedEdges, StripsInARowShareAVertex) {
  const Model model =
      shapes::prepare(blunt_wing({{0, 0, thickness}, {1, 0.2, thickness}, {2, 0.8, thickness}}), sharpened())
          .model;
  ASSERT_EQ(edges_between(model, {1, 0, 0}, {1.2, 1, 0}).size(), 1u);
  ASSERT_EQ(edges_between(model, {1.2, 1, 0}, {1.8, 2, 0}).size(), 1u);
  expect_sound(model, 0.5 * thickness);
  expect_facets_follow(model);
}

TEST(ClosedEdges, StripMayRunOutToAPoint) {
  const Domain domain = shapes::prepare(blunt_wing({{0, 0, thickness}, {1, 0.2, 0}}), sharpened());
  EXPECT_EQ(changes_about(domain.report.changes, closed_words).size(), 1u);
  ASSERT_EQ(edges_between(domain.model, {1, 0, 0}, {1.2, 1, 0}).size(), 1u);
  expect_sound(domain.model, 0.5 * thickness);
  expect_facets_follow(domain.model);
}

/// A wing whose lower side is in one piece and whose upper side is in two: only one border has a vertex.
TopoDS_Shape divided_wing() {
  const double h = 0.5 * thickness;
  const Vec3 n0{0, 0, 0}, n2{0, 2, 0}, u0{1, 0, h}, u1{1, 0.7, h}, u2{1, 2, h}, l0{1, 0, -h}, l2{1, 2, -h};
  const Vec3 r0{0.3, 0, 0.2}, r1{0.3, 0.7, 0.2}, r2{0.3, 2, 0.2}, k0{0.3, 0, -0.2}, k2{0.3, 2, -0.2};
  return shapes::compound_of<TopoDS_Face>(
      {shapes::polygon({n0, k0, l0, u0, r0}), shapes::polygon({n2, k2, l2, u2, r2}),
       shapes::polygon({n0, n2, k2, k0}), shapes::polygon({k0, k2, l2, l0}),
       shapes::polygon({n0, n2, r2, r1, r0}), shapes::polygon({r0, r1, u1, u0}),
       shapes::polygon({r1, r2, u2, u1}), shapes::polygon({l0, l2, u2, u1, u0})});
}

TEST(ClosedEdges, BordersMayHaveDifferentEdges) {
  const Model model = shapes::prepare(divided_wing(), sharpened()).model;
  ASSERT_EQ(edges_between(model, {1, 0, 0}, {1, 0.7, 0}).size(), 1u);
  ASSERT_EQ(edges_between(model, {1, 0.7, 0}, {1, 2, 0}).size(), 1u);
  expect_sound(model, 0.5 * thickness);
  expect_facets_follow(model);
}

TEST(ClosedEdges, PlaneOfSymmetryStaysExact) {
  DomainOptions options = sharpened();
  options.far_field = FarFieldOptions{};
  options.far_field->symmetry = Symmetry::y;
  const Domain domain = shapes::prepare(blunt_wing({{0, 0, thickness}, {1, 0.1, thickness}}), options);
  EXPECT_EQ(changes_about(domain.report.changes, closed_words).size(), 1u);
  const auto planes = shapes::faces_of_patch(domain.model, "symmetry");
  ASSERT_EQ(planes.size(), 1u);
  EXPECT_TRUE(domain.model.is_exact_plane(planes[0]));
  half_models::ExactCoordinate(1, 0.0).check_face(domain.model, planes[0]);
  expect_sound(domain.model, 0.5 * thickness);
}

TEST(ClosedEdges, WidthAndNamesDecide) {
  const TopoDS_Shape wing = blunt_wing({{0, 0, 0.05}, {1, 0, 0.05}});
  const auto left = [&](const DomainOptions& options) {
    return changes_about(shapes::prepare(wing, options).report.changes, "was not closed");
  };
  ASSERT_EQ(left(sharpened()).size(), 1u);
  EXPECT_NE(left(sharpened()).front().what.find("sharpen_width"), std::string::npos);
  EXPECT_EQ(left(sharpened({}, 0.06)).size(), 0u);
  EXPECT_EQ(left(sharpened({"body"}, 0.06)).size(), 0u);
  EXPECT_NE(shapes::refusal(wing, sharpened({"wing_*"})).find("'wing_*'"), std::string::npos);
}

TEST(ClosedEdges, NamesMatchPatterns) {
  EXPECT_TRUE(matches_pattern("wing_trailing_edge", "wing*"));
  EXPECT_TRUE(matches_pattern("wing_trailing_edge", "*_trailing_*"));
  EXPECT_TRUE(matches_pattern("fin", "f?n"));
  EXPECT_TRUE(matches_pattern("", "*"));
  EXPECT_FALSE(matches_pattern("fin", "f?"));
  EXPECT_FALSE(matches_pattern("left_wing", "wing*"));
  EXPECT_FALSE(matches_pattern("fin", "fin_te"));
}

/// Prisms with a strip that is no trailing edge stay as they are, and the reason is told.
void expect_left(const TopoDS_Shape& shape, const std::string& reason) {
  DomainOptions options = sharpened({}, 0.03);
  const Domain domain = shapes::prepare(shape, options);
  options.trailing_edges.treatment = TrailingEdges::keep;
  EXPECT_EQ(domain.model.face_count(), shapes::prepare(shape, options).model.face_count());
  EXPECT_FALSE(changes_about(domain.report.changes, reason).empty()) << reason;
  EXPECT_TRUE(changes_about(domain.report.changes, closed_words).empty());
}

TEST(ClosedEdges, StepsSlotsAndRingsStay) {
  const double d = 0.02;
  expect_left(shapes::prism({{0, 0}, {1, 0}, {1, 0.5}, {0.5, 0.5}, {0.5, 0.5 + d}, {0, 0.5 + d}}, 1),
              "a step or a slot");
  expect_left(
      shapes::prism({{0, 0}, {1, 0}, {1, 1}, {0.5 + d, 1}, {0.5 + d, 0.7}, {0.5, 0.7}, {0.5, 1}, {0, 1}}, 1),
      "a step or a slot");
  expect_left(BRepPrimAPI_MakeCylinder(1, d).Shape(), "a closed ring");
  // The bevelled edge of a block.
  expect_left(shapes::prism({{0, 0}, {1.5, 0}, {1.3, 1 - d}, {1.3 - d, 1}, {0, 1}}, 1), "no sharp edge");
}

TEST(ClosedEdges, SmoothFacesAreLeftToBeJoined) {
  const TopoDS_Shape bent = shapes::prism({{0, 0}, {1, 0}, {1.02, 0.002}, {1.6, 0.2}, {0.5, 1}}, 1);
  expect_left(bent, "go on smoothly");
}

TEST(ClosedEdges, FacesCanStillBeJoined) {
  const Model model = shapes::prepare(divided_wing(), sharpened()).model;
  const auto pieces = edges_between(model, {1, 0.7, 0}, {0.3, 0.7, 0.2});
  ASSERT_EQ(pieces.size(), 1u);
  const auto& faces = model.edge(pieces[0]).faces;
  ASSERT_EQ(faces.size(), 2u);
  const Model joined = join_faces(model, {{faces[0], faces[1]}});
  EXPECT_EQ(joined.face_count(), model.face_count() - 1);
  for (FaceId f = 0; f < joined.face_count(); ++f) {
    const Facets facets = joined.facets(f, 0.1, 0.3);
    for (const auto& line : facets.boundary) {
      for (std::size_t i = 0; i < line.nodes.size(); ++i) {
        EXPECT_LT(
            distance(facets.points[line.nodes[i]], joined.edge_point(line.use.edge, line.parameters[i])),
            1e-9);
      }
    }
  }
}

TEST(ClosedEdges, StripAsVoidOfASolidStays) {
  // Meshed inside, a thin edge of the solid is no end of a body.
  DomainOptions options = sharpened();
  options.kind = DomainKind::fluid;
  const Domain domain = shapes::prepare(blunt_wing({{0, 0, thickness}, {1, 0, thickness}}), options);
  EXPECT_TRUE(changes_about(domain.report.changes, closed_words).empty());
}

Domain real_domain(const std::string& name) {
  DomainOptions options;
  options.file = real::file(name);
  options.trailing_edges.treatment = TrailingEdges::sharpen;
  return prepare_domain(options);
}

TEST(ClosedEdges, TrailingEdgeEndsOnTheSideOfAnother) {
  if (!real::has("aircraft/gmsh_dlr_f6.brep")) GTEST_SKIP();
  const Domain domain = real_domain("aircraft/gmsh_dlr_f6.brep");
  const Changes closed = changes_about(domain.report.changes, closed_words);
  EXPECT_EQ(closed.size(), 4u);  // two of the wing, nacelle and pylon, which ends below the wing's
  for (const Change& change : closed) EXPECT_LT(change.how_much, 0.51);
  for (FaceId f = 0; f < domain.model.face_count(); ++f) {
    for (const auto& loop : domain.model.face(f).loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Coedge &use = loop[i], &next = loop[(i + 1) % loop.size()];
        const Edge &edge = domain.model.edge(use.edge), &behind = domain.model.edge(next.edge);
        EXPECT_EQ(use.reversed ? edge.first : edge.last, next.reversed ? behind.last : behind.first);
      }
    }
  }
}

TEST(ClosedEdges, PointedFilletsKeepTheirTrailingEdge) {
  if (!real::has("aircraft/gmsh_wing_fuselage.step")) GTEST_SKIP();
  const Changes changes = real_domain("aircraft/gmsh_wing_fuselage.step").report.changes;
  EXPECT_EQ(changes_about(changes, "runs out to a point").size(), 2u);
  EXPECT_TRUE(changes_about(changes, closed_words).empty());
}

}  // namespace
}  // namespace aeroloom::cad
