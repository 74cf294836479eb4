#include "geometry/far_field.hpp"

#include "geometry/heal.hpp"
#include "geometry/model_data.hpp"
#include "geometry/shells.hpp"

#include <algorithm>
#include <cmath>

#include <BRepClass3d.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <fmt/format.h>

namespace aeroloom::geometry {
namespace {

double largest_extent(const Box& box) {
  return std::max({box.size().x, box.size().y, box.size().z});
}

TopoDS_Solid make_far_field(const FarFieldOptions& options, Vec3 center, double radius) {
  const gp_Pnt middle(center.x, center.y, center.z);
  if (options.shape == FarFieldShape::sphere) return BRepPrimAPI_MakeSphere(middle, radius).Solid();
  const gp_Pnt low(center.x - radius, center.y - radius, center.z - radius);
  return BRepPrimAPI_MakeBox(low, 2 * radius, 2 * radius, 2 * radius).Solid();
}

/// The far field must lie outside the bodies' box: a sphere outside its corners.
void require_clearance(const FarFieldOptions& options, const Box& body, double reference) {
  const bool sphere = options.shape == FarFieldShape::sphere;
  const double needed = (sphere ? 0.5 * body.diagonal() : 0.5 * largest_extent(body)) / reference;
  if (options.extent > 1.01 * needed) return;
  throw CadError(
      fmt::format("the far field cuts the body: its extent of {:.4g} reference lengths ({:.6g}) must exceed "
                  "{:.4g} for this body",
                  options.extent, reference, 1.01 * needed));
}

/// The shells that face the fluid. A body's cavities hold no outside fluid; a body in another's cavity never
/// meets it.
std::vector<TopoDS_Shell> outer_shells(const TopoDS_Shape& bodies, Volumes& volumes, Changes& changes) {
  std::vector<TopoDS_Shell> shells;
  for (const TopoDS_Solid& solid : solids_of(bodies)) {
    const TopoDS_Shell outer = BRepClass3d::OuterShell(solid);
    if (outer.IsNull()) throw CadError("a body has no outer shell");
    shells.push_back(outer);
    int voids = -1;
    for (TopExp_Explorer each(solid, TopAbs_SHELL); each.More(); each.Next()) ++voids;
    if (voids > 0)
      changes.push_back(
          {fmt::format("{} closed cavities inside a body do not reach the fluid: left out", voids)});
  }
  const std::vector<TopoDS_Solid> nested = nest_shells(shells, volumes);
  std::vector<TopoDS_Shell> outermost;
  for (const TopoDS_Solid& solid : nested) {
    const TopoDS_Shell outer = BRepClass3d::OuterShell(solid);
    const bool buried = std::any_of(nested.begin(), nested.end(), [&](const TopoDS_Solid& other) {
      return !other.IsSame(solid) &&
             nest_shells({BRepClass3d::OuterShell(other), outer}, volumes).size() == 1;
    });
    if (!buried) outermost.push_back(outer);
  }
  if (outermost.size() < shells.size()) {
    changes.push_back({fmt::format("{} bodies lie inside others and do not reach the fluid: left out",
                                   shells.size() - outermost.size())});
  }
  return outermost;
}

/// The CAD library integrates trimmed spline faces to about four digits; what this is to find is a body that
/// vanished or counts twice.
void require_volume(double far_field, double body, double fluid) {
  const double error = std::abs(far_field - body - fluid);
  if (error <= 1e-3 * std::abs(body) + 1e-12 * far_field && body > 0) return;
  throw CadError(
      fmt::format("the volumes do not add up: far field {:.9g}, bodies {:.9g}, fluid {:.9g}; the body's "
                  "shells cross or are turned "
                  "inside out",
                  far_field, body, fluid));
}

}  // namespace

NamedShape surround(NamedShape bodies, const FarFieldOptions& options, Volumes& volumes, Changes& changes) {
  const Box box = tight_box(bodies.shape);
  const double reference = largest_extent(box);
  require_clearance(options, box, reference);
  const TopoDS_Solid outer = make_far_field(options, box.center(), options.extent * reference);
  BRep_Builder builder;
  TopoDS_Solid fluid;
  builder.MakeSolid(fluid);
  builder.Add(fluid, TopExp_Explorer(outer, TopAbs_SHELL).Current());
  double body_volume = 0;
  for (const TopoDS_Shell& shell : outer_shells(bodies.shape, volumes, changes)) {
    const TopoDS_Solid body = solid_of(shell, volumes);
    body_volume += volumes.of(body);
    builder.Add(fluid, TopExp_Explorer(body, TopAbs_SHELL).Current().Reversed());
  }
  require_volume(volumes.of(outer), body_volume, volumes.of(fluid));
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(outer, TopAbs_FACE, faces);
  for (int i = 1; i <= faces.Extent(); ++i) {
    FaceLabel label;
    label.name = faces.Extent() == 1 ? std::string("farfield") : fmt::format("farfield_{}", i);
    label.solid = "fluid";
    label.far_field = true;
    bodies.labels.Bind(faces(i), label);
  }
  bodies.shape = make_compound({fluid});
  return bodies;
}

}  // namespace aeroloom::geometry
