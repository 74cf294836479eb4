#include "cad/repair/open_faces.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/half_shells.hpp"
#include "cad/repair/plane_loops.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <BRepAdaptor_Curve.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::cad {
namespace {

/// The only face around an open edge.
TopoDS_Shape face_around(const TopoDS_Edge& edge, const TopoDS_Shape& shape) {
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    for (TopExp_Explorer edges(faces.Current(), TopAbs_EDGE); edges.More(); edges.Next())
      if (edges.Current().IsSame(edge)) return faces.Current();
  }
  return {};
}

/// The name of the only face around an edge, or of its solid; empty where the file names neither.
std::string name_around(const TopoDS_Edge& edge, const TopoDS_Shape& shape, const FaceLabels& labels) {
  const FaceLabel* label = labels.Seek(face_around(edge, shape));
  if (label == nullptr) return {};
  return label->name.empty() ? label->solid : label->name;
}

std::string list_open_edges(const TopoDS_Shape& shape, const FaceLabels& labels) {
  constexpr std::size_t shown = 5;  // a message of some lines
  const std::vector<TopoDS_Edge> edges = open_edges(shape);
  std::string text = fmt::format("{} open edges", edges.size());
  for (std::size_t i = 0; i < std::min(shown, edges.size()); ++i) {
    const BRepAdaptor_Curve curve(edges[i]);
    const gp_Pnt middle = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
    text += fmt::format("{} at {} length {:.6g}", i == 0 ? ":" : ";", place_in_file(to_vec(middle)),
                        in_file(GCPnts_AbscissaPoint::Length(curve)));
    const std::string name = name_around(edges[i], shape, labels);
    if (!name.empty()) text += fmt::format(" of '{}'", name);
  }
  return text + (edges.size() > shown ? "; ..." : "");
}

/// A sentence about the longest opening: its edges, length, place and the faces around it. Empty where open
/// edges form no loops, or a single one that the list of edges tells.
std::string describe_longest_opening(const TopoDS_Shape& shape, const FaceLabels& labels) {
  constexpr std::size_t most_names = 5;  // a message of some lines
  const std::vector<TopoDS_Edge> edges = open_edges(shape);
  const auto loops = find_loops(edges);
  if (!loops || edges.empty()) return {};
  double longest = -1;
  const std::vector<TopoDS_Edge>* widest = nullptr;
  for (const std::vector<TopoDS_Edge>& loop : *loops) {
    double length = 0;
    for (const TopoDS_Edge& edge : loop) length += GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
    if (length > longest) longest = length, widest = &loop;
  }
  Box box;
  std::vector<std::string> names;
  for (const TopoDS_Edge& edge : *widest) {
    box.add(tight_box(edge));
    const std::string name = shown_name(labels, face_around(edge, shape));
    if (!name.empty() && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  std::string text =
      fmt::format(" The longest of {} opening(s) has {} edges, is {:.4g} long around {}", loops->size(),
                  widest->size(), in_file(longest), place_in_file(box.center()));
  if (names.size() > most_names) names.resize(most_names), names.emplace_back("...");
  return text + (names.empty() ? "." : fmt::format(", beside '{}'.", fmt::join(names, "', '")));
}

/// Names of faces outside of closed shells.
std::vector<std::string> stray_names(const Sewn& sewn) {
  TopTools_IndexedMapOfShape closed;
  for (const TopoDS_Shell& shell : sewn.closed) TopExp::MapShapes(shell, TopAbs_FACE, closed);
  std::vector<std::string> names;
  const TopTools_IndexedMapOfShape all = map_of(sewn.shape, TopAbs_FACE);
  for (int i = 1; i <= all.Extent(); ++i) {
    const std::string name = shown_name(sewn.labels, all(i));
    if (!closed.Contains(all(i)) && !name.empty()) names.push_back(name);
  }
  return names;
}

/// Where open edges lie in one coordinate plane, or why the plane of symmetry closes nothing.
std::string half_remedy(const Sewn& open, const OpenReasons& reasons) {
  constexpr std::size_t most_tried = 500;  // open edges; closing those of damaged files takes long. Chosen
  if (!reasons.half.empty())
    return fmt::format(" Nor does the plane of symmetry close them: {}.", reasons.half);
  if (open.shape.IsNull()) return {};
  const std::vector<TopoDS_Edge> edges = open_edges(open.shape);
  const double diagonal = tight_box(open.shape).diagonal();
  auto plane = plane_of_openings(edges, diagonal);
  double most = 0;
  std::optional<AxisPlane> closing;
  for (int axis = 0; axis < 3 && !plane && edges.size() <= most_tried; ++axis) {
    const ClosedHalf closed = close_half(open.shape, open.labels, {axis});
    if (!closed.fault.empty()) continue;
    double length = 0;
    for (const TopoDS_Edge& edge : edges)
      if (distance_from(closed.plane, edge) <= tolerances::on_symmetry * diagonal)
        length += GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
    if (length > most) most = length, closing = closed.plane;
  }
  if (!plane) plane = closing;
  if (!plane) return {};
  return fmt::format(
      " It seems to be half of a model, open on the plane {0} = {1:.6g}: FarFieldOptions::symmetry "
      "'{0}' closes it there.",
      "xyz"[plane->axis], in_file(plane->position));
}

}  // namespace

void refuse_open(const TopTools_IndexedMapOfShape& faces, const Sewn& last, const FaceLabels& labels,
                 const OpenReasons& reasons) {
  constexpr std::size_t most_named = 10;
  std::vector<std::string> strays;
  if (reasons.beside_bodies || !last.closed.empty()) {
    if (faces.Extent() == 1)
      strays.push_back(shown_name(labels, faces(1)));
    else if (!last.shape.IsNull())
      strays = stray_names(last);
  }
  std::erase(strays, "");
  const std::string remedy = strays.empty() || strays.size() > most_named
                                 ? ""
                                 : fmt::format(
                                       "Remedy: leave what is no wall of a body out (DomainOptions::ignore: "
                                       "['{}']), or close it to a "
                                       "body in the CAD program",
                                       fmt::join(strays, "', '"));
  if (faces.Extent() == 1) {
    const Box box = tight_box(faces(1));
    throw CadError(fmt::format("a single face '{}', around {}, bounds no volume: {}.{} {}",
                               shown_name(labels, faces(1)), place_in_file(box.center()),
                               list_open_edges(faces(1), labels), half_remedy(last, reasons),
                               remedy.empty() ? "Add the faces that close it in the CAD program" : remedy));
  }
  throw CadError(
      fmt::format("the faces do not close to a solid, even sewn with a tolerance of {:.3g} ({:.0e} of "
                  "the diagonal), and their openings are no small planar ones: {}.{}{} {}",
                  in_file(last.tolerance), last.fraction,
                  last.shape.IsNull() ? "nothing was sewn" : list_open_edges(last.shape, last.labels),
                  last.shape.IsNull() ? "" : describe_longest_opening(last.shape, last.labels),
                  half_remedy(last, reasons),
                  remedy.empty() ? "Close the gaps in the CAD program, or name what a face shall close in "
                                   "DomainOptions::close"
                                 : remedy));
}

std::vector<TopoDS_Edge> open_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, users);
  std::vector<TopoDS_Edge> open;
  for (int i = 1; i <= users.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i));
    if (users(i).Extent() == 1 && bounds_material(edge) && !BRep_Tool::Degenerated(edge))
      open.push_back(edge);
  }
  return open;
}

}  // namespace aeroloom::cad
