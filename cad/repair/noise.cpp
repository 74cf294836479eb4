#include "cad/repair/noise.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/noise_closing.hpp"
#include "cad/repair/noise_faces.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <vector>

#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Edges that are listed by place; the others are counted, so that a file with thousands leaves a report that
/// can be read.
constexpr std::size_t most_edges_listed = 20;
/// Where all cannot be closed together, so many are tried one by one: each attempt examines the whole shape.
/// Chosen, not measured.
constexpr int most_single_attempts = 200;

/// One face or edge that is noise.
struct NoiseItem {
  TopoDS_Shape shape;
  bool face = false;
  std::string name;  ///< of a face
  double width = 0;  ///< of a face: the widest; of an edge: its length
  double length = 0;
  Vec3 place;
};

std::vector<NoiseItem> find_items(const TopoDS_Shape& shape, const FaceLabels& labels, double tolerance) {
  std::vector<NoiseItem> items;
  const TopTools_IndexedMapOfShape faces = map_of(shape, TopAbs_FACE);
  const TopTools_IndexedMapOfShape edges = map_of(shape, TopAbs_EDGE);
  TopTools_IndexedMapOfShape of_noise;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Face face = TopoDS::Face(faces(i));
    const auto noise = examine_noise(face, tolerance);
    if (!noise) continue;
    items.push_back({face, true, shown_name(labels, face), noise->widest, noise->length, noise->place});
    TopExp::MapShapes(face, TopAbs_EDGE, of_noise);
  }
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i).Oriented(TopAbs_FORWARD));
    double first, last;
    if (BRep_Tool::Degenerated(edge) || BRep_Tool::Curve(edge, first, last).IsNull()) continue;
    const SampledEdge samples(edge);
    if (samples.length() > tolerance || of_noise.Contains(edge)) continue;
    items.push_back(
        {edge, false, {}, samples.length(), samples.length(), samples.point(samples.parameter(0.5))});
  }
  return items;
}

/// A face takes its short edges with it.
NoiseItems items_of(const std::vector<NoiseItem>& some, double tolerance) {
  NoiseItems items;
  for (const NoiseItem& item : some) {
    if (!item.face) {
      items.edges.Add(item.shape);
      continue;
    }
    items.faces.Add(item.shape);
    for (TopExp_Explorer each(item.shape, TopAbs_EDGE); each.More(); each.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(each.Current().Oriented(TopAbs_FORWARD));
      if (!BRep_Tool::Degenerated(edge) && SampledEdge(edge).length() <= tolerance) items.edges.Add(edge);
    }
  }
  return items;
}

NamedShape close_items(NamedShape named, const std::vector<NoiseItem>& some, double tolerance) {
  const NoiseItems items = items_of(some, tolerance);
  named.shape = substitute(named.shape, plan_closing(named.shape, items, tolerance), named.labels);
  for (const NoiseItem& item : some) named.gap = std::max(named.gap, item.width);
  return named;
}

void report_closed(const std::vector<NoiseItem>& closed, double tolerance, Changes& changes) {
  std::size_t edges = 0;
  for (const NoiseItem& item : closed) {
    if (item.face) {
      changes.push_back(
          {fmt::format("strip '{}', {:.4g} long and at most {:.4g} wide, is below the noise of "
                       "{:.3g}: closed",
                       item.name, in_file(item.length), in_file(item.width), in_file(tolerance)),
           item.place, item.width});
    } else if (++edges <= most_edges_listed) {
      changes.push_back(
          {fmt::format("an edge of length {:.4g} is below the noise of {:.3g}: closed to a vertex",
                       in_file(item.width), in_file(tolerance)),
           item.place, item.width});
    }
  }
  if (edges > most_edges_listed) {
    changes.push_back({fmt::format("{} more edges below the noise of {:.3g}: closed to vertices",
                                   edges - most_edges_listed, in_file(tolerance))});
  }
}

void report_left(const NoiseItem& item, double tolerance, const char* reason, Changes& changes) {
  const std::string what =
      item.face ? fmt::format("strip '{}', at most {:.4g} wide", item.name, in_file(item.width))
                : fmt::format("an edge of length {:.4g}", in_file(item.width));
  changes.push_back(
      {fmt::format("{}, is below the noise of {:.3g}, but stays: {}", what, in_file(tolerance), reason),
       item.place});
}

bool is_among(const std::vector<NoiseItem>& items, const NoiseItem& wanted) {
  return std::ranges::any_of(
      items, [&](const NoiseItem& item) { return item.face == wanted.face && item.place == wanted.place; });
}

/// Closes what closes, one after the other.
NamedShape close_singly(NamedShape named, double tolerance, Changes& changes) {
  std::vector<NoiseItem> refused, closed;
  for (int attempt = 0; attempt < most_single_attempts; ++attempt) {
    const std::vector<NoiseItem> items = find_items(named.shape, named.labels, tolerance);
    const auto next =
        std::ranges::find_if(items, [&](const NoiseItem& item) { return !is_among(refused, item); });
    if (next == items.end()) break;
    try {
      named = close_items(named, {*next}, tolerance);
      closed.push_back(*next);
    } catch (const CadError& error) {
      refused.push_back(*next);
      report_left(*next, tolerance, error.what(), changes);
    }
  }
  report_closed(closed, tolerance, changes);
  return named;
}

}  // namespace

double noise_tolerance(double diagonal, double precision, double smallest_size) {
  using namespace tolerances;
  const double tolerance =
      std::min(std::max(noise * diagonal, noise_over_precision * precision), most_noise * diagonal);
  return smallest_size > 0 ? std::min(tolerance, fraction_of_size * smallest_size) : tolerance;
}

NamedShape close_noise(NamedShape named, double smallest_size, Changes& changes) {
  const double tolerance = noise_tolerance(tight_box(named.shape).diagonal(), named.precision, smallest_size);
  const std::vector<NoiseItem> items = find_items(named.shape, named.labels, tolerance);
  if (items.empty()) return named;
  report_step("closing noise");
  try {
    NamedShape closed = close_items(named, items, tolerance);
    report_closed(items, tolerance, changes);
    return closed;
  } catch (const CadError&) {
    return close_singly(std::move(named), tolerance, changes);
  }
}

}  // namespace aeroloom::cad
