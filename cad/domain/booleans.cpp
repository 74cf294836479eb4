#include "cad/domain/booleans.hpp"

#include "cad/model/step_trace.hpp"

#include <TopExp_Explorer.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {

void follow_labels(BRepBuilderAPI_MakeShape& operation, const std::vector<TopoDS_Solid>& arguments,
                   FaceLabels& labels) {
  for (const TopoDS_Solid& solid : arguments) {
    for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
      if (!labels.IsBound(faces.Current())) continue;
      for (const TopoDS_Shape& image : operation.Modified(faces.Current())) {
        if (image.ShapeType() == TopAbs_FACE && !labels.IsBound(image))
          copy_label(labels, faces.Current(), image);
      }
    }
  }
}

void perform(BRepAlgoAPI_BuilderAlgo& operation, const char* doing) {
  report_step(doing);
  operation.SetRunParallel(false);
  operation.SetToFillHistory(true);
  operation.Build();
  if (operation.IsDone() && !operation.HasErrors()) return;
  throw CadError(fmt::format("{} failed in the CAD library: repair the solids in the CAD program", doing));
}

}  // namespace aeroloom::cad
