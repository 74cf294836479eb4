// touching: writes closed bodies of which two faces touch, or nearly do, or cross, as STEP.
//
// usage: touching crack|slot|crossing|lid FILE.step [APART]
//
// crack: a block, 4 long, with a cut from one end that is APART wide there (default 0) and closes in an edge.
// slot: one with a cut of the same width all along.
// crossing: one with a cut whose walls cross.
// lid: one with a plate within it, turned around, whose upper side is APART below that of the block.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRep_Builder.hxx>
#include <STEPControl_Writer.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

namespace {

using Profile = std::vector<std::pair<double, double>>;

/// A profile in the plane, pulled up by one.
TopoDS_Shape pull(const Profile& profile) {
  BRepBuilderAPI_MakePolygon polygon;
  for (const auto& [x, y] : profile) polygon.Add(gp_Pnt(x, y, 0));
  polygon.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()), gp_Vec(0, 0, 1)).Shape();
}

TopoDS_Shape make_lid(double apart) {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(4, 2, 1).Shape();
  const TopoDS_Shape plate = BRepPrimAPI_MakeBox(gp_Pnt(1, 0.5, 0.7), gp_Pnt(3, 1.5, 1 - apart)).Shape();
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, TopExp_Explorer(block, TopAbs_SHELL).Current());
  builder.Add(solid, TopExp_Explorer(plate, TopAbs_SHELL).Current().Reversed());
  return solid;
}

TopoDS_Shape make(const std::string& kind, double apart) {
  if (kind == "crack") return pull({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {4, 1 + apart}, {4, 2}, {0, 2}});
  if (kind == "slot")
    return pull({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 1 + apart}, {4, 1 + apart}, {4, 2}, {0, 2}});
  if (kind == "crossing")
    return pull({{0, 0}, {4, 0}, {4, 0.8}, {1, 1.2}, {1, 0.8}, {4, 1.2}, {4, 2}, {0, 2}});
  if (kind == "lid") return make_lid(apart);
  throw std::runtime_error("no such body: " + kind);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: touching crack|slot|crossing|lid FILE.step [APART]\n");
    return 2;
  }
  try {
    STEPControl_Writer writer;
    writer.Transfer(make(argv[1], argc > 3 ? std::atof(argv[3]) : 0), STEPControl_AsIs);
    if (writer.Write(argv[2]) != IFSelect_RetDone) throw std::runtime_error("the file cannot be written");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touching: %s\n", error.what());
    return 1;
  }
  return 0;
}
