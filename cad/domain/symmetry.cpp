#include "cad/domain/symmetry.hpp"

#include "cad/domain/booleans.hpp"
#include "cad/domain/flat_sides.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomLib_IsPlanarSurface.hxx>
#include <Geom_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

constexpr char axis_names[] = {'x', 'y', 'z'};

/// Where a body may end at a plane: a side of its box with planar faces on it.
struct End {
  SymmetryPlane plane;
  double area = 0;
};

/// Sides with planar faces on the plane there; with `flat_sides`, also with those that it reaches.
std::vector<End> find_ends(const TopoDS_Shape& bodies, const Box& box, bool flat_sides) {
  std::vector<End> ends;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool positive : {true, false}) {
      End end;
      end.plane.axis = axis;
      end.plane.positive = positive;
      end.plane.position = positive ? box.low[axis] : box.high[axis];
      end.plane.tolerance = tolerances::same_place * box.diagonal();
      end.plane.reach = tolerances::on_symmetry * box.diagonal();
      if (std::abs(end.plane.position) <= (flat_sides ? end.plane.reach : end.plane.tolerance))
        end.plane.position = 0;
      for (TopExp_Explorer faces(bodies, TopAbs_FACE); faces.More(); faces.Next()) {
        const TopoDS_Face face = TopoDS::Face(faces.Current());
        if (flat_sides ? !is_flat_side(face, end.plane) : !end.plane.holds(face)) continue;
        GProp_GProps properties;
        BRepGProp::SurfaceProperties(face, properties);
        end.area += std::abs(properties.Mass());
      }
      if (end.area > 0) ends.push_back(end);
    }
  }
  return ends;
}

/// Largest area first, ends at a coordinate plane before others.
const End* best_end(const std::vector<End>& ends, std::optional<int> axis) {
  const End* best = nullptr;
  const auto better = [](const End& a, const End& b) {
    const bool at_zero = a.plane.position == 0;
    return at_zero != (b.plane.position == 0) ? at_zero : a.area > b.area;
  };
  for (const End& end : ends) {
    if (axis && end.plane.axis != *axis) continue;
    if (!best || better(end, *best)) best = &end;
  }
  return best;
}

SymmetryPlane plane_at(int axis, double position, const Box& box, std::string reason) {
  const double tolerance = tolerances::same_place * box.diagonal(),
               reach = tolerances::on_symmetry * box.diagonal();
  if (position < box.low[axis] - reach || position > box.high[axis] + reach) {
    throw CadError(
        fmt::format("the plane of symmetry {} = {:.6g} misses the body, which reaches from {:.6g} to "
                    "{:.6g}, by more than the {:.3g} ({:.0e} of the diagonal) that a body is carried on to "
                    "its plane: give FarFieldOptions::symmetry_position",
                    axis_names[axis], in_file(position), in_file(box.low[axis]), in_file(box.high[axis]),
                    in_file(reach), tolerances::on_symmetry));
  }
  const bool positive = box.high[axis] - position > std::min(reach, position - box.low[axis]);
  return {axis, position, positive, tolerance, reach, std::move(reason)};
}

SymmetryPlane ending_at(const End& end) {
  SymmetryPlane plane = end.plane;
  plane.reason = "the body ends there in planar faces";
  return plane;
}

SymmetryPlane find_automatic(const TopoDS_Shape& bodies, const Box& box) {
  const double extent = box.high.y - box.low.y;
  if (std::abs(box.high.y + box.low.y) <= tolerances::symmetric * extent) {
    return plane_at(1, 0, box, "the body is symmetric about it");
  }
  for (const bool flat_sides : {false, true}) {
    const std::vector<End> ends = find_ends(bodies, box, flat_sides);
    const End* end = best_end(ends, std::nullopt);
    if (end != nullptr && end->plane.position == 0) return ending_at(*end);
  }
  throw CadError(
      "a hemisphere needs a plane of symmetry, but the body ends at no coordinate plane and is not "
      "symmetric about y = 0: give FarFieldOptions::symmetry and FarFieldOptions::symmetry_position");
}

SymmetryPlane find_on_axis(int axis, const FarFieldOptions& options, const NamedShape& named) {
  const TopoDS_Shape& bodies = named.shape;
  const Box box = tight_box(bodies);
  if (options.symmetry_position) {
    const bool was_open = named.symmetry_position == options.symmetry_position;
    return plane_at(axis, *options.symmetry_position, box,
                    was_open ? "the body is open there" : "as requested");
  }
  const double tolerance = tolerances::same_place * box.diagonal();
  if (box.low[axis] < -tolerance && box.high[axis] > tolerance) {
    return plane_at(axis, 0, box, "the body reaches across it");
  }
  const std::vector<End> exact = find_ends(bodies, box, false), all = find_ends(bodies, box, true);
  const auto is_zero = [](const End* end) { return end != nullptr && end->plane.position == 0; };
  const End *best = best_end(exact, axis), *nearly = best_end(all, axis);
  if (is_zero(best)) return ending_at(*best);
  if (is_zero(nearly)) return ending_at(*nearly);
  if (std::min(std::abs(box.low[axis]), std::abs(box.high[axis])) <= tolerance)
    refuse_missing_sides(bodies, plane_at(axis, 0, box, {}), named.labels);
  for (const End* end : {best, nearly})
    if (end != nullptr) return ending_at(*end);
  throw CadError(
      fmt::format("no plane of symmetry: the body reaches from {} = {:.6g} to {:.6g} and ends at neither "
                  "in planar faces: give FarFieldOptions::symmetry_position",
                  axis_names[axis], in_file(box.low[axis]), in_file(box.high[axis])));
}

/// A box that holds what of the bodies lies on one side of the plane.
TopoDS_Solid half_space(const Box& box, const SymmetryPlane& symmetry, bool positive) {
  const double margin = box.diagonal();
  Vec3 low = box.low - margin * Vec3{1, 1, 1}, high = box.high + margin * Vec3{1, 1, 1};
  (positive ? low : high)[symmetry.axis] = symmetry.position;
  return BRepPrimAPI_MakeBox(to_gp(low), to_gp(high)).Solid();
}

std::vector<TopoDS_Solid> common_with(const TopoDS_Solid& body, const TopoDS_Solid& half,
                                      FaceLabels& labels) {
  BRepAlgoAPI_Common common;
  common.SetArguments(list_of(std::vector{body}));
  common.SetTools(list_of(std::vector{half}));
  perform(common, "cutting a body at the plane of symmetry");
  follow_labels(common, {body}, labels);
  return common.Shape().IsNull() ? std::vector<TopoDS_Solid>{} : solids_of(common.Shape());
}

/// What is kept of a body.
struct CutBody {
  std::vector<TopoDS_Solid> solids;
  double aside = 0;   ///< distance of the cut from the plane of symmetry
  std::string fault;  ///< why there are none
};

/// Cuts so far into the fluid's half. It is a fault if what the CAD library makes is not the part on this
/// side.
CutBody try_cut(const TopoDS_Solid& body, const Box& all, SymmetryPlane symmetry, double aside,
                Volumes& volumes, FaceLabels& labels) {
  symmetry.position += symmetry.positive ? aside : -aside;
  FaceLabels unused;
  const std::vector<TopoDS_Solid> inside =
      common_with(body, half_space(all, symmetry, symmetry.positive), labels);
  const std::vector<TopoDS_Solid> outside =
      common_with(body, half_space(all, symmetry, !symmetry.positive), unused);
  const double parts = volume_of(inside, volumes) + volume_of(outside, volumes), whole = volumes.of(body);
  if (inside.empty() || std::abs(parts - whole) > tolerances::integrated_volume * whole) {
    return {{},
            aside,
            fmt::format("its halves have a volume of {:.9g}, the body has {:.9g}", in_file(parts, 3),
                        in_file(whole, 3))};
  }
  for (const TopoDS_Solid& part : inside) {
    const Box box = tight_box(part);
    const double beyond = symmetry.positive ? symmetry.position - box.low[symmetry.axis]
                                            : box.high[symmetry.axis] - symmetry.position;
    if (beyond > symmetry.reach)
      return {{}, aside, fmt::format("what is kept reaches {:.3g} beyond the plane", in_file(beyond))};
  }
  return {inside, aside, {}};
}

/// The CAD library goes wrong where an edge all but lies in the plane. Then the body is cut beside it, and
/// the section put on the plane later.
CutBody cut_body(const TopoDS_Solid& body, const Box& all, const SymmetryPlane& symmetry, Volumes& volumes,
                 FaceLabels& labels) {
  std::string fault;
  for (const double share : {0.0, 0.5, -0.5, 0.9, -0.9}) {
    CutBody cut = try_cut(body, all, symmetry, share * symmetry.reach, volumes, labels);
    if (cut.fault.empty()) return cut;
    if (fault.empty()) fault = cut.fault;
  }
  throw CadError(
      fmt::format("cutting a body at {} = {:.6g} went wrong: {}. Remedy: cut the body in the CAD "
                  "program, or move FarFieldOptions::symmetry_position a little",
                  axis_names[symmetry.axis], in_file(symmetry.position), fault));
}

bool has_flat_side(const TopoDS_Solid& body, const SymmetryPlane& symmetry) {
  for (TopExp_Explorer faces(body, TopAbs_FACE); faces.More(); faces.Next())
    if (is_flat_side(TopoDS::Face(faces.Current()), symmetry)) return true;
  return false;
}

/// A body that reaches the plane must end there in a face: at a mere point or line of contact the fluid would
/// have no thickness.
void require_section(const TopoDS_Solid& body, const SymmetryPlane& symmetry, const FaceLabels& labels) {
  if (has_flat_side(body, symmetry)) return;
  refuse_missing_sides(body, symmetry, labels);
  Vec3 contact;
  double nearest = std::numeric_limits<double>::max();
  for (TopExp_Explorer faces(body, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    const Box box = tight_box(face);
    const double gap = std::abs((symmetry.positive ? box.low : box.high)[symmetry.axis] - symmetry.position);
    if (gap < nearest) nearest = gap, contact = box.center();
  }
  contact[symmetry.axis] = symmetry.position;
  throw CadError(
      fmt::format("a body only touches the plane of symmetry {} = {:.6g}, near {}, and has no planar face "
                  "there: move FarFieldOptions::symmetry_position into the body",
                  axis_names[symmetry.axis], in_file(symmetry.position), place_in_file(contact)));
}

}  // namespace

gp_Pln SymmetryPlane::plane() const {
  Vec3 at, normal;
  at[axis] = position;
  normal[axis] = positive ? -1 : 1;
  return gp_Pln(to_gp(at), gp_Dir(normal.x, normal.y, normal.z));
}

bool SymmetryPlane::holds(const TopoDS_Face& face) const {
  const Box box = tight_box(face);
  if (std::abs(box.low[axis] - position) > tolerance || std::abs(box.high[axis] - position) > tolerance)
    return false;
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  return !surface.IsNull() && GeomLib_IsPlanarSurface(surface, tolerance).IsPlanar();
}

std::string describe(const SymmetryPlane& symmetry) {
  return fmt::format("plane of symmetry {} = {:.6g}: {}", axis_names[symmetry.axis],
                     in_file(symmetry.position), symmetry.reason);
}

std::optional<SymmetryPlane> find_symmetry(const FarFieldOptions& options, const NamedShape& bodies) {
  const auto on_axis = [&](int axis) { return find_on_axis(axis, options, bodies); };
  switch (options.symmetry) {
    case Symmetry::x:
      return on_axis(0);
    case Symmetry::y:
      return on_axis(1);
    case Symmetry::z:
      return on_axis(2);
    case Symmetry::automatic:
      if (options.shape == FarFieldShape::hemisphere)
        return find_automatic(bodies.shape, tight_box(bodies.shape));
      return std::nullopt;
    case Symmetry::none:
      break;
  }
  if (options.shape == FarFieldShape::hemisphere) {
    throw CadError(
        "a hemisphere is half a far field: give FarFieldOptions::symmetry, or the sphere as its shape");
  }
  return std::nullopt;
}

NamedShape cut_at_symmetry(NamedShape bodies, const SymmetryPlane& symmetry, Volumes& volumes,
                           Changes& changes) {
  const Box all = tight_box(bodies.shape);
  std::vector<TopoDS_Solid> kept;
  int cut = 0, dropped = 0;
  double aside = 0;
  for (const TopoDS_Solid& body : solids_of(bodies.shape)) {
    const Box box = tight_box(body);
    const double low = box.low[symmetry.axis], high = box.high[symmetry.axis];
    const double inward = symmetry.positive ? low - symmetry.position : symmetry.position - high;
    const double outward = symmetry.positive ? high - symmetry.position : symmetry.position - low;
    if (inward >= -symmetry.tolerance) {
      if (inward <= symmetry.tolerance) require_section(body, symmetry, bodies.labels);
      kept.push_back(body);
    } else if (inward >= -symmetry.reach && has_flat_side(body, symmetry)) {
      kept.push_back(body);
    } else if (outward <= symmetry.tolerance) {
      ++dropped;
    } else {
      const CutBody inside = cut_body(body, all, symmetry, volumes, bodies.labels);
      kept.insert(kept.end(), inside.solids.begin(), inside.solids.end());
      aside = std::max(aside, std::abs(inside.aside));
      ++cut;
    }
  }
  if (kept.empty()) throw CadError("no body lies on the side of the plane of symmetry that is kept");
  if (cut + dropped > 0) {
    Vec3 at = all.center();
    at[symmetry.axis] = symmetry.position;
    changes.push_back(
        {fmt::format(
             "{} bodies cut at the plane of symmetry {} = {:.6g}, {} on its other side dropped{}", cut,
             axis_names[symmetry.axis], in_file(symmetry.position), dropped,
             aside > 0 ? fmt::format("; the CAD library cut {:.3g} beside the plane", in_file(aside)) : ""),
         at, aside});
  }
  bodies.shape = make_compound(kept);
  refuse_missing_sides(bodies.shape, symmetry, bodies.labels);
  return bodies;
}

}  // namespace aeroloom::cad
