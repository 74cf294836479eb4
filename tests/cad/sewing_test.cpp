#include "cad/repair/sewing.hpp"

#include "cad/repair/heal.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <fmt/format.h>
#include <gp_Trsf.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using shapes::compound_of;
using shapes::loose_faces;
using shapes::prepare_fluid;
using shapes::volume_of;

const Vec3 size{1, 2, 3};
const double diagonal = norm(size);

TopoDS_Solid make_box() {
  return BRepPrimAPI_MakeBox(size.x, size.y, size.z).Solid();
}

TopoDS_Shape moved(const TopoDS_Shape& shape, Vec3 by) {
  gp_Trsf move;
  move.SetTranslation(gp_Vec(by.x, by.y, by.z));
  return BRepBuilderAPI_Transform(shape, move, true).Shape();
}

/// A box of loose faces whose top floats above the sides.
TopoDS_Compound box_with_gap(double gap) {
  std::vector<TopoDS_Face> faces = loose_faces(make_box());
  for (TopoDS_Face& face : faces) {
    if (shapes::center_of(face).z > 0.9 * size.z) face = TopoDS::Face(moved(face, {0, 0, gap}));
  }
  return compound_of(faces);
}

NamedShape heal(const TopoDS_Shape& shape, Changes& changes) {
  NamedShape named;
  named.shape = shape;
  Volumes volumes;
  return make_solids(named, 0, volumes, changes);
}

TEST(Sewing, LooseFacesBecomeASolid) {
  const Domain domain = prepare_fluid(compound_of(loose_faces(make_box())));
  const Model& model = domain.model;
  EXPECT_EQ(model.region_count(), 1);
  EXPECT_EQ(model.face_count(), 6);
  EXPECT_EQ(model.edge_count(), 12);
  EXPECT_EQ(model.vertex_count(), 8);
  checks::expect_watertight(model);
  EXPECT_NEAR(checks::facets_volume(model, 0.1, 0.5), 6, 1e-9);
  const Changes sewn = changes_about(domain.report.changes, "6 faces sewn to 1 closed shells");
  ASSERT_EQ(sewn.size(), 1u);
  EXPECT_NE(sewn[0].what.find("(1e-07 of the diagonal)"), std::string::npos) << sewn[0].what;
  EXPECT_LT(sewn[0].how_much, 1e-12);
}

struct Gap {
  const char* name;
  double share;           ///< of the diagonal
  const char* tolerance;  ///< the smallest of those tried that closes it
  bool wide;
};

class Gaps : public testing::TestWithParam<Gap> {};

TEST_P(Gaps, AreClosedWithTheSmallestToleranceAndTold) {
  const double gap = GetParam().share * diagonal;
  const Domain domain = prepare_fluid(box_with_gap(gap));
  EXPECT_EQ(domain.model.face_count(), 6);
  EXPECT_EQ(domain.model.edge_count(), 12);
  checks::expect_watertight(domain.model);
  EXPECT_NEAR(checks::facets_volume(domain.model, 0.1, 0.5), 6, 4 * gap);
  const Changes sewn = changes_about(domain.report.changes, "6 faces sewn");
  ASSERT_EQ(sewn.size(), 1u);
  EXPECT_NE(sewn[0].what.find(GetParam().tolerance), std::string::npos) << sewn[0].what;
  EXPECT_EQ(sewn[0].what.find("such gaps are wide") != std::string::npos, GetParam().wide) << sewn[0].what;
  // The common edge lies somewhere between the two faces.
  EXPECT_GE(sewn[0].how_much, 0.49 * gap);
  EXPECT_LE(sewn[0].how_much, 1.01 * gap);
  ASSERT_TRUE(sewn[0].where.has_value());
  EXPECT_NEAR(sewn[0].where->z, size.z, 2 * gap);
  EXPECT_EQ(domain.model.sewn_gap(), sewn[0].how_much);
}

const Gap gaps[] = {
    {"OneMillionth", 0.99e-6, "(1e-06 of the diagonal)", false},
    {"FiveMillionths", 5e-6, "(1e-05 of the diagonal)", false},
    {"FiftyMillionths", 5e-5, "(1e-04 of the diagonal)", true},
};
INSTANTIATE_TEST_SUITE_P(Sewing, Gaps, testing::ValuesIn(gaps),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(Sewing, GapsThatElementsWouldShowAreRefused) {
  const double gap = 5e-5 * diagonal;
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.smallest_size = 5 * gap;
  const std::string message = shapes::refusal(box_with_gap(gap), options);
  EXPECT_NE(message.find("8 open edges"), std::string::npos) << message;
  EXPECT_NE(message.find("at (0.5, 0, 3"), std::string::npos) << message;
  EXPECT_NE(message.find("Close the gaps in the CAD program"), std::string::npos) << message;
  options.smallest_size = 50 * gap;
  EXPECT_EQ(shapes::prepare(box_with_gap(gap), options).model.face_count(), 6);
}

TEST(Sewing, GapsAboveTheLargestToleranceAreRefused) {
  const std::string message = shapes::refusal(box_with_gap(1e-3 * diagonal));
  EXPECT_NE(message.find("open edges"), std::string::npos) << message;
  EXPECT_NE(message.find("1e-04 of the diagonal"), std::string::npos) << message;
}

TEST(Sewing, FacesMayLookEitherWay) {
  std::vector<TopoDS_Face> faces = loose_faces(make_box());
  for (const std::size_t turned : {0, 3, 4}) faces[turned].Reverse();
  const Model model = prepare_fluid(compound_of(faces)).model;
  checks::expect_watertight(model);
  EXPECT_NEAR(checks::facets_volume(model, 0.1, 0.5), 6, 1e-9);
}

TEST(Sewing, SeamsAreNoOpenEdges) {
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(1, 2).Shape();
  EXPECT_TRUE(open_edges(cylinder).empty());
  const Model model = prepare_fluid(compound_of(loose_faces(cylinder))).model;
  EXPECT_EQ(model.face_count(), 3);
  checks::expect_watertight(model);
  EXPECT_NEAR(volume_of(model.data().shape), 2 * std::numbers::pi, 1e-6);
}

TEST(Sewing, SeparateBodiesBecomeSeparateSolids) {
  std::vector<TopoDS_Face> faces = loose_faces(make_box());
  for (const TopoDS_Face& face : loose_faces(moved(make_box(), {5, 0, 0}))) faces.push_back(face);
  Changes changes;
  const NamedShape healed = heal(compound_of(faces), changes);
  EXPECT_EQ(solids_of(healed.shape).size(), 2u);
  EXPECT_NEAR(volume_of(healed.shape), 12, 1e-9);
  EXPECT_EQ(changes_about(changes, "12 faces sewn to 2 closed shells").size(), 1u);
}

TEST(Sewing, AnInnerBoxBecomesAVoid) {
  std::vector<TopoDS_Face> faces = loose_faces(make_box());
  const TopoDS_Shape inner = BRepPrimAPI_MakeBox(gp_Pnt(0.25, 0.5, 1), 0.5, 1, 1).Shape();
  for (const TopoDS_Face& face : loose_faces(inner)) faces.push_back(face);
  Changes changes;
  const NamedShape healed = heal(compound_of(faces), changes);
  EXPECT_EQ(solids_of(healed.shape).size(), 1u);
  EXPECT_NEAR(volume_of(healed.shape), 6 - 0.5, 1e-9);
}

TEST(Sewing, FacesKeepTheirLabels) {
  NamedShape named;
  const std::vector<TopoDS_Face> faces = loose_faces(make_box());
  named.shape = compound_of(faces);
  for (const TopoDS_Face& face : faces) {
    FaceLabel label;
    label.name = fmt::format("at {:.2f}", shapes::center_of(face).z);
    named.labels.Bind(face, label);
  }
  Changes changes;
  Volumes volumes;
  const NamedShape healed = make_solids(named, 10, volumes, changes);
  for (const TopoDS_Face& face : shapes::faces_of(healed.shape)) {
    const FaceLabel* label = healed.labels.Seek(face);
    ASSERT_NE(label, nullptr);
    EXPECT_EQ(label->name, fmt::format("at {:.2f}", shapes::center_of(face).z));
  }
}

TEST(Sewing, SolidsInsideOutAreTurned) {
  const TopoDS_Shell shell = TopoDS::Shell(TopExp_Explorer(make_box(), TopAbs_SHELL).Current());
  const TopoDS_Solid inverted = BRepBuilderAPI_MakeSolid(TopoDS::Shell(shell.Reversed())).Solid();
  ASSERT_LT(volume_of(inverted), 0);
  const Domain domain = prepare_fluid(inverted);
  EXPECT_EQ(changes_about(domain.report.changes, "solid 0 was inside out: turned").size(), 1u);
  EXPECT_NEAR(checks::facets_volume(domain.model, 0.1, 0.5), 6, 1e-9);
  checks::expect_watertight(domain.model);
}

TEST(Sewing, InvertedShellsBecomeOutwardSolids) {
  const TopoDS_Shape shell = TopExp_Explorer(make_box(), TopAbs_SHELL).Current();
  const Domain domain = prepare_fluid(shell.Reversed());
  EXPECT_EQ(changes_about(domain.report.changes, "1 closed shells promoted to solids").size(), 1u);
  EXPECT_NEAR(checks::facets_volume(domain.model, 0.1, 0.5), 6, 1e-9);
}

TEST(Sewing, LooseFacesBesideASolidAreDropped) {
  std::vector<TopoDS_Shape> parts{make_box(), BRepBuilderAPI_Copy(shapes::faces_of(make_box())[0]).Shape()};
  const Domain domain = prepare_fluid(compound_of(parts));
  EXPECT_EQ(domain.model.face_count(), 6);
  EXPECT_EQ(domain.model.region_count(), 1);
  const Changes dropped = changes_about(domain.report.changes, "belongs to no solid: dropped");
  ASSERT_EQ(dropped.size(), 1u);
  EXPECT_NE(dropped[0].what.find("a loose face around (0, 1, 1.5)"), std::string::npos) << dropped[0].what;
}

}  // namespace
}  // namespace aeroloom::cad
