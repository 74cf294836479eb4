#include "cad/domain/far_field_shape.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/to_vec.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <fmt/format.h>
#include <gp.hxx>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

/// Where the far field stands and how large it is.
struct Extent {
  gp_Pnt center;
  double radius;
};

gp_Ax2 axis_at(const gp_Pnt& origin, Axis axis) {
  return gp_Ax2(origin, axis == Axis::x ? gp::DX() : axis == Axis::y ? gp::DY() : gp::DZ());
}

TopoDS_Solid make_box(const Extent& extent, const std::optional<SymmetryPlane>& symmetry) {
  const double r = extent.radius;
  Vec3 low{extent.center.X() - r, extent.center.Y() - r, extent.center.Z() - r};
  Vec3 high{extent.center.X() + r, extent.center.Y() + r, extent.center.Z() + r};
  if (symmetry) (symmetry->positive ? low : high)[symmetry->axis] = symmetry->position;
  return BRepPrimAPI_MakeBox(to_gp(low), to_gp(high)).Solid();
}

/// A sphere, or the half of it inside the plane.
TopoDS_Solid make_sphere(const Extent& extent, const std::optional<SymmetryPlane>& symmetry) {
  if (!symmetry) return BRepPrimAPI_MakeSphere(extent.center, extent.radius).Solid();
  const gp_Ax2 inward(extent.center, symmetry->plane().Axis().Direction().Reversed());
  return BRepPrimAPI_MakeSphere(inward, extent.radius, 0, std::numbers::pi / 2).Solid();
}

/// A cylinder along its axis, as long as it is wide. A plane along the axis halves it lengthwise, one across
/// makes it end there.
TopoDS_Solid make_cylinder(const Extent& extent, Axis axis, const std::optional<SymmetryPlane>& symmetry) {
  const double r = extent.radius;
  gp_Ax2 frame = axis_at(extent.center, axis);
  if (symmetry && symmetry->axis == static_cast<int>(axis)) {
    frame = gp_Ax2(extent.center, symmetry->plane().Axis().Direction().Reversed());
    return BRepPrimAPI_MakeCylinder(frame, r, r).Solid();
  }
  if (!symmetry) {
    frame.Translate(gp_Vec(frame.Direction()) * -r);
    return BRepPrimAPI_MakeCylinder(frame, r, 2 * r).Solid();
  }
  // 180 degrees from the frame's x direction: the fluid's side lies along its y direction.
  const gp_Dir inward = symmetry->plane().Axis().Direction().Reversed();
  frame = gp_Ax2(extent.center, frame.Direction(), inward.Crossed(frame.Direction()));
  frame.Translate(gp_Vec(frame.Direction()) * -r);
  return BRepPrimAPI_MakeCylinder(frame, r, 2 * r, std::numbers::pi).Solid();
}

TopoDS_Solid make_far_field(const FarFieldOptions& options, const Extent& extent,
                            const std::optional<SymmetryPlane>& symmetry) {
  switch (options.shape) {
    case FarFieldShape::sphere:
    case FarFieldShape::hemisphere:
      return make_sphere(extent, symmetry);
    case FarFieldShape::box:
      return make_box(extent, symmetry);
    case FarFieldShape::cylinder:
      break;
  }
  return make_cylinder(extent, options.axis, symmetry);
}

/// The extent of the far field over that of the bodies' box, at least: at equal extents the two would touch,
/// and there would be no fluid between them. Chosen, not measured.
constexpr double least_clearance = 1.01;

/// The length that the extent is given in. `whole`: of the body before it was cut, `body`: of what is left.
double unit_of(const FarFieldOptions& options, const Box& whole, const Box& body,
               const std::optional<SymmetryPlane>& symmetry) {
  if (options.unit == ExtentUnit::body) return largest_extent(whole.size());
  if (options.unit != ExtentUnit::semispan) return options.unit_length;
  if (symmetry) return body.size()[symmetry->axis];
  Vec3 across = body.size();
  across[static_cast<int>(options.flow)] = 0;
  return 0.5 * largest_extent(across);
}

/// How far the far field must extend from the centre to clear the bodies' box.
double needed_extent(const FarFieldOptions& options, const Box& body, const gp_Pnt& center) {
  Vec3 needed;
  for (int axis = 0; axis < 3; ++axis) {
    const double at = center.Coord(axis + 1);
    needed[axis] = std::max(body.high[axis] - at, at - body.low[axis]);
  }
  if (options.shape == FarFieldShape::box) return largest_extent(needed);
  if (options.shape != FarFieldShape::cylinder) return norm(needed);
  const int axis = static_cast<int>(options.axis);
  return std::max(needed[axis], std::hypot(needed[(axis + 1) % 3], needed[(axis + 2) % 3]));
}

const char* name_of_unit(ExtentUnit unit) {
  constexpr std::array names = {"lengths of the body", "semispans", "length units", "reference lengths"};
  return names[static_cast<std::size_t>(unit)];
}

void require_clearance(const FarFieldOptions& options, const Box& body, const gp_Pnt& center,
                       double reference) {
  const double needed = needed_extent(options, body, center) / reference;
  if (options.extent > least_clearance * needed) return;
  throw CadError(
      fmt::format("the far field cuts the body: its extent of {:.4g} {} ({:.6g}) must exceed "
                  "{:.4g} for this body",
                  options.extent, name_of_unit(options.unit), in_file(reference), least_clearance * needed));
}

void label_far_field(const TopoDS_Solid& far_field, FaceLabels& labels) {
  const TopTools_IndexedMapOfShape faces = map_of(far_field, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) {
    FaceLabel label;
    label.name = faces.Extent() == 1 ? std::string("farfield") : fmt::format("farfield_{}", i);
    label.solid = "fluid";
    label.far_field = true;
    labels.Bind(faces(i), label);
  }
}

}  // namespace

TopoDS_Solid place_far_field(const FarFieldOptions& options, const BodyBoxes& bodies,
                             const std::optional<SymmetryPlane>& symmetry, FaceLabels& labels) {
  const Box& box = bodies.body;
  const double reference = unit_of(options, bodies.whole, box, symmetry);
  gp_Pnt center = to_gp(box.center());
  if (symmetry) center.SetCoord(symmetry->axis + 1, symmetry->position);
  require_clearance(options, box, center, reference);
  TopoDS_Solid far_field = make_far_field(options, {center, options.extent * reference}, symmetry);
  label_far_field(far_field, labels);
  return far_field;
}

}  // namespace aeroloom::cad
