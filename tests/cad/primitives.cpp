#include "tests/cad/primitives.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"

#include <cmath>

#include <BRepAdaptor_Surface.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

TopoDS_Shape make_box(Vec3 size) {
  const gp_Pnt corner(-0.5 * size.x, -0.5 * size.y, -0.5 * size.z);
  return BRepPrimAPI_MakeBox(corner, size.x, size.y, size.z).Solid();
}

/// The box with the sphere's shell turned inside out as a void: exact, no boolean operation.
TopoDS_Shape make_box_with_sphere(const PrimitiveDimensions& d) {
  if (2 * d.radius >= std::min({d.box.x, d.box.y, d.box.z}))
    throw CadError("the sphere does not fit into the box");
  const TopoDS_Shape box = make_box(d.box);
  const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(d.radius).Solid();
  BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, TopExp_Explorer(box, TopAbs_SHELL).Current());
  builder.Add(solid, TopExp_Explorer(sphere, TopAbs_SHELL).Current().Reversed());
  return solid;
}

TopoDS_Shape make_shape(PrimitiveKind kind, const PrimitiveDimensions& d) {
  switch (kind) {
    case PrimitiveKind::box:
      return make_box(d.box);
    case PrimitiveKind::sphere:
      return BRepPrimAPI_MakeSphere(d.radius).Solid();
    case PrimitiveKind::cylinder:
      return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, -0.5 * d.height), gp::DZ()), d.radius, d.height)
          .Solid();
    case PrimitiveKind::torus:
      return BRepPrimAPI_MakeTorus(d.major_radius, d.radius).Solid();
    case PrimitiveKind::box_with_sphere:
      return make_box_with_sphere(d);
  }
  throw CadError("unknown shape");
}

/// "xmin" and so on, from the side of the centre a planar face lies on.
std::string side_name(const TopoDS_Shape& face) {
  const Box box = tight_box(face);
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (box.size()[i] < box.size()[axis]) axis = i;
  }
  static const char* const names[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
  return names[axis][box.center()[axis] < 0 ? 0 : 1];
}

FaceTag tag_face(PrimitiveKind kind, const TopoDS_Shape& face) {
  const bool planar = BRepAdaptor_Surface(TopoDS::Face(face)).GetType() == GeomAbs_Plane;
  std::string name = "sphere";
  if (kind == PrimitiveKind::torus) name = "torus";
  if (kind == PrimitiveKind::cylinder) name = "side";
  if (planar) name = side_name(face);
  if (planar && kind == PrimitiveKind::cylinder) name = name == "zmin" ? "bottom" : "top";
  const bool far_field = planar && kind == PrimitiveKind::box_with_sphere;
  return {name, far_field ? "farfield" : name, far_field};
}

}  // namespace

Model make_primitive_domain(PrimitiveKind kind, const PrimitiveDimensions& dimensions) {
  return guarded("making an analytic shape", [&] {
    NamedShape named;
    named.shape = make_shape(kind, dimensions);
    named.unit_name = std::string("m");
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(named.shape, TopAbs_FACE, faces);
    std::vector<FaceTag> tags;
    for (int i = 1; i <= faces.Extent(); ++i) tags.push_back(tag_face(kind, faces(i)));
    return build_model(named, tags);
  });
}

}  // namespace aeroloom::cad
