#include "cad/domain/flat_sides.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/tolerances.hpp"

#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include <BRepGProp_Face.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomLib_IsPlanarSurface.hxx>
#include <Geom_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A planar face that looks at the plane of symmetry.
struct FacingSide {
  TopoDS_Face face;
  double tilt = 0;                   ///< radians
  double nearest = 0, farthest = 0;  ///< into the fluid's half; negative beyond the plane
  Vec3 where;                        ///< its middle
};

/// Distances of a box from the plane, into the fluid's half.
std::pair<double, double> distances_of(const Box& box, const SymmetryPlane& symmetry) {
  const double low = box.low[symmetry.axis] - symmetry.position,
               high = box.high[symmetry.axis] - symmetry.position;
  return symmetry.positive ? std::pair(low, high) : std::pair(-high, -low);
}

std::optional<FacingSide> facing_side(const TopoDS_Face& face, const SymmetryPlane& symmetry,
                                      double most_tilt) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (surface.IsNull() || !GeomLib_IsPlanarSurface(surface, symmetry.reach).IsPlanar()) return std::nullopt;
  double low, high, from, to;
  BRepTools::UVBounds(face, low, high, from, to);
  gp_Pnt place;
  gp_Vec normal;
  BRepGProp_Face(face).Normal(0.5 * (low + high), 0.5 * (from + to), place, normal);
  if (normal.Magnitude() <= 0) return std::nullopt;
  FacingSide side{face, normal.Angle(gp_Vec(symmetry.plane().Axis().Direction())), 0, 0, {}};
  if (side.tilt > most_tilt) return std::nullopt;
  const Box box = tight_box(face);
  std::tie(side.nearest, side.farthest) = distances_of(box, symmetry);
  side.where = box.center();
  return side;
}

}  // namespace

bool is_flat_side(const TopoDS_Face& face, const SymmetryPlane& symmetry) {
  const auto [nearest, farthest] = distances_of(tight_box(face), symmetry);
  if (nearest < -symmetry.reach || farthest > symmetry.reach) return false;
  return symmetry.holds(face) || facing_side(face, symmetry, tolerances::flat_side).has_value();
}

std::string describe_missing_side(const TopoDS_Shape& bodies, const SymmetryPlane& symmetry,
                                  const FaceLabels& labels) {
  for (TopExp_Explorer faces(bodies, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face face = TopoDS::Face(faces.Current());
    if (is_flat_side(face, symmetry)) continue;
    const auto side = facing_side(face, symmetry, tolerances::wedge_at_symmetry);
    if (!side || side->nearest > symmetry.reach || side->farthest < -symmetry.reach) continue;
    const auto shown = [&](double length) {
      return in_file(std::abs(length) <= symmetry.tolerance ? 0 : length);
    };
    return fmt::format(
        "the flat side '{}' of the body, around {}, misses the plane of symmetry {} = {:.6g}: it is tilted "
        "by "
        "{:.3g} degrees, and its distance goes from {:.3g} to {:.3g}, more than the {:.3g} ({:.0e} of the "
        "diagonal) that is put on the plane. Remedy: turn or move the body in the CAD program, or a "
        "FarFieldOptions::symmetry_position inside of the body, which cuts it there",
        shown_name(labels, face), place_in_file(side->where), "xyz"[symmetry.axis],
        in_file(symmetry.position), side -> tilt* geometry::degrees_per_radian, shown(side->nearest),
        shown(side->farthest), in_file(symmetry.reach), tolerances::on_symmetry);
  }
  return {};
}

void refuse_missing_sides(const TopoDS_Shape& bodies, const SymmetryPlane& symmetry,
                          const FaceLabels& labels) {
  const std::string text = describe_missing_side(bodies, symmetry, labels);
  if (!text.empty()) throw CadError(text);
}

}  // namespace aeroloom::cad
