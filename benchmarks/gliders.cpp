// gliders: writes gliders of seven bodies that overlap, as STEP, to see what meshes make of where they meet.
//
// usage: gliders SEED FILE.step
//
// Pod, boom, two half wings that cross in the pod, a fin, two half tails that cross in the fin. How high the
// wings sit, how far the halves reach across, where the boom leaves the pod and where the tails meet the fin
// follows from the seed: curves where bodies meet pass close to each other, to edges and to seams, and leave
// short edges and small sharp corners. In metres: x aft, y to the right, z up.
#include "benchmarks/wing_sections.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Builder.hxx>
#include <GeomFill.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Pln.hxx>
#include <gp_Trsf.hxx>

namespace {

using namespace aeroloom::wings;

/// Numbers in [0, 1) that follow from a seed (splitmix64: Steele, Lea and Flood, OOPSLA 2014,
/// doi:10.1145/2714064.2660195).
class Draw {
public:
  explicit Draw(std::uint64_t seed) : _state(seed) {}
  double between(double low, double high) { return low + (high - low) * next(); }

private:
  double next() {
    std::uint64_t z = (_state += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
  }
  std::uint64_t _state;
};

/// With a sharp trailing edge.
TopoDS_Solid wing(const SpanSection& root, const SpanSection& tip) {
  const auto side = [&](double sign) {
    return BRepBuilderAPI_MakeFace(GeomFill::Surface(side_of(root, sign), side_of(tip, sign)), 1e-9).Face();
  };
  return solid_of({side(1), side(-1), cap(root), cap(tip)}, 1e-7);
}

/// The half wing turned about the x axis by an angle, degrees, about the span by another, and moved.
TopoDS_Shape place(const TopoDS_Shape& shape, double roll, double pitch, gp_Vec by, bool mirrored) {
  constexpr double degree = std::numbers::pi / 180;
  gp_Trsf turn, nose, move, mirror;
  turn.SetRotation(gp_Ax1(gp::Origin(), gp::DX()), roll * degree);
  nose.SetRotation(gp_Ax1(gp::Origin(), gp::DY()), pitch * degree);
  move.SetTranslation(by);
  mirror.SetMirror(gp_Ax2(gp::Origin(), gp::DY()));
  const gp_Trsf all = mirrored ? mirror * move * turn * nose : move * turn * nose;
  return BRepBuilderAPI_Transform(shape, all, Standard_True).Shape();
}

/// A body of revolution about x.
TopoDS_Shape pod(double length, double radius) {
  constexpr int steps = 16;
  const Handle(TColgp_HArray1OfPnt) points = new TColgp_HArray1OfPnt(1, steps + 1);
  for (int i = 0; i <= steps; ++i) {
    const double angle = std::numbers::pi * i / steps;
    points->SetValue(i + 1, gp_Pnt(0.5 * length * (1 - std::cos(angle)), 0,
                                   i % steps == 0 ? 0 : radius * std::pow(std::sin(angle), 0.8)));
  }
  GeomAPI_Interpolate interpolate(points, Standard_False, 1e-9);
  interpolate.Perform();
  const TopoDS_Wire profile =
      BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(interpolate.Curve()).Edge(),
                              BRepBuilderAPI_MakeEdge(gp_Pnt(length, 0, 0), gp::Origin()).Edge());
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(profile).Face(), gp_Ax1(gp::Origin(), gp::DX()))
      .Shape();
}

std::vector<TopoDS_Shape> make(Draw& draw) {
  constexpr double length = 3.2, radius = 0.4, span = 7.5, chord = 0.9;
  const double height = draw.between(-0.36, 0.36), across = draw.between(0.02, 0.3);
  const double dihedral = draw.between(1, 6), incidence = draw.between(-1, 4),
               sweep = draw.between(-0.2, 0.3);
  const double boom_start = draw.between(2.0, 2.9), boom_height = draw.between(0, 0.2);
  const double boom_radius = draw.between(0.08, 0.14), tail = draw.between(5.6, 6.1);
  const double fin_chord = draw.between(0.7, 0.9), tail_height = draw.between(0.1, 1.18);
  const double tail_across = draw.between(0.005, 0.12), tail_chord = draw.between(0.35, 0.6);
  const double tail_x = tail + draw.between(-0.05, 0.35);

  const TopoDS_Solid half = wing({0, 0, chord, 0}, {sweep, span, 0.45 * chord, 0});
  const TopoDS_Solid half_tail = wing({0, 0, tail_chord, 0}, {0.1, 1.4, 0.7 * tail_chord, 0});
  const TopoDS_Solid fin = wing({0, 0, fin_chord, 0}, {0.35, 1.2, 0.6 * fin_chord, 0});
  std::vector<TopoDS_Shape> bodies{pod(length, radius)};
  bodies.push_back(BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(boom_start, 0, boom_height), gp::DX()), boom_radius,
                                        0.6 * boom_radius, tail + 0.75 - boom_start)
                       .Shape());
  for (const bool left : {false, true}) {
    bodies.push_back(place(half, dihedral, incidence, {0.9, -across, height}, left));
    bodies.push_back(place(half_tail, 0, 0, {tail_x, -tail_across, boom_height + tail_height}, left));
  }
  bodies.push_back(place(fin, 90, 0, {tail, 0, boom_height - 0.02}, false));
  return bodies;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: gliders SEED FILE.step\n");
    return 2;
  }
  try {
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));
    Draw draw(std::strtoull(argv[1], nullptr, 10));
    STEPControl_Writer writer;
    for (const TopoDS_Shape& body : make(draw)) writer.Transfer(body, STEPControl_AsIs);
    if (writer.Write(argv[2]) != IFSelect_RetDone) throw std::runtime_error("the file cannot be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gliders: %s\n", error.what());
    return 1;
  }
  return 0;
}
