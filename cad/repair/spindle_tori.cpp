#include "cad/repair/spindle_tori.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/tolerances.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepTools.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Tool.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Whether nothing bounds the face but seams and poles.
bool has_no_border(const TopoDS_Face& face) {
  for (TopExp_Explorer each(face, TopAbs_EDGE); each.More(); each.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(each.Current());
    if (!BRep_Tool::Degenerated(edge) && !BRep_Tool::IsClosed(edge, face)) return false;
  }
  return true;
}

/// The torus of a face that goes all around it and that crosses itself; null of all others.
Handle(Geom_ToroidalSurface) spindle_of(const TopoDS_Face& face) {
  Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull())
    surface = trimmed->BasisSurface();
  const auto torus = Handle(Geom_ToroidalSurface)::DownCast(surface);
  if (torus.IsNull() || torus->MinorRadius() <= torus->MajorRadius() || !has_no_border(face)) return {};
  double u_low = 0, u_high = 0, v_low = 0, v_high = 0;
  BRepTools::UVBounds(face, u_low, u_high, v_low, v_high);
  constexpr double all_around = 2 * std::numbers::pi * (1 - tolerances::same_parameter);
  return u_high - u_low >= all_around && v_high - v_low >= all_around ? torus : nullptr;
}

/// The outer part, from one of the points of the axis to the other; null where the library makes none.
TopoDS_Face outer_part(const Handle(Geom_ToroidalSurface) & torus) {
  const double pole = std::acos(-torus->MajorRadius() / torus->MinorRadius());
  BRepBuilderAPI_MakeFace made(torus, 0, 2 * std::numbers::pi, -pole, pole, tolerances::library_length);
  return made.IsDone() ? made.Face() : TopoDS_Face();
}

}  // namespace

void trim_spindle_tori(NamedShape& named, Changes& changes) {
  const TopTools_IndexedMapOfShape before = map_of(named.shape, TopAbs_FACE);
  BRepTools_ReShape reshape;
  reshape.ModeConsiderLocation() = true;
  std::vector<Change> made;
  for (int i = 1; i <= before.Extent(); ++i) {
    const TopoDS_Face face = TopoDS::Face(before(i).Located(TopLoc_Location()));
    const Handle(Geom_ToroidalSurface) torus = spindle_of(face);
    if (torus.IsNull()) continue;
    const TopoDS_Face outer = outer_part(torus);
    if (outer.IsNull()) continue;
    reshape.Replace(face.Oriented(TopAbs_FORWARD), outer);
    made.push_back(
        {fmt::format("face '{}' is a torus that crosses itself, of radii {:.6g} and {:.6g}: its outer "
                     "part was kept",
                     shown_name(named.labels, before(i)), in_file(torus->MajorRadius()),
                     in_file(torus->MinorRadius())),
         tight_box(before(i)).center()});
  }
  if (made.empty()) return;
  named.shape = reshape.Apply(named.shape);
  const TopTools_IndexedMapOfShape after = map_of(named.shape, TopAbs_FACE);
  for (int i = 1; i <= before.Extent() && before.Extent() == after.Extent(); ++i)
    if (!after(i).IsSame(before(i))) copy_label(named.labels, before(i), after(i));
  changes.insert(changes.end(), made.begin(), made.end());
}

}  // namespace aeroloom::cad
