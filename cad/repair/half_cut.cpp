#include "cad/repair/half_cut.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <TopTools_ListOfShape.hxx>

namespace aeroloom::cad {

std::optional<HalfCut> cut_open_half(const TopoDS_Shape& shape, const HalfSide& side, FaceLabels& labels) {
  const int axis = side.plane.axis;
  const Box whole = tight_box(shape);
  for (const double aside : {0.0, 0.5 * side.reach, -0.5 * side.reach}) {
    Vec3 low = whole.low - whole.diagonal() * Vec3{1, 1, 1},
         high = whole.high + whole.diagonal() * Vec3{1, 1, 1};
    (side.positive ? low : high)[axis] = side.plane.position + (side.positive ? aside : -aside);
    BRepAlgoAPI_Common common;
    TopTools_ListOfShape shapes, tools;
    for (const TopoDS_Shape& face : shapes_in(map_of(shape, TopAbs_FACE))) shapes.Append(face);
    tools.Append(BRepPrimAPI_MakeBox(to_gp(low), to_gp(high)).Solid());
    common.SetArguments(shapes);
    common.SetTools(tools);
    common.SetRunParallel(false);
    common.SetToFillHistory(true);
    report_step("cutting an open half at its plane of symmetry");
    common.Build();
    if (!common.IsDone() || common.HasErrors() || common.Shape().IsNull()) continue;
    const Box box = tight_box(common.Shape());
    if (box.empty() || (side.positive ? side.plane.position - box.low[axis]
                                      : box.high[axis] - side.plane.position) > side.reach)
      continue;
    for (const TopoDS_Shape& face : shapes) {
      if (!labels.IsBound(face)) continue;
      const FaceLabel label = labels.Find(face);
      for (const TopoDS_Shape& image : common.Modified(face)) labels.Bind(image, label);
    }
    return HalfCut{common.Shape(), aside};
  }
  return std::nullopt;
}

}  // namespace aeroloom::cad
