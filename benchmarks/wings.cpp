// wings: writes half wings with thin blunt trailing edges, to see what meshes make of them.
//
// usage: wings separate|tapered|partly_sharp FILE [TRAILING_EDGE]
//
// TRAILING_EDGE: its thickness over the chord, at the root of partly_sharp, instead of:
// separate: IGES, faces that share no edges; rectangular, trailing edge 0.3 % of the chord.
// tapered: STEP; swept, the tip a tenth of the root, trailing edge 0.3 % of the chord.
// partly_sharp: STEP; trailing edge 0.2 % of the chord at the root, sharp at the tip.
//
// In millimetres: x aft, y to the tip, z up; the root in the plane y = 0.
#include "benchmarks/wing_sections.hpp"

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <GeomFill.hxx>
#include <IGESControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt.hxx>

namespace {

using namespace aeroloom::wings;

TopoDS_Face between(const Handle(Geom_Curve) & a, const Handle(Geom_Curve) & b) {
  return BRepBuilderAPI_MakeFace(GeomFill::Surface(a, b), 1e-9).Face();
}

TopoDS_Face trailing_edge(const SpanSection& root, const SpanSection& tip) {
  BRepBuilderAPI_MakePolygon wire(point_of(root, 1, -1), point_of(root, 1, 1), point_of(tip, 1, 1));
  if (tip.trailing_edge > 0) wire.Add(point_of(tip, 1, -1));
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

std::vector<TopoDS_Face> faces_between(const SpanSection& root, const SpanSection& tip) {
  return {between(side_of(root, 1), side_of(tip, 1)), between(side_of(root, -1), side_of(tip, -1)), cap(root),
          cap(tip), trailing_edge(root, tip)};
}

/// IGES as many programs write it: surfaces trimmed one by one.
void write_separate(const std::vector<TopoDS_Face>& faces, const char* file) {
  IGESControl_Writer writer("MM", 0);
  for (const TopoDS_Face& face : faces) writer.AddShape(face);
  writer.ComputeModel();
  if (!writer.Write(file)) throw std::runtime_error("the file cannot be written");
}

void write_solid(const std::vector<TopoDS_Face>& faces, const char* file) {
  STEPControl_Writer writer;
  writer.Transfer(solid_of(faces, 1e-6), STEPControl_AsIs);
  if (writer.Write(file) != IFSelect_RetDone) throw std::runtime_error("the file cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc == 3 || argc == 4 ? argv[1] : "";
  try {
    const auto edge = [&](double usual) { return argc == 4 ? std::stod(argv[3]) : usual; };
    if (kind == "separate") {
      write_separate(faces_between({0, 0, 1000, edge(0.003)}, {0, 3000, 1000, edge(0.003)}), argv[2]);
    } else if (kind == "tapered") {
      write_solid(faces_between({0, 0, 1000, edge(0.003)}, {1200, 3000, 100, edge(0.003)}), argv[2]);
    } else if (kind == "partly_sharp") {
      write_solid(faces_between({0, 0, 1000, edge(0.002)}, {600, 3000, 500, 0}), argv[2]);
    } else {
      std::fprintf(stderr, "usage: wings separate|tapered|partly_sharp FILE [TRAILING_EDGE]\n");
      return 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wings: %s\n", error.what());
    return 1;
  }
  return 0;
}
