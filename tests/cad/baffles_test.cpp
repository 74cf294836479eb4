// Faces inside of the fluid: found, kept with their names, joined to what they meet, or refused.
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/model_checks.hpp"

#include <set>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <gp_Pln.hxx>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;
using shapes::compound_of;
using shapes::prepare;
using shapes::prepare_fluid;

TopoDS_Shape make_duct() {
  return BRepPrimAPI_MakeBox(4.0, 1.0, 1.0).Shape();
}

/// A rectangle normal to x, between two corners.
TopoDS_Shape plate(double x, double y_low, double z_low, double y_high, double z_high) {
  const gp_Pln plane(gp_Ax3(gp_Pnt(x, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0)));
  return BRepBuilderAPI_MakeFace(plane, y_low, y_high, z_low, z_high).Shape();
}

TopoDS_Shape make_compound_of(const std::vector<TopoDS_Shape>& parts) {
  return compound_of(parts);
}

TopoDS_Shape sheet_of(const TopoDS_Shape& face) {
  TopoDS_Shell sheet;
  BRep_Builder builder;
  builder.MakeShell(sheet);
  builder.Add(sheet, face);
  return sheet;
}

std::vector<FaceId> baffles_of(const Model& model) {
  std::vector<FaceId> found;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (model.face(f).back != no_entity && model.face(f).front == model.face(f).back) found.push_back(f);
  }
  return found;
}

void expect_baffles(const Domain& domain, double area, double volume) {
  const Model& model = domain.model;
  EXPECT_EQ(model.region_count(), 1);
  checks::expect_closed_loops(model, 1e-6);
  checks::expect_watertight(model);
  EXPECT_NEAR(model.region_volume(0), volume, 1e-9 * volume);
  double sum = 0;
  for (const FaceId f : baffles_of(model)) {
    sum += model.face_area(f);
    EXPECT_EQ(model.patches()[model.face(f).patch], "baffle");
  }
  EXPECT_NEAR(sum, area, 1e-9);
}

/// Edges of the baffles that other faces have too.
std::size_t shared_edges(const Model& model) {
  std::set<EdgeId> shared;
  for (const FaceId f : baffles_of(model)) {
    for (const auto& loop : model.face(f).loops) {
      for (const Coedge& use : loop) {
        if (model.edge(use.edge).faces.size() > 1) shared.insert(use.edge);
      }
    }
  }
  return shared.size();
}

TEST(Baffles, AFaceInsideOfASolidIsOneWhicheverWayTheFileHasIt) {
  const TopoDS_Shape face = plate(2, 0.25, 0.25, 0.75, 0.75);
  BRepAlgoAPI_BuilderAlgo inside;
  TopTools_ListOfShape arguments;
  arguments.Append(make_duct());
  arguments.Append(face);
  inside.SetArguments(arguments);
  inside.Build();
  for (const TopoDS_Shape& shape : {inside.Shape(), TopoDS_Shape(make_compound_of({make_duct(), face})),
                                    TopoDS_Shape(make_compound_of({make_duct(), sheet_of(face)}))}) {
    const Domain domain = prepare_fluid(shape);
    expect_baffles(domain, 0.25, 4);
    EXPECT_EQ(shared_edges(domain.model), 0u);
    const Changes kept = changes_about(domain.report.changes, "lies inside of the fluid: kept as a baffle");
    ASSERT_EQ(kept.size(), 1u);
    const std::string name = domain.model.face(baffles_of(domain.model)[0]).name;
    EXPECT_TRUE(kept[0].what.starts_with("face " + name.substr(5) + " '" + name + "' lies")) << kept[0].what;
    EXPECT_TRUE(kept[0].where && distance(*kept[0].where, {2, 0.5, 0.5}) < 1e-6);
  }
}

// A box in itself would be a body.
TEST(Baffles, InsideOfASolidSayThatItIsTheFluid) {
  BRepAlgoAPI_BuilderAlgo inside;
  TopTools_ListOfShape arguments;
  arguments.Append(make_duct());
  arguments.Append(plate(2, 0.25, 0.25, 0.75, 0.75));
  inside.SetArguments(arguments);
  inside.Build();
  const TopoDS_Shape sheet = sheet_of(plate(2, 0, 0, 1, 0.5));
  for (const auto& shape : {inside.Shape(), TopoDS_Shape(make_compound_of({make_duct(), sheet}))}) {
    const Domain domain = prepare(shape);
    EXPECT_EQ(domain.report.kind, DomainKind::fluid);
    EXPECT_NE(domain.report.reason.find("as baffles do"), std::string::npos) << domain.report.reason;
    EXPECT_EQ(domain.model.region_count(), 1);
    EXPECT_EQ(baffles_of(domain.model).size(), 1u);
  }
  // Two boxes on the diagonal fill less of their hull.
  const TopoDS_Shape apart = BRepPrimAPI_MakeBox(gp_Pnt(5, 5, 5), 4.0, 1.0, 1.0).Shape();
  EXPECT_NE(shapes::refusal(make_compound_of({make_duct(), apart, sheet})).find("kind: fluid"),
            std::string::npos);
}

TEST(Baffles, ShareEdgesWithWallsThatTheyStandOn) {
  // From wall to wall, but for a gap above: one edge of the plate on each of three walls.
  const Domain across = prepare_fluid(make_compound_of({make_duct(), plate(2, 0, 0, 1, 0.5)}));
  expect_baffles(across, 0.5, 4);
  EXPECT_EQ(shared_edges(across.model), 3u);
  // Its edge ends inside of the floor, which is divided there.
  const Domain standing = prepare_fluid(make_compound_of({make_duct(), plate(2, 0.25, 0, 0.75, 0.5)}));
  expect_baffles(standing, 0.25, 4);
  EXPECT_EQ(shared_edges(standing.model), 1u);
}

TEST(Baffles, MeetInALineAndEndOutside) {
  const gp_Pln level(gp_Ax3(gp_Pnt(0, 0, 0.5), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)));
  const TopoDS_Shape floor = BRepBuilderAPI_MakeFace(level, 1.5, 2.5, 0.25, 0.75).Shape();
  const Domain crossing =
      prepare_fluid(make_compound_of({make_duct(), plate(2, 0.25, 0.25, 0.75, 0.75), floor}));
  expect_baffles(crossing, 0.75, 4);
  EXPECT_EQ(baffles_of(crossing.model).size(), 4u);
  EXPECT_EQ(shared_edges(crossing.model), 1u);

  const Domain leaving = prepare_fluid(make_compound_of({make_duct(), plate(2, 0.25, 0.5, 0.75, 1.5)}));
  expect_baffles(leaving, 0.25, 4);
  EXPECT_EQ(changes_about(leaving.report.changes, "without what of it lies outside").size(), 1u);
}

TEST(Baffles, DivideTheFluidWhereTheyReachAllWallsRoundThem) {
  const Domain domain = prepare_fluid(make_compound_of({make_duct(), plate(1, 0, 0, 1, 1)}));
  EXPECT_TRUE(baffles_of(domain.model).empty());
  ASSERT_EQ(domain.model.region_count(), 2);
  EXPECT_NEAR(std::min(domain.model.region_volume(0), domain.model.region_volume(1)), 1, 1e-9);
  checks::expect_watertight(domain.model);
  EXPECT_EQ(shapes::faces_of_patch(domain.model, "interface_0_1").size(), 1u);
  EXPECT_EQ(changes_about(domain.report.changes, "kept as the interface between regions").size(), 1u);
  EXPECT_EQ(changes_about(domain.report.changes, "divide its 1 region(s) into 2").size(), 1u);
}

// Only a fluid of the file has baffles: what is beside bodies, or in them, is dropped or refused as ever.
TEST(Baffles, AreNotBesideBodies) {
  DomainOptions options;
  options.far_field = FarFieldOptions{.shape = FarFieldShape::box, .extent = 3};
  const TopoDS_Shape face = plate(5, -0.5, 0, 0.5, 1);
  const Domain domain = prepare(make_compound_of({make_duct(), face}), options);
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  EXPECT_TRUE(baffles_of(domain.model).empty());
  EXPECT_EQ(changes_about(domain.report.changes, "belongs to no solid: dropped").size(), 1u);
  for (const DomainKind kind : {DomainKind::body, DomainKind::fluid}) {
    options.kind = kind;
    options.far_field.reset();
    EXPECT_NE(shapes::refusal(make_compound_of({make_duct(), sheet_of(face)}), options)
                  .find("around (5, 0, 0.5), bounds no volume"),
              std::string::npos);
  }
}

TEST(Baffles, AreRefusedByNameWhereTheyAreNotWanted) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.baffles = Baffles::refuse;
  const std::string message =
      shapes::refusal(make_compound_of({make_duct(), plate(2, 0.25, 0.25, 0.75, 0.75)}), options);
  for (const char* part : {"face 6 'face_6' around (2, 0.5, 0.5)", "bounds no solid", "Remedy", "keep"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
  // What lies on a wall is none.
  prepare_fluid(make_compound_of({make_duct(), plate(0, 0.25, 0.25, 0.75, 0.75)}));
}

TEST(Baffles, AreInStepFilesThatAreWritten) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  const real::TemporaryFile brep("duct.brep", ""), step("duct.step", "");
  BRepTools::Write(make_compound_of({make_duct(), plate(2, 0, 0, 1, 0.5)}), brep.path().c_str());
  for (const ExportedShape shape : {ExportedShape::geometry, ExportedShape::domain}) {
    options.file = brep.path();
    export_step(options, shape, step.path());
    options.file = step.path();
    expect_baffles(prepare_domain(options), 0.5, 4);
  }
}

TEST(Baffles, OpenBodiesAreNone) {
  std::vector<TopoDS_Shape> parts{make_duct()};
  TopoDS_Shell open;
  BRep_Builder builder;
  builder.MakeShell(open);
  const std::vector<TopoDS_Face> faces = shapes::faces_of(BRepPrimAPI_MakeCylinder(0.5, 2.0).Shape());
  for (const TopoDS_Face& face : faces) {
    if (shapes::center_of(face).z < 1.9) builder.Add(open, face);
  }
  gp_Trsf aside;
  aside.SetTranslation(gp_Vec(10, 0, 0));
  builder.Remove(open, shapes::faces_of(open)[0]);  // neither end: no small planar opening
  parts.push_back(open.Moved(TopLoc_Location(aside)));
  EXPECT_NE(shapes::refusal(make_compound_of(parts)).find("bounds no"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cad
