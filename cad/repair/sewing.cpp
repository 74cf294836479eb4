#include "cad/repair/sewing.hpp"

#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/model/topology/model_topology.hpp"
#include "cad/repair/noise.hpp"
#include "cad/repair/noise_faces.hpp"
#include "cad/repair/plane_loops.hpp"
#include "cad/repair/shells.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <BOPTools_AlgoTools.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::cad {
namespace {

/// A shape that is open wider than this fraction of its faces' area is a sheet, not a body with an opening:
/// an open half of a sphere, half of whose area its cap has, still is a body. Chosen, not measured.
constexpr double widest_opening = 0.5;

struct Sewn {
  std::vector<TopoDS_Shell> closed;
  TopoDS_Shape shape;
  FaceLabels labels;
  double tolerance = 0, fraction = 0;
  bool complete = false;  ///< no face outside closed shells
};

void move_labels(const TopTools_IndexedMapOfShape& faces, const BRepBuilderAPI_Sewing& sewing,
                 FaceLabels& labels) {
  for (int i = 1; i <= faces.Extent(); ++i) {
    for (TopExp_Explorer sewn(sewing.ModifiedSubShape(faces(i)), TopAbs_FACE); sewn.More(); sewn.Next())
      copy_label(labels, faces(i), sewn.Current());
  }
}

Sewn sew_once(const TopTools_IndexedMapOfShape& faces, double tolerance, const FaceLabels& labels) {
  report_step(fmt::format("sewing {} faces with tolerance {:.3g}", faces.Extent(), in_file(tolerance)));
  BRepBuilderAPI_Sewing sewing(tolerance);
  for (int i = 1; i <= faces.Extent(); ++i) sewing.Add(faces(i));
  sewing.Perform();
  Sewn sewn;
  sewn.labels = labels;
  sewn.tolerance = tolerance;
  sewn.shape = sewing.SewedShape();
  if (sewn.shape.IsNull()) return sewn;
  sewn.complete = !TopExp_Explorer(sewn.shape, TopAbs_FACE, TopAbs_SHELL).More();
  for (TopExp_Explorer each(sewn.shape, TopAbs_SHELL); each.More(); each.Next()) {
    const TopoDS_Shell shell = TopoDS::Shell(each.Current());
    if (is_closed(shell)) {
      sewn.closed.push_back(shell);
    } else {
      sewn.complete = false;
    }
  }
  move_labels(faces, sewing, sewn.labels);
  return sewn;
}

struct Gap {
  double width = 0;
  std::optional<Vec3> where;
};

/// The largest distance between an edge and the surface of a face it bounds: the gap that sewing closed
/// there.
Gap largest_gap(const TopoDS_Shape& shape, double tolerance) {
  constexpr int samples = 8;  // on an edge; gaps change slowly along it. Chosen, not measured.
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndUniqueAncestors(shape, TopAbs_EDGE, TopAbs_FACE, users);
  Gap gap;
  for (int i = 1; i <= users.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(users.FindKey(i));
    double first, last, low, high;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, first, last);
    if (curve.IsNull()) continue;
    for (const TopoDS_Shape& user : users(i)) {
      const TopoDS_Face face = TopoDS::Face(user);
      const Handle(Geom2d_Curve) image = BRep_Tool::CurveOnSurface(edge, face, low, high);
      if (image.IsNull() || BRep_Tool::Surface(face).IsNull()) continue;
      const FaceEvaluator evaluator = make_evaluator(face, 0);
      for (int k = 0; k <= samples; ++k) {
        const Vec3 point = to_vec(curve->Value(first + (last - first) * k / samples));
        const gp_Pnt2d guess = image->Value(low + (high - low) * k / samples);
        const Vec2 uv = find_parameters(evaluator, point, {guess.X(), guess.Y()}, tolerance);
        const double width = distance(point, evaluator.surface.point(uv));
        if (width > gap.width) gap = {width, point};
      }
    }
  }
  return gap;
}

/// Returns the widest gap.
double report_sewn(const Sewn& sewn, int face_count, Changes& changes) {
  const Gap gap = largest_gap(sewn.shape, tolerances::foot_that_measures * sewn.tolerance);
  const char* caution =
      sewn.fraction > tolerances::cautioned_sewing ? "; such gaps are wide: look at the mesh there" : "";
  changes.push_back(
      {fmt::format("{} faces sewn to {} closed shells with tolerance {:.3g} ({:.0e} of the "
                   "diagonal){}",
                   face_count, sewn.closed.size(), in_file(sewn.tolerance), sewn.fraction, caution),
       gap.where, gap.width});
  return gap.width;
}

double area_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return std::abs(properties.Mass());
}

double length_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(shape, properties);
  return properties.Mass();
}

/// Whether the caps close bodies: what hangs together must be open no wider than a body is, each piece for
/// itself.
bool close_bodies(const TopoDS_Shape& open, const std::vector<Cap>& caps) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  builder.Add(all, open);
  TopTools_IndexedMapOfShape cap_faces;
  for (const Cap& cap : caps) {
    builder.Add(all, cap.face);
    cap_faces.Add(cap.face);
  }
  TopTools_ListOfShape pieces;
  BOPTools_AlgoTools::MakeConnexityBlocks(all, TopAbs_EDGE, TopAbs_FACE, pieces);
  for (const TopoDS_Shape& piece : pieces) {
    double walls = 0, openings = 0;
    for (TopExp_Explorer faces(piece, TopAbs_FACE); faces.More(); faces.Next()) {
      (cap_faces.Contains(faces.Current()) ? openings : walls) += area_of(faces.Current());
    }
    if (openings > widest_opening * walls) return false;
  }
  return true;
}

/// Adds caps to sewn faces and sews once more; not complete where the openings are not planar.
Sewn cap_and_sew(const Sewn& sewn, double diagonal, Changes& caps_made) {
  const std::vector<Cap> caps = cap_openings(open_edges(sewn.shape), tolerances::planar_opening * diagonal);
  if (caps.empty()) return {};
  for (const Cap& cap : caps) {
    if (cap.area < tolerances::narrowest_opening * diagonal * length_of(cap.face)) return {};
  }
  if (!close_bodies(sewn.shape, caps)) return {};
  TopTools_IndexedMapOfShape faces = map_of(sewn.shape, TopAbs_FACE);
  FaceLabels labels = sewn.labels;
  for (std::size_t i = 0; i < caps.size(); ++i) {
    FaceLabel label;
    label.name = fmt::format("cap_{}", i + 1);
    label.cap = true;
    labels.Bind(caps[i].face, label);
    faces.Add(caps[i].face);
    caps_made.push_back({fmt::format("a planar opening of area {:.6g} closed by a face named '{}'",
                                     in_file(caps[i].area, 2), label.name),
                         caps[i].center, caps[i].deviation});
  }
  Sewn capped = sew_once(faces, sewn.tolerance, labels);
  capped.fraction = sewn.fraction;
  return capped;
}

/// Faces to sew, and how.
struct Attempt {  // NOLINT(bugprone-exception-escape): the CAD library's maps copy when they are moved
  TopTools_IndexedMapOfShape faces;
  double fraction = 0;
  std::vector<std::pair<int, NoiseFace>> left_out;  ///< numbers of faces that are noise
};

/// Tolerances ascending. Where strips are no wider than a few of them sewing would lay their sides on one
/// another and leave the strip: it is tried with less, and without the strips.
std::vector<Attempt> attempts_of(const TopTools_IndexedMapOfShape& faces, double diagonal) {
  // In widths of the narrowest strip, and in tolerances: how far sewing keeps from laying one side on the
  // other. Chosen, not measured.
  constexpr double fraction_of_strip = 0.1, near = 5;
  const double limit = noise_tolerance(diagonal, 0, 0);
  std::vector<std::pair<int, NoiseFace>> strips;
  double narrowest = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= faces.Extent(); ++i) {
    const auto noise = examine_noise(TopoDS::Face(faces(i)), limit);
    if (!noise) continue;
    strips.emplace_back(i, *noise);
    narrowest = std::min(narrowest, noise->widest);
  }
  std::vector<Attempt> attempts;
  if (narrowest < near * tolerances::sewing[0] * diagonal)
    attempts.push_back({faces, fraction_of_strip * narrowest / diagonal, {}});
  for (const double fraction : tolerances::sewing) {
    if (narrowest < near * fraction * diagonal && static_cast<int>(strips.size()) < faces.Extent()) {
      Attempt without{{}, fraction, strips};
      for (int i = 1, next = 0; i <= faces.Extent(); ++i) {
        if (next < static_cast<int>(strips.size()) && strips[next].first == i)
          ++next;
        else
          without.faces.Add(faces(i));
      }
      attempts.push_back(std::move(without));
    }
    attempts.push_back({faces, fraction, {}});
  }
  return attempts;
}

/// The name of the only face around an edge, or of its solid; empty where the file names neither.
std::string name_around(const TopoDS_Edge& edge, const TopoDS_Shape& shape, const FaceLabels& labels) {
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    for (TopExp_Explorer edges(faces.Current(), TopAbs_EDGE); edges.More(); edges.Next()) {
      if (!edges.Current().IsSame(edge)) continue;
      const FaceLabel* label = labels.Seek(faces.Current());
      if (label == nullptr) return {};
      return label->name.empty() ? label->solid : label->name;
    }
  }
  return {};
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

/// Beside closed bodies the faces are likely to be strays.
[[noreturn]] void refuse_open(const TopTools_IndexedMapOfShape& faces, const Sewn& last,
                              const FaceLabels& labels, bool beside_bodies) {
  constexpr std::size_t most_named = 10;
  std::vector<std::string> strays;
  if (beside_bodies || !last.closed.empty()) {
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
    throw CadError(fmt::format("a single face '{}', around {}, bounds no volume: {}. {}",
                               shown_name(labels, faces(1)), place_in_file(box.center()),
                               list_open_edges(faces(1), labels),
                               remedy.empty() ? "Add the faces that close it in the CAD program" : remedy));
  }
  throw CadError(
      fmt::format("the faces do not close to a solid, even sewn with a tolerance of {:.3g} ({:.0e} of "
                  "the diagonal), and their openings are no small planar ones: {}. {}",
                  in_file(last.tolerance), last.fraction,
                  last.shape.IsNull() ? "nothing was sewn" : list_open_edges(last.shape, last.labels),
                  remedy.empty() ? "Close the gaps in the CAD program" : remedy));
}

}  // namespace

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

bool are_sheets(const TopTools_IndexedMapOfShape& faces) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& face : shapes_in(faces)) builder.Add(all, face);
  TopTools_ListOfShape pieces;
  BOPTools_AlgoTools::MakeConnexityBlocks(all, TopAbs_EDGE, TopAbs_FACE, pieces);
  for (const TopoDS_Shape& piece : pieces) {
    double area = 0;
    Vec3 opening;  // the flux through it is that through the faces
    for (TopExp_Explorer each(piece, TopAbs_FACE); each.More(); each.Next()) {
      const TopoDS_Face face = TopoDS::Face(each.Current());
      const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
      if (surface.IsNull()) return false;
      const FaceIntegrals sums = integrate_face(face, SurfaceEvaluator(surface), {});
      area += sums.area;
      opening += (face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0) * sums.area_vector;
    }
    if (norm(opening) <= widest_opening * area) return false;
  }
  return true;
}

SewnShells sew(const TopTools_IndexedMapOfShape& faces, double largest_tolerance, FaceLabels& labels,
               Changes& changes, bool beside_bodies) {
  const Box box = tight_box(std::vector<TopoDS_Shape>(faces.cbegin(), faces.cend()));
  const double diagonal = box.diagonal();
  std::vector<Sewn> tried;
  for (const Attempt& attempt : attempts_of(faces, diagonal)) {
    if (!tried.empty() && attempt.fraction * diagonal > largest_tolerance) break;
    Sewn& sewn = tried.emplace_back(sew_once(attempt.faces, attempt.fraction * diagonal, labels));
    sewn.fraction = attempt.fraction;
    if (!sewn.complete) {
      if (!attempt.left_out.empty()) tried.pop_back();
      continue;
    }
    for (const auto& [index, noise] : attempt.left_out) {
      changes.push_back(
          {fmt::format("strip '{}', {:.4g} long and at most {:.4g} wide, is below the noise: left out and "
                       "its sides sewn",
                       shown_name(labels, faces(index)), in_file(noise.length), in_file(noise.widest)),
           noise.place, noise.widest});
    }
    const double gap = report_sewn(sewn, attempt.faces.Extent(), changes);
    labels = sewn.labels;
    return {sewn.closed, gap};
  }
  for (const Sewn& open : tried) {
    if (open.shape.IsNull()) continue;
    Changes caps_made;
    Sewn capped = cap_and_sew(open, diagonal, caps_made);
    if (!capped.complete) continue;
    changes.insert(changes.end(), caps_made.begin(), caps_made.end());
    const double gap = report_sewn(capped, faces.Extent(), changes);
    labels = capped.labels;
    return {capped.closed, gap};
  }
  refuse_open(faces, tried.back(), labels, beside_bodies);
}

}  // namespace aeroloom::cad
