// noise_wings: writes bodies with strips far too narrow for any element, to see that they are closed.
//
// usage: noise_wings skin|ring|edge|collar|slit|regions SHARE FILE [UNIT]
//
// SHARE: width of the strip over the wing's length, 1e-8 and more. FILE: .step or .igs; IGES is written as
// faces that share no edges (regions as solids). UNIT: MM (default), INCH, M.
//
// skin: a strip along the span in the middle of the upper side.
// ring: three strips around the section half-way to the tip: upper side, lower side, trailing edge.
// edge: a blunt trailing edge as thin as that.
// collar: a pod with a strip around it, one face between two closed edges.
// slit: a pod whose side is one face but for a strip from end to end.
// regions: two solids that meet half-way to the tip, in a section with a strip along the chord.
//
// x aft, y to the tip, z up; chord 1000, length 3000 (a tenth of that in inches), trailing edge 2 % of the
// chord.
#include "benchmarks/wing_sections.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
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
#include <Geom_BSplineSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>

namespace {

using namespace aeroloom::wings;

/// A cut of a side or of the span: two places that near each other.
struct Cut {
  double at, width;
};

struct Sizes {
  double chord, length, width;
};

/// Parts of an interval, cut where there is a cut.
std::vector<std::pair<double, double>> parts_of(double first, double last, const Cut* cut) {
  if (cut == nullptr) return {{first, last}};
  return {{first, cut->at}, {cut->at, cut->at + cut->width}, {cut->at + cut->width, last}};
}

/// The faces of a ruled surface, cut along the section and along the span.
void add_side(const SpanSection& a, const SpanSection& b, double sign, const Cut* chordwise,
              const Cut* spanwise, std::vector<TopoDS_Face>& faces) {
  const Handle(Geom_Surface) surface = GeomFill::Surface(side_of(a, sign), side_of(b, sign));
  double u0, u1, v0, v1;
  surface->Bounds(u0, u1, v0, v1);
  for (const auto& [low, high] : parts_of(u0, u1, chordwise)) {
    for (const auto& [from, to] : parts_of(v0, v1, spanwise))
      faces.push_back(BRepBuilderAPI_MakeFace(surface, low, high, from, to, 1e-9).Face());
  }
}

TopoDS_Face polygon(const std::vector<gp_Pnt>& corners) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& corner : corners) wire.Add(corner);
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

void add_end(const SpanSection& a, const SpanSection& b, const Cut* spanwise,
             std::vector<TopoDS_Face>& faces) {
  const auto at = [&](double share, double sign) {
    const gp_Pnt p = point_of(a, 1, sign), q = point_of(b, 1, sign);
    return gp_Pnt(p.XYZ() + share * (q.XYZ() - p.XYZ()));
  };
  for (const auto& [from, to] : parts_of(0, 1, spanwise))
    faces.push_back(polygon({at(from, -1), at(from, 1), at(to, 1), at(to, -1)}));
}

std::vector<TopoDS_Face> wing(const SpanSection& root, const SpanSection& tip, const Cut* chordwise,
                              const Cut* spanwise) {
  std::vector<TopoDS_Face> faces;
  add_side(root, tip, 1, chordwise, spanwise, faces);
  add_side(root, tip, -1, nullptr, spanwise, faces);
  add_end(root, tip, spanwise, faces);
  return faces;
}

/// The section in three faces: above the strip, the strip, below it.
void add_cut_section(const SpanSection& section, double width, std::vector<TopoDS_Face>& faces) {
  const Handle(Geom_BSplineCurve) upper = side_of(section, 1), lower = side_of(section, -1);
  double low = upper->FirstParameter(), high = 0.2;  // where the upper side is as high as the strip
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (upper->Value(middle).Z() < width ? low : high) = middle;
  }
  const double x = section.x + section.chord, y = section.y;
  const gp_Pnt nose = point_of(section, 0, 1), on_upper = upper->Value(low), end(x, y, 0), above(x, y, width);
  const gp_Pln plane(nose, gp::DY());
  const auto edge = [](const gp_Pnt& a, const gp_Pnt& b) { return BRepBuilderAPI_MakeEdge(a, b).Edge(); };
  const auto face = [&](const std::vector<TopoDS_Edge>& edges) {
    BRepBuilderAPI_MakeWire wire;
    for (const TopoDS_Edge& each : edges) wire.Add(each);
    faces.push_back(BRepBuilderAPI_MakeFace(plane, wire.Wire()).Face());
  };
  face({BRepBuilderAPI_MakeEdge(upper, low, upper->LastParameter()).Edge(),
        edge(point_of(section, 1, 1), above), edge(above, on_upper)});
  face({BRepBuilderAPI_MakeEdge(upper, upper->FirstParameter(), low).Edge(), edge(on_upper, above),
        edge(above, end), edge(end, nose)});
  face({BRepBuilderAPI_MakeEdge(lower).Edge(), edge(point_of(section, 1, -1), end), edge(end, nose)});
}

std::vector<TopoDS_Face> pod(const Sizes& sizes, bool slit) {
  const double radius = 0.2 * sizes.chord, half = 0.5 * sizes.length;
  const Handle(Geom_Surface) side = new Geom_CylindricalSurface(gp_Ax3(gp::Origin(), gp::DY()), radius);
  std::vector<TopoDS_Face> faces;
  const double turn = 2 * std::numbers::pi, cut = sizes.width / radius;
  const auto add = [&](double u0, double u1, double v0, double v1) {
    faces.push_back(BRepBuilderAPI_MakeFace(side, u0, u1, v0, v1, 1e-9).Face());
  };
  if (slit) {
    add(0, cut, 0, sizes.length);
    add(cut, turn, 0, sizes.length);
  } else {
    add(0, turn, 0, half);
    add(0, turn, half, half + sizes.width);
    add(0, turn, half + sizes.width, sizes.length);
  }
  for (const double y : {0.0, sizes.length}) {
    const gp_Ax2 axes(gp_Pnt(0, y, 0), gp::DY());
    BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(gp_Circ(axes, radius)).Edge());
    faces.push_back(BRepBuilderAPI_MakeFace(gp_Pln(gp_Ax3(axes)), wire.Wire()).Face());
  }
  return faces;
}

TopoDS_Solid solid_of(const std::vector<TopoDS_Face>& faces, double width) {
  BRepBuilderAPI_Sewing sewing(std::min(1e-6, 0.05 * width));
  for (const TopoDS_Face& face : faces) sewing.Add(face);
  sewing.Perform();
  if (sewing.SewedShape().ShapeType() != TopAbs_SHELL || sewing.NbFreeEdges() > 0)
    throw std::runtime_error("the faces do not close");
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape()));
  BRepLib::OrientClosedSolid(solid);
  return solid;
}

std::vector<std::vector<TopoDS_Face>> bodies(const std::string& kind, const Sizes& sizes) {
  const double end = kind == "edge" ? sizes.width / sizes.chord : 0.02;
  const SpanSection root{0, 0, sizes.chord, end},
      tip{0.2 * sizes.chord, sizes.length, 0.7 * sizes.chord, end};
  const SpanSection middle{0.1 * sizes.chord, 0.5 * sizes.length, 0.85 * sizes.chord, end};
  if (kind == "collar" || kind == "slit") return {pod(sizes, kind == "slit")};
  if (kind == "regions") {
    std::vector<TopoDS_Face> inner = wing(root, middle, nullptr, nullptr),
                             outer = wing(middle, tip, nullptr, nullptr);
    inner.push_back(cap(root)), outer.push_back(cap(tip));
    add_cut_section(middle, sizes.width, inner);
    add_cut_section(middle, sizes.width, outer);
    return {inner, outer};
  }
  // Along the curve, in its parameter, which is an angle: 1 - cos(angle) chords.
  const Cut chordwise{0.9, sizes.width / (sizes.chord * std::sin(0.9))};
  const Cut spanwise{0.5, sizes.width / sizes.length};
  std::vector<TopoDS_Face> faces;
  if (kind == "skin")
    faces = wing(root, tip, &chordwise, nullptr);
  else if (kind == "ring")
    faces = wing(root, tip, nullptr, &spanwise);
  else if (kind == "edge")
    faces = wing(root, tip, nullptr, nullptr);
  else
    throw std::runtime_error("no such kind");
  faces.push_back(cap(root)), faces.push_back(cap(tip));
  return {faces};
}

void write(const std::vector<std::vector<TopoDS_Face>>& parts, double width, const std::string& file,
           const std::string& unit) {
  Interface_Static::SetCVal("xstep.cascade.unit", unit.c_str());
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  bool written = false;
  if (file.ends_with(".igs")) {
    IGESControl_Writer writer(unit == "INCH" ? "IN" : unit.c_str(), parts.size() > 1 ? 1 : 0);
    for (const auto& faces : parts) {
      if (parts.size() > 1) {
        writer.AddShape(solid_of(faces, width));
      } else {
        for (const TopoDS_Face& face : faces) writer.AddShape(face);
      }
    }
    writer.ComputeModel();
    written = writer.Write(file.c_str());
  } else {
    STEPControl_Writer writer;
    for (const auto& faces : parts) writer.Transfer(solid_of(faces, width), STEPControl_AsIs);
    written = writer.Write(file.c_str()) == IFSelect_RetDone;
  }
  if (!written) throw std::runtime_error("the file cannot be written");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc > 5) {
    std::fprintf(stderr, "usage: noise_wings skin|ring|edge|collar|slit|regions SHARE FILE [MM|INCH|M]\n");
    return 2;
  }
  try {
    const std::string unit = argc == 5 ? argv[4] : "MM";
    const double scale = unit == "MM" ? 1 : 0.1;
    const Sizes sizes{scale * 1000, scale * 3000, std::atof(argv[2]) * scale * 3000};
    STEPControl_Writer initialise;
    IGESControl_Writer initialise_too;
    write(bodies(argv[1], sizes), sizes.width, argv[3], unit);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "noise_wings: %s\n", error.what());
    return 1;
  }
  return 0;
}
