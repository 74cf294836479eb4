#include "cad/repair/heal.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/noise.hpp"
#include "cad/repair/repair_edges.hpp"
#include "cad/repair/sewing.hpp"
#include "cad/repair/shells.hpp"
#include "cad/repair/spindle_tori.hpp"
#include "cad/tolerances.hpp"
#include "geometry/place_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// A file's shape taken apart by how much work its parts need to become solids.
struct Parts {  // NOLINT(bugprone-exception-escape): the CAD library's maps copy when they are moved
  std::vector<TopoDS_Solid> solids;
  std::vector<TopoDS_Shell> closed_shells;  ///< outside solids
  TopTools_IndexedMapOfShape open_faces;    ///< of shells that do not close
  TopTools_IndexedMapOfShape loose_faces;   ///< of no shell
};

std::vector<TopoDS_Shell> shells_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shell> shells;
  for (TopExp_Explorer each(shape, TopAbs_SHELL); each.More(); each.Next()) {
    shells.push_back(TopoDS::Shell(each.Current()));
  }
  return shells;
}

bool is_ignored(const FaceLabels& labels, const TopoDS_Shape& face) {
  const FaceLabel* label = labels.Seek(face);
  return label != nullptr && label->ignored;
}

bool has_ignored(const FaceLabels& labels, const TopoDS_Shape& shape) {
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next())
    if (is_ignored(labels, faces.Current())) return true;
  return false;
}

void add_faces(const TopoDS_Shape& shape, const FaceLabels& labels, TopTools_IndexedMapOfShape& faces) {
  for (TopExp_Explorer each(shape, TopAbs_FACE); each.More(); each.Next())
    if (!is_ignored(labels, each.Current())) faces.Add(each.Current());
}

Parts take_apart(const TopoDS_Shape& shape, const FaceLabels& labels, Changes& changes) {
  Parts parts;
  const TopTools_IndexedMapOfShape solids = map_of(shape, TopAbs_SOLID);
  TopTools_IndexedMapOfShape shells;
  for (int i = 1; i <= solids.Extent(); ++i) {
    const std::vector<TopoDS_Shell> bounds = shells_of(solids(i));
    const bool closed = !bounds.empty() && std::all_of(bounds.begin(), bounds.end(), is_closed) &&
                        !has_ignored(labels, solids(i));
    if (closed) {
      parts.solids.push_back(TopoDS::Solid(solids(i).Oriented(TopAbs_FORWARD)));
    } else {
      changes.push_back({fmt::format("solid {} is not closed: its faces are sewn anew", i - 1)});
      add_faces(solids(i), labels, parts.open_faces);
    }
  }
  // A compound may list the shells and faces of its solids once more.
  TopTools_IndexedMapOfShape of_solids;
  for (int i = 1; i <= solids.Extent(); ++i) TopExp::MapShapes(solids(i), TopAbs_FACE, of_solids);
  for (TopExp_Explorer each(shape, TopAbs_SHELL, TopAbs_SOLID); each.More(); each.Next()) {
    const TopExp_Explorer first(each.Current(), TopAbs_FACE);
    if (first.More() && !of_solids.Contains(first.Current())) shells.Add(each.Current());
  }
  for (int i = 1; i <= shells.Extent(); ++i) {
    const TopoDS_Shell shell = TopoDS::Shell(shells(i));
    if (is_closed(shell) && !has_ignored(labels, shell)) {
      parts.closed_shells.push_back(shell);
    } else {
      add_faces(shell, labels, parts.open_faces);
    }
  }
  for (TopExp_Explorer each(shape, TopAbs_FACE, TopAbs_SHELL); each.More(); each.Next()) {
    if (!is_ignored(labels, each.Current())) parts.loose_faces.Add(each.Current());
  }
  return parts;
}

/// One solid may hold shells that are no voids but bodies of their own.
void split_solid(const TopoDS_Solid& solid, std::size_t index, Volumes& volumes,
                 std::vector<TopoDS_Solid>& result, Changes& changes) {
  const std::vector<TopoDS_Shell> shells = shells_of(solid);
  if (shells.size() == 1) {
    const double volume = volumes.of(solid);
    if (volume >= 0) return result.push_back(solid);
    changes.push_back({fmt::format("solid {} was inside out: turned", index)});
    return result.push_back(solid_of(shells.front(), volumes));
  }
  const std::vector<TopoDS_Solid> split = nest_shells(shells, volumes);
  if (split.size() > 1) {
    changes.push_back({fmt::format("solid {} held {} separate bodies: one solid each", index, split.size())});
  }
  result.insert(result.end(), split.begin(), split.end());
}

/// Gaps that elements would show are the user's to close.
double largest_sewing_tolerance(double smallest_size) {
  return smallest_size > 0 ? tolerances::fraction_of_size * smallest_size
                           : std::numeric_limits<double>::infinity();
}

void drop_faces(const TopTools_IndexedMapOfShape& faces, const std::vector<TopoDS_Solid>& solids,
                Changes& changes) {
  TopTools_IndexedMapOfShape used;
  for (const TopoDS_Solid& solid : solids) TopExp::MapShapes(solid, TopAbs_FACE, used);
  for (int i = 1; i <= faces.Extent(); ++i) {
    if (used.Contains(faces(i))) continue;
    changes.push_back({fmt::format("a loose face around {} belongs to no solid: dropped",
                                   geometry::place_text(tight_box(faces(i)).center()))});
  }
}

/// `boxes`: of the solids.
void require_volume(const std::vector<TopoDS_Solid>& solids, const std::vector<Box>& boxes,
                    Volumes& volumes) {
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Box& box = boxes[i];
    const double volume = volumes.of(solids[i]);
    if (volume > tolerances::no_volume * std::pow(box.diagonal(), 3)) continue;
    throw CadError(
        fmt::format("solid {} around {} encloses next to no volume ({:.3g} in a box of diagonal {:.6g}): "
                    "what is as thin as that, a sheet or a wire, cannot be meshed as a body",
                    i, geometry::place_text(box.center()), volume, box.diagonal()));
  }
}

}  // namespace

std::vector<TopoDS_Solid> solids_of(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape map = map_of(shape, TopAbs_SOLID);
  std::vector<TopoDS_Solid> solids;
  for (int i = 1; i <= map.Extent(); ++i) solids.push_back(TopoDS::Solid(map(i)));
  return solids;
}

TopoDS_Shape make_compound(const std::vector<TopoDS_Solid>& solids) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Solid& solid : solids) builder.Add(compound, solid);
  return compound;
}

NamedShape make_solids(NamedShape named, double smallest_size, Volumes& volumes, Changes& changes) {
  report_step("healing the shape");
  trim_spindle_tori(named, changes);
  Parts parts = take_apart(named.shape, named.labels, changes);
  std::vector<TopoDS_Solid> solids;
  for (std::size_t i = 0; i < parts.solids.size(); ++i)
    split_solid(parts.solids[i], i, volumes, solids, changes);
  std::vector<TopoDS_Shell> shells = parts.closed_shells;
  if (!shells.empty()) changes.push_back({fmt::format("{} closed shells promoted to solids", shells.size())});
  if (solids.empty() && shells.empty()) {
    add_faces(named.shape, named.labels, parts.open_faces);
    parts.loose_faces.Clear();
  }
  if (!parts.open_faces.IsEmpty()) {
    const SewnShells sewn = sew(parts.open_faces, largest_sewing_tolerance(smallest_size), named.labels,
                                changes, !solids.empty() || !shells.empty());
    shells.insert(shells.end(), sewn.shells.begin(), sewn.shells.end());
    named.gap = sewn.gap;
  }
  const std::vector<TopoDS_Solid> promoted = nest_shells(shells, volumes);
  solids.insert(solids.end(), promoted.begin(), promoted.end());
  if (solids.empty()) throw CadError("there are no faces to make a solid of");
  drop_faces(parts.loose_faces, solids, changes);
  named.shape = make_compound(solids);
  std::vector<Box> boxes;
  Box all;
  for (const TopoDS_Solid& solid : solids) all.add(boxes.emplace_back(tight_box(solid)));
  repair_edges(named.shape, tolerances::same_place * all.diagonal(), changes);
  require_volume(solids, boxes, volumes);
  return close_noise(std::move(named), smallest_size, changes);
}

}  // namespace aeroloom::cad
