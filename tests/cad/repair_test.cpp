// Repair of shapes that do not close, one repair after the other, each listed as a change.
#include "cad/domain/domain.hpp"
#include "tests/cad/model_checks.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Trsf.hxx>
#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::cad {
namespace {

/// Loose faces of a shape: those that `keep` takes, each moved by `shift` along its number's axis.
TopoDS_Compound loose_faces(const TopoDS_Shape& shape, const std::function<bool(int)>& keep,
                            double shift = 0) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  int index = 0;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next(), ++index) {
    if (!keep(index)) continue;
    gp_Trsf move;
    move.SetTranslation(gp_Vec(index % 2 ? shift : 0, index % 3 ? shift : 0, index == 0 ? shift : 0));
    builder.Add(compound, BRepBuilderAPI_Transform(faces.Current(), move, true).Shape());
  }
  return compound;
}

bool all(int) {
  return true;
}

class Repair : public testing::Test {
protected:
  Domain prepare(const TopoDS_Shape& shape, double smallest_size = 0) {
    BRepTools::Write(shape, _file.c_str());
    DomainOptions options;
    options.file = _file.string();
    options.kind = DomainKind::fluid;
    options.smallest_size = smallest_size;
    return prepare_domain(options);
  }

  std::string message(const TopoDS_Shape& shape, double smallest_size = 0) {
    try {
      prepare(shape, smallest_size);
      return "a model";
    } catch (const CadError& error) {
      return error.what();
    }
  }

  void TearDown() override { std::filesystem::remove(_file); }

  const std::filesystem::path _file =
      std::filesystem::temp_directory_path() / ("aeroloom_repair_" + std::to_string(::getpid()) + ".brep");
};

const Change* find_change(const Domain& domain, const std::string& words) {
  const auto found = std::find_if(domain.report.changes.begin(), domain.report.changes.end(),
                                  [&](const Change& c) { return c.what.find(words) != std::string::npos; });
  return found == domain.report.changes.end() ? nullptr : &*found;
}

double total_area(const Model& model) {
  double area = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) area += model.face_area(f);
  return area;
}

TEST_F(Repair, LooseFacesAreSewn) {
  const Domain domain = prepare(loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), all));
  EXPECT_EQ(domain.model.face_count(), 6);
  checks::expect_watertight(domain.model);
  EXPECT_NE(find_change(domain, "6 faces sewn to 1 closed shells"), nullptr);
  EXPECT_LT(domain.model.sewn_gap(), 1e-9);
}

TEST_F(Repair, GapsAreClosedAndTold) {
  const double diagonal = std::sqrt(14.0);
  for (const double share : {3e-6, 3e-5}) {
    const double gap = share * diagonal;
    const Domain domain = prepare(loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), all, gap));
    checks::expect_watertight(domain.model);
    const Change* sewn = find_change(domain, "sewn");
    ASSERT_NE(sewn, nullptr);
    EXPECT_TRUE(sewn->where.has_value());
    EXPECT_GT(sewn->how_much, 0.2 * gap);
    EXPECT_LT(sewn->how_much, 3 * gap);
    EXPECT_EQ(domain.model.sewn_gap(), sewn->how_much);
  }
}

TEST_F(Repair, GapsThatElementsWouldShowAreLeft) {
  const TopoDS_Compound gaping = loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), all, 1e-4);
  EXPECT_EQ(message(gaping, 0.1), "a model");
  EXPECT_NE(message(gaping, 1e-4).find("open edges: at ("), std::string::npos) << message(gaping, 1e-4);
}

TEST_F(Repair, AnOpenBoxGetsALid) {
  const Domain domain =
      prepare(loose_faces(BRepPrimAPI_MakeBox(4, 5, 6).Shape(), [](int face) { return face != 5; }));
  checks::expect_watertight(domain.model);
  EXPECT_EQ(domain.model.face_count(), 6);
  const Change* cap = find_change(domain, "closed by a face named 'cap_1'");
  ASSERT_NE(cap, nullptr);
  EXPECT_NE(cap->what.find("area 20"), std::string::npos) << cap->what;
  const auto& patches = domain.model.patches();
  EXPECT_EQ(std::find(patches.begin(), patches.end(), "cap_1"), patches.end());
}

TEST_F(Repair, ATubeGetsAnnularCaps) {
  const gp_Ax2 up(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
  const TopoDS_Shape tube = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(up, 1, 4).Shape(),
                                            BRepPrimAPI_MakeCylinder(up, 0.5, 4).Shape())
                                .Shape();
  TopoDS_Compound sides;
  BRep_Builder builder;
  builder.MakeCompound(sides);
  for (TopExp_Explorer faces(tube, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    if (BRepAdaptor_Surface(face).GetType() == GeomAbs_Cylinder) builder.Add(sides, face);
  }
  const Domain domain = prepare(sides);
  checks::expect_watertight(domain.model);
  EXPECT_EQ(domain.model.face_count(), 4);
  EXPECT_NEAR(total_area(domain.model), M_PI * (2 * 4 + 4 + 2 * 0.75), 1e-6);
}

TEST_F(Repair, OpeningsThatAreNotPlanarStayOpen) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 1).Shape();
  const TopoDS_Shape pin =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.3, 0, 0), gp_Dir(0, 0, 1)), 0.3, 3).Shape();
  TopoDS_Compound skin;
  BRep_Builder builder;
  builder.MakeCompound(skin);
  for (TopExp_Explorer faces(BRepAlgoAPI_Cut(ball, pin).Shape(), TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    if (BRepAdaptor_Surface(face).GetType() == GeomAbs_Sphere) builder.Add(skin, face);
  }
  const std::string text = message(skin);
  EXPECT_NE(text.find("bounds no volume"), std::string::npos) << text;
  EXPECT_NE(text.find("open edges: at ("), std::string::npos) << text;
}

TEST_F(Repair, ASheetIsNotCappedToABody) {
  const TopoDS_Compound sheet =
      loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), [](int face) { return face < 1; });
  EXPECT_NE(message(sheet).find("single face"), std::string::npos) << message(sheet);
}

TEST_F(Repair, InsideOutSolidsAreTurned) {
  const Domain domain = prepare(BRepPrimAPI_MakeBox(1, 1, 1).Shape().Reversed());
  checks::expect_watertight(domain.model);
  EXPECT_NEAR(total_area(domain.model), 6, 1e-9);
}

TEST_F(Repair, LooseCopiesOfFacesAreDropped) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  TopoDS_Compound both = loose_faces(box, [](int face) { return face == 2; });
  BRep_Builder().Add(both, box);
  const Domain domain = prepare(both);
  EXPECT_EQ(domain.model.face_count(), 6);
  EXPECT_NE(find_change(domain, "belongs to no solid: dropped"), nullptr);
}

TEST_F(Repair, PlanesNearlyAtZeroAreExactlyThere) {
  const Domain domain = prepare(BRepPrimAPI_MakeBox(gp_Pnt(0, 1e-12, 0), 1, 1, 1).Shape());
  int found = 0;
  for (FaceId f = 0; f < domain.model.face_count(); ++f) {
    const Facets facets = domain.model.facets(f, 0.1, 0.3);
    if (!std::all_of(facets.points.begin(), facets.points.end(), [](Vec3 p) { return std::abs(p.y) < 1e-9; }))
      continue;
    ++found;
    for (const Vec3 p : facets.points) EXPECT_EQ(p.y, 0);
    EXPECT_EQ(domain.model.face_frame(f, facets.uv.front()).point.y, 0);
    EXPECT_EQ(domain.model.project(f, {0.3, 0.1, 0.4}, facets.uv.front()).point.y, 0);
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace aeroloom::cad
