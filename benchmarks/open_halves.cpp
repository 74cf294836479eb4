// open_halves: writes halves of bodies as surfaces that are open on their plane of symmetry, and elsewhere.
//
// usage: open_halves NAME FILE
//
// FILE: .brep, .step or .igs; IGES is written as faces that share no edges. Printed: the area of the walls of
// the half, those included that the file lacks. x aft, y away from the plane, z up.
//
// fin_on_plane: a fuselage with a fin on the plane, without the fin's tip and blunt base.
// nacelle: an open tube, cut along its axis.
// wing_root: a wing, open at its root, without its blunt trailing edge.
// jagged: a fuselage whose border leaves the plane in a row of notches.
// offset_small, offset_large: a fuselage beside its plane by 1e-5 and by 1e-3 of its length.
// uneven: a fuselage whose border is tilted and misses the plane by 2e-5 of its length at most.
// two_solids: a half fuselage with a pod that is closed, and another half.
// blunt_base: a body of revolution without its base.
// overlapping: a fuselage that reaches 1 % of its length across its plane.
// open_tip: a wing without its tip, which is no plane.
// kinked_wing: a wing of two panels, open at its root, without its blunt trailing edge.
// hatch: a fuselage that lacks a face which is no plane.
#include "benchmarks/wing_sections.hpp"

#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GC_MakeSegment.hxx>
#include <GProp_GProps.hxx>
#include <GeomConvert.hxx>
#include <GeomFill.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>

namespace {

using namespace aeroloom::wings;

using Faces = std::vector<TopoDS_Face>;

constexpr double length = 1000, radius = 100;  // of the fuselage

GProp_GProps properties_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return properties;
}

/// Walls with what the file has of them.
struct Half {
  std::vector<TopoDS_Shape> shapes;
  double area = 0;
};

/// A face by its middle.
using Choose = std::function<bool(const gp_Pnt&)>;

bool on_plane(const gp_Pnt& at) {
  return std::abs(at.Y()) < 1e-6;
}

/// A closed half without its flat side and what else is to lack.
Half open(const TopoDS_Shape& body, const Choose& lacks = {}) {
  Half half;
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  for (TopExp_Explorer each(body, TopAbs_FACE); each.More(); each.Next()) {
    const GProp_GProps properties = properties_of(each.Current());
    if (on_plane(properties.CentreOfMass())) continue;
    half.area += properties.Mass();
    if (!lacks || !lacks(properties.CentreOfMass())) builder.Add(faces, each.Current());
  }
  half.shapes.push_back(faces);
  return half;
}

TopoDS_Shape box(gp_Pnt low, gp_Pnt high) {
  return BRepPrimAPI_MakeBox(low, high).Shape();
}

/// The half of a body of revolution about x; `end`: radius at its rear end.
TopoDS_Shape half_pod(double end, double turn = std::numbers::pi) {
  constexpr int steps = 12;
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    const double angle = std::numbers::pi * i / steps, x = 0.5 * (1 - std::cos(angle));
    points->SetValue(
        i + 1, gp_Pnt(length * x, 0, i == 0 ? 0 : radius * (std::sin(angle) * (1 - 0.2 * x)) + end * x * x));
  }
  GeomAPI_Interpolate interpolate(points, false, 1e-9);
  interpolate.Perform();
  BRepBuilderAPI_MakeWire profile(BRepBuilderAPI_MakeEdge(interpolate.Curve()).Edge());
  const gp_Pnt tail(length, 0, 0);
  if (end > 0) profile.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(length, 0, end), tail).Edge());
  profile.Add(BRepBuilderAPI_MakeEdge(tail, gp::Origin()).Edge());
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(profile.Wire()).Face(),
                               gp_Ax1(gp::Origin(), gp_Dir(-1, 0, 0)), turn)
      .Shape();
}

TopoDS_Face end_of(const SpanSection& root, const SpanSection& tip) {
  const auto line = [](const SpanSection& section) {
    return GeomConvert::CurveToBSplineCurve(
        GC_MakeSegment(point_of(section, 1, -1), point_of(section, 1, 1)).Value());
  };
  return BRepBuilderAPI_MakeFace(GeomFill::Surface(line(root), line(tip)), 1e-9).Face();
}

TopoDS_Face side(const SpanSection& root, const SpanSection& tip, double sign) {
  return BRepBuilderAPI_MakeFace(GeomFill::Surface(side_of(root, sign), side_of(tip, sign)), 1e-9).Face();
}

TopoDS_Solid wing(const SpanSection& root, const SpanSection& tip) {
  return solid_of({side(root, tip, 1), side(root, tip, -1), end_of(root, tip), cap(root), cap(tip)}, 1e-6);
}

TopoDS_Shape moved(const TopoDS_Shape& shape, gp_Vec by) {
  gp_Trsf along;
  along.SetTranslation(by);
  return BRepBuilderAPI_Transform(shape, along, true).Shape();
}

TopoDS_Shape turned(const TopoDS_Shape& shape, gp_Ax1 axis, double angle) {
  gp_Trsf turn;
  turn.SetRotation(axis, angle);
  return BRepBuilderAPI_Transform(shape, turn, true).Shape();
}

TopoDS_Shape fuselage_with_wing() {
  const TopoDS_Solid half = wing({350, 0, 250, 0.01}, {480, 700, 110, 0.01});
  return BRepAlgoAPI_Fuse(half_pod(0), half).Shape();
}

Half fin_on_plane() {
  const TopoDS_Solid upright = wing({0, 0, 180, 0.02}, {90, 260, 90, 0.02});
  const TopoDS_Shape fin = BRepAlgoAPI_Common(
      moved(turned(upright, gp_Ax1(gp::Origin(), gp::DX()), std::numbers::pi / 2), {780, 0, 10}),
      box({-1e4, 0, -1e4}, {1e4, 1e4, 1e4}));
  return open(BRepAlgoAPI_Fuse(fuselage_with_wing(), fin).Shape(), [](const gp_Pnt& at) {
    const bool tip = at.Z() > 269;
    const bool base = at.Y() < 3 && at.X() > 950 && at.Z() > 60;
    return tip || base;
  });
}

Half nacelle() {
  const gp_Ax1 axis(gp::Origin(), gp_Dir(-1, 0, 0));
  const auto ring = [&](double sign) {
    return BRepBuilderAPI_MakeEdge(side_of({0, 0, 400, 0.01}, sign)).Edge();
  };
  BRepBuilderAPI_MakeWire profile(
      ring(1), ring(-1),
      BRepBuilderAPI_MakeEdge(point_of({0, 0, 400, 0.01}, 1, 1), point_of({0, 0, 400, 0.01}, 1, -1)).Edge());
  const TopoDS_Shape section = moved(profile.Wire(), {0, 0, 150});
  const TopoDS_Face face =
      BRepBuilderAPI_MakeFace(gp_Pln(gp::Origin(), gp::DY()), TopoDS::Wire(section)).Face();
  return open(BRepPrimAPI_MakeRevol(face, axis, std::numbers::pi).Shape());
}

Half wing_root() {
  return open(wing({0, 0, 300, 0.01}, {150, 900, 120, 0.01}), [](const gp_Pnt& at) {
    const double share = at.Y() / 900;
    return at.Y() < 899 && at.X() > 150 * share + (300 - 180 * share) - 1;
  });
}

Half kinked_wing() {
  const SpanSection root{0, 0, 300, 0.01}, kink{120, 400, 200, 0.01}, tip{320, 900, 90, 0.01};
  const TopoDS_Solid body =
      solid_of({side(root, kink, 1), side(root, kink, -1), end_of(root, kink), side(kink, tip, 1),
                side(kink, tip, -1), end_of(kink, tip), cap(root), cap(tip)},
               1e-6);
  return open(body, [](const gp_Pnt& at) {
    const double y = at.Y(), rear = y < 400 ? 300 + 20 * y / 400 : 320 + 90 * (y - 400) / 500;
    return y < 899 && at.X() > rear - 1;
  });
}

Half jagged() {
  const TopoDS_Shape body = fuselage_with_wing();
  TopoDS_Shape cut = body;
  for (int i = 0; i < 9; ++i) {
    const double x = 200 + 60 * i, deep = 0.5 + 0.3 * i;
    cut = BRepAlgoAPI_Cut(cut, box({x, -1, 0}, {x + 5 + 2 * i, deep, 500})).Shape();
  }
  Half half = open(cut, [](const gp_Pnt& at) {
    return at.Y() < 5 && at.Z() < 75 && at.Z() > -60 && at.X() > 190 && at.X() < 760;
  });
  half.area = open(body).area;
  return half;
}

Half beside(double by) {
  Half half = open(fuselage_with_wing());
  half.shapes = {moved(half.shapes.front(), {0, by, 0})};
  return half;
}

Half uneven() {
  Half half = open(fuselage_with_wing());
  half.shapes = {turned(half.shapes.front(), gp_Ax1(gp_Pnt(0.5 * length, 0, 0), gp::DZ()), 4e-5)};
  return half;
}

Half two_solids() {
  Half half = open(fuselage_with_wing());
  gp_Trsf smaller;
  smaller.SetScale(gp::Origin(), 0.3);
  const TopoDS_Shape small = BRepBuilderAPI_Transform(half_pod(0), smaller, true).Shape();
  const Half other = open(moved(small, {300, 0, 300}));
  half.area += other.area;
  half.shapes.push_back(other.shapes.front());
  const TopoDS_Shape pod = moved(
      BRepBuilderAPI_Transform(half_pod(0, 2 * std::numbers::pi), smaller, true).Shape(), {400, 350, -120});
  half.area += properties_of(pod).Mass();
  half.shapes.push_back(pod);
  return half;
}

Half blunt_base() {
  return open(half_pod(40), [](const gp_Pnt& at) { return at.X() > length - 1e-3; });
}

Half overlapping() {
  const TopoDS_Shape body = fuselage_with_wing(), across = half_pod(0, 2 * std::numbers::pi);
  const TopoDS_Shape all = BRepAlgoAPI_Fuse(across, wing({350, 0, 250, 0.01}, {480, 700, 110, 0.01})).Shape();
  Half half = open(body);
  const TopoDS_Shape part = BRepAlgoAPI_Common(all, box({-1e4, -10, -1e4}, {1e4, 1e4, 1e4})).Shape();
  TopoDS_Compound faces;
  BRep_Builder builder;
  builder.MakeCompound(faces);
  for (TopExp_Explorer each(part, TopAbs_FACE); each.More(); each.Next())
    if (std::abs(properties_of(each.Current()).CentreOfMass().Y() + 10) > 1e-6)
      builder.Add(faces, each.Current());
  half.shapes = {faces};
  return half;
}

/// The end of a wing, cut by a cylinder, is no plane.
TopoDS_Shape bowed_wing() {
  const TopoDS_Shape round =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-1e3, 300, 0), gp::DX()), 500, 3e3).Shape();
  return BRepAlgoAPI_Common(wing({0, 0, 300, 0.01}, {150, 900, 120, 0.01}), round).Shape();
}

Half open_tip() {
  return open(bowed_wing(), [](const gp_Pnt& at) { return at.Y() > 790; });
}

Half hatch() {
  const TopoDS_Shape body = fuselage_with_wing();
  const TopoDS_Shape divided = BRepAlgoAPI_Cut(body, box({180, 40, 50}, {230, 60, 200})).Shape();
  Half half = open(divided, [](const gp_Pnt& at) {
    return at.X() > 179 && at.X() < 231 && at.Y() > 39 && at.Y() < 61 && at.Z() > 49;
  });
  half.area = open(body).area;
  return half;
}

const std::map<std::string, std::function<Half()>> halves = {
    {"fin_on_plane", fin_on_plane},
    {"nacelle", nacelle},
    {"wing_root", wing_root},
    {"kinked_wing", kinked_wing},
    {"jagged", jagged},
    {"offset_small", [] { return beside(1e-5 * length); }},
    {"offset_large", [] { return beside(1e-3 * length); }},
    {"uneven", uneven},
    {"two_solids", two_solids},
    {"blunt_base", blunt_base},
    {"overlapping", overlapping},
    {"open_tip", open_tip},
    {"hatch", hatch}};

void write(const Half& half, const std::string& file) {
  bool written = false;
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : half.shapes) builder.Add(all, shape);
  if (file.ends_with(".brep")) {
    written = BRepTools::Write(all, file.c_str());
  } else if (file.ends_with(".igs")) {
    IGESControl_Writer writer("MM", 0);
    for (TopExp_Explorer each(all, TopAbs_FACE); each.More(); each.Next()) writer.AddShape(each.Current());
    writer.ComputeModel();
    written = writer.Write(file.c_str());
  } else {
    STEPControl_Writer writer;
    for (const TopoDS_Shape& shape : half.shapes) writer.Transfer(shape, STEPControl_AsIs);
    written = writer.Write(file.c_str()) == IFSelect_RetDone;
  }
  if (!written) throw std::runtime_error("the file cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3 || !halves.contains(argv[1])) {
    std::fprintf(stderr, "usage: open_halves NAME FILE\nnames:");
    for (const auto& [name, make] : halves) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  try {
    const Half half = halves.at(argv[1])();
    write(half, argv[2]);
    std::printf("%.9g\n", half.area);
  } catch (const Standard_Failure& error) {
    std::fprintf(stderr, "open_halves: %s\n", error.GetMessageString());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "open_halves: %s\n", error.what());
    return 1;
  }
  return 0;
}
