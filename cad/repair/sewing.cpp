#include "cad/repair/sewing.hpp"

#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/model/topology/model_topology.hpp"
#include "cad/repair/cap_choice.hpp"
#include "cad/repair/noise.hpp"
#include "cad/repair/noise_faces.hpp"
#include "cad/repair/open_faces.hpp"
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

double length_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(shape, properties);
  return properties.Mass();
}

/// Adds caps to sewn faces and sews once more.
Sewn cap_and_sew(const Sewn& sewn, const std::vector<Cap>& caps, Changes& caps_made) {
  TopTools_IndexedMapOfShape faces = map_of(sewn.shape, TopAbs_FACE);
  FaceLabels labels = sewn.labels;
  for (std::size_t i = 0; i < caps.size(); ++i) {
    FaceLabel label;
    label.name = fmt::format("cap_{}", i + 1);
    label.cap = true;
    labels.Bind(caps[i].face, label);
    faces.Add(caps[i].face);
    caps_made.push_back(
        {fmt::format("a{} opening of area {:.6g} closed by a face named '{}'",
                     caps[i].is_filled ? "n uneven" : " planar", in_file(caps[i].area, 2), label.name),
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

/// Closes what is open least, at the plane of symmetry. `fault` says why that failed.
std::optional<SewnShells> close_best_half(const std::vector<Sewn>& tried, const HalfPlane& half,
                                          FaceLabels& labels, Changes& changes, std::string& fault) {
  std::vector<std::pair<double, const Sewn*>> by_opening;
  for (const Sewn& open : tried) {
    if (open.shape.IsNull()) continue;
    double length = 0;
    for (const TopoDS_Edge& edge : open_edges(open.shape)) length += length_of(edge);
    by_opening.emplace_back(length, &open);
  }
  std::ranges::stable_sort(by_opening, {}, &std::pair<double, const Sewn*>::first);
  for (const auto& [length, open] : by_opening) {
    const ClosedHalf closed = close_half(open->shape, open->labels, half);
    if (!closed.fault.empty()) {
      if (fault.empty()) fault = closed.fault;
      continue;
    }
    Sewn sewn = *open;
    sewn.closed = closed.shells;
    const double gap = report_sewn(sewn, map_of(open->shape, TopAbs_FACE).Extent(), changes);
    changes.insert(changes.end(), closed.changes.begin(), closed.changes.end());
    labels = closed.labels;
    return SewnShells{closed.shells, gap, closed.plane};
  }
  return std::nullopt;
}

}  // namespace

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

SewnShells sew(const TopTools_IndexedMapOfShape& faces, const SewingOptions& options, FaceLabels& labels,
               Changes& changes) {
  const Box box = tight_box(std::vector<TopoDS_Shape>(faces.cbegin(), faces.cend()));
  const double diagonal = box.diagonal();
  std::vector<Sewn> tried;
  for (const Attempt& attempt : attempts_of(faces, diagonal)) {
    if (!tried.empty() && attempt.fraction * diagonal > options.largest_tolerance) break;
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
    return {sewn.closed, gap, {}};
  }
  const auto cap = [&](CapForm form) -> std::optional<SewnShells> {
    for (const Sewn& open : tried) {
      if (open.shape.IsNull() || (options.openings != nullptr && options.openings->refuse())) continue;
      const std::vector<Cap> caps = choose_caps(open, diagonal, options.openings, form);
      Changes caps_made;
      const Sewn capped = caps.empty() ? Sewn{} : cap_and_sew(open, caps, caps_made);
      if (!capped.complete) continue;
      changes.insert(changes.end(), caps_made.begin(), caps_made.end());
      const double gap = report_sewn(capped, faces.Extent(), changes);
      labels = capped.labels;
      return SewnShells{capped.closed, gap, {}};
    }
    return std::nullopt;
  };
  if (const std::optional<SewnShells> planar = cap(CapForm::planar)) return *planar;
  std::string fault;
  if (options.half) {
    const std::optional<SewnShells> half = close_best_half(tried, *options.half, labels, changes, fault);
    if (half) return *half;
  }
  if (const std::optional<SewnShells> filled = cap(CapForm::any)) return *filled;
  refuse_open(faces, tried.back(), labels, {options.beside_bodies, fault});
}

}  // namespace aeroloom::cad
