#include "cad/repair/heal.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/noise.hpp"
#include "cad/repair/repair_edges.hpp"
#include "cad/repair/sewing.hpp"
#include "cad/repair/shells.hpp"
#include "cad/repair/spindle_tori.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
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

Parts take_apart(const TopoDS_Shape& shape, const FaceLabels& labels, std::vector<LooseFace>& loose,
                 Changes& changes) {
  Parts parts;
  const TopTools_IndexedMapOfShape solids = map_of(shape, TopAbs_SOLID);
  TopTools_IndexedMapOfShape shells;
  const TopTools_IndexedMapOfShape inner = faces_inside_solids(shape);
  for (const TopoDS_Shape& face : shapes_in(inner))
    if (!is_ignored(labels, face)) loose.push_back({TopoDS::Face(face), true});
  for (int i = 1; i <= solids.Extent(); ++i) {
    const TopoDS_Shape solid = inner.IsEmpty() ? solids(i) : without_inner_faces(solids(i));
    const std::vector<TopoDS_Shell> bounds = shells_of(solid);
    const bool closed = !bounds.empty() && std::all_of(bounds.begin(), bounds.end(), is_closed) &&
                        !has_ignored(labels, solid);
    if (closed) {
      parts.solids.push_back(TopoDS::Solid(solid.Oriented(TopAbs_FORWARD)));
    } else {
      changes.push_back({fmt::format("solid {} is not closed: its faces are sewn anew", i - 1)});
      add_faces(solid, labels, parts.open_faces);
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

/// Loose faces that no solid has wait for the fluid.
void keep_loose(const TopTools_IndexedMapOfShape& faces, const std::vector<TopoDS_Solid>& solids,
                std::vector<LooseFace>& loose) {
  TopTools_IndexedMapOfShape used;
  for (const TopoDS_Solid& solid : solids) TopExp::MapShapes(solid, TopAbs_FACE, used);
  for (const LooseFace& each : loose)
    used.Add(each.face);  // a compound may list the faces inside of its solids
  for (const TopoDS_Shape& face : shapes_in(faces)) {
    if (!used.Contains(face)) loose.push_back({TopoDS::Face(face)});
  }
}

void note_plane(const SewnShells& sewn, NamedShape& named) {
  if (!sewn.plane) return;
  named.symmetry_axis = sewn.plane->axis;
  named.symmetry_position = sewn.plane->position;
}

/// Faces of no shell beside bodies bound a half where they are open on the plane of symmetry: its shells,
/// sewn with the open faces. None if they do not close; all stay then as they are.
std::vector<TopoDS_Shell> sew_loose_half(Parts& parts, const SewingOptions& options, NamedShape& named,
                                         Changes& changes) {
  if (!options.half || !options.beside_bodies || parts.loose_faces.IsEmpty()) return {};
  const Box box = tight_box(named.shape);
  TopoDS_Compound loose;
  BRep_Builder builder;
  builder.MakeCompound(loose);
  for (const TopoDS_Shape& face : shapes_in(parts.loose_faces)) builder.Add(loose, face);
  const auto plane = plane_along(open_edges(loose), box, *options.half);
  if (!plane) return {};
  const double reach = tolerances::on_symmetry * box.diagonal();
  const auto is_on_plane = [&](const TopoDS_Shape& face) {
    const Box own = tight_box(face);
    return std::abs(own.low[plane->axis] - plane->position) <= reach &&
           std::abs(own.high[plane->axis] - plane->position) <= reach;
  };
  TopTools_IndexedMapOfShape faces = parts.open_faces, left;
  for (const TopoDS_Shape& face : shapes_in(parts.loose_faces)) (is_on_plane(face) ? left : faces).Add(face);
  SewingOptions at_plane = options;
  at_plane.half->axis = plane->axis, at_plane.half->position = plane->position;
  try {
    FaceLabels labels = named.labels;
    Changes made;
    const SewnShells sewn = sew(faces, at_plane, labels, made);
    named.labels = labels, named.gap = sewn.gap;
    note_plane(sewn, named);
    changes.insert(changes.end(), made.begin(), made.end());
    parts.open_faces.Clear();
    parts.loose_faces = left;
    return sewn.shells;
  } catch (const CadError&) {
    return {};
  }
}

/// Sews open faces to shells. Where there are bodies without them, sheets that do not close are loose faces.
std::vector<TopoDS_Shell> sew_open_faces(const TopTools_IndexedMapOfShape& faces,
                                         const SewingOptions& options, NamedShape& named, Changes& changes) {
  try {
    const SewnShells sewn = sew(faces, options, named.labels, changes);
    named.gap = sewn.gap;
    note_plane(sewn, named);
    return sewn.shells;
  } catch (const CadError& error) {
    if (!options.beside_bodies || !are_sheets(faces)) throw;
    named.sheet_fault = error.what();
  }
  for (const TopoDS_Shape& face : shapes_in(faces)) named.loose.push_back({TopoDS::Face(face), false, true});
  return {};
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
                    i, place_in_file(box.center()), in_file(volume, 3), in_file(box.diagonal())));
  }
}

}  // namespace

std::vector<TopoDS_Solid> solids_of(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape map = map_of(shape, TopAbs_SOLID);
  std::vector<TopoDS_Solid> solids;
  for (int i = 1; i <= map.Extent(); ++i) solids.push_back(TopoDS::Solid(map(i)));
  return solids;
}

TopoDS_Shape without_inner_faces(const TopoDS_Shape& solid) {
  TopoDS_Shape bare = solid.EmptyCopied();
  BRep_Builder builder;
  for (TopoDS_Iterator parts(solid, false, false); parts.More(); parts.Next()) {
    if (parts.Value().ShapeType() != TopAbs_SHELL || !bounds_material(parts.Value())) continue;
    TopoDS_Shape shell = parts.Value().EmptyCopied();
    for (TopoDS_Iterator faces(parts.Value(), false, false); faces.More(); faces.Next()) {
      if (bounds_material(faces.Value())) builder.Add(shell, faces.Value());
    }
    if (!TopoDS_Iterator(shell).More()) continue;
    shell.Closed(is_closed(TopoDS::Shell(shell)));
    builder.Add(bare, shell);
  }
  return bare;
}

TopoDS_Shape make_compound(const std::vector<TopoDS_Solid>& solids) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Solid& solid : solids) builder.Add(compound, solid);
  return compound;
}

NamedShape make_solids(NamedShape named, double smallest_size, Volumes& volumes, Changes& changes,
                       const std::optional<HalfPlane>& half, OpeningRules* openings) {
  report_step("healing the shape");
  trim_spindle_tori(named, changes);
  Parts parts = take_apart(named.shape, named.labels, named.loose, changes);
  std::vector<TopoDS_Solid> solids;
  for (std::size_t i = 0; i < parts.solids.size(); ++i)
    split_solid(parts.solids[i], i, volumes, solids, changes);
  std::vector<TopoDS_Shell> shells = parts.closed_shells;
  if (!shells.empty()) changes.push_back({fmt::format("{} closed shells promoted to solids", shells.size())});
  if (solids.empty() && shells.empty()) {
    add_faces(named.shape, named.labels, parts.open_faces);
    parts.loose_faces.Clear();
  }
  const SewingOptions options{largest_sewing_tolerance(smallest_size), !solids.empty() || !shells.empty(),
                              half, openings};
  std::vector<TopoDS_Shell> sewn = sew_loose_half(parts, options, named, changes);
  if (!parts.open_faces.IsEmpty()) sewn = sew_open_faces(parts.open_faces, options, named, changes);
  shells.insert(shells.end(), sewn.begin(), sewn.end());
  const std::vector<TopoDS_Solid> promoted = nest_shells(shells, volumes);
  solids.insert(solids.end(), promoted.begin(), promoted.end());
  if (solids.empty()) throw CadError("there are no faces to make a solid of");
  keep_loose(parts.loose_faces, solids, named.loose);
  named.shape = make_compound(solids);
  std::vector<Box> boxes;
  Box all;
  for (const TopoDS_Solid& solid : solids) all.add(boxes.emplace_back(tight_box(solid)));
  repair_edges(named.shape, tolerances::same_place * all.diagonal(), changes);
  require_volume(solids, boxes, volumes);
  return close_noise(std::move(named), smallest_size, changes);
}

}  // namespace aeroloom::cad
