#include "cad/domain/far_field.hpp"

#include "cad/domain/far_field_shape.hpp"
#include "cad/domain/flat_sides.hpp"
#include "cad/domain/symmetry.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/repair/heal.hpp"
#include "cad/repair/on_plane.hpp"
#include "cad/repair/plane_loops.hpp"
#include "cad/repair/sewing.hpp"
#include "cad/repair/shells.hpp"
#include "cad/tolerances.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <BRepClass3d.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The shells that face the fluid. A body's cavities hold no outside fluid; a body in another's cavity never
/// meets it.
std::vector<TopoDS_Shell> outer_shells(const TopoDS_Shape& bodies, Volumes& volumes, Changes& changes) {
  std::vector<TopoDS_Shell> shells;
  for (const TopoDS_Solid& solid : solids_of(bodies)) {
    const TopoDS_Shell outer = BRepClass3d::OuterShell(solid);
    if (outer.IsNull()) throw CadError("a body has no outer shell");
    shells.push_back(outer);
    int voids = -1;
    for (TopExp_Explorer each(solid, TopAbs_SHELL); each.More(); each.Next()) ++voids;
    if (voids > 0)
      changes.push_back(
          {fmt::format("{} closed cavities inside a body do not reach the fluid: left out", voids)});
  }
  if (shells.size() == 1) return shells;
  const std::vector<TopoDS_Solid> nested = nest_shells(shells, volumes);
  std::vector<TopoDS_Shell> outermost, outer;
  std::vector<Box> boxes;
  for (const TopoDS_Solid& solid : nested) {
    outer.push_back(BRepClass3d::OuterShell(solid));
    boxes.push_back(nested.size() > 1 ? tight_box(outer.back()) : Box{});
  }
  for (std::size_t i = 0; i < nested.size(); ++i) {
    bool buried = false;
    for (std::size_t j = 0; j < nested.size() && !buried; ++j) {
      const bool may_nest = i != j && (boxes[i].contains(boxes[j]) || boxes[j].contains(boxes[i]));
      buried = may_nest && nest_shells({outer[j], outer[i]}, volumes).size() == 1;
    }
    if (!buried) outermost.push_back(outer[i]);
  }
  if (outermost.size() < shells.size()) {
    changes.push_back({fmt::format("{} bodies lie inside others and do not reach the fluid: left out",
                                   shells.size() - outermost.size())});
  }
  return outermost;
}

/// Trimmed spline faces are integrated to about four digits; what this is to find is a body that vanished or
/// counts twice.
/// `slack` is the volume that borders put on a plane swept.
void require_sum_of_volumes(double far_field, double body, double fluid, double slack = 0) {
  const double error = std::abs(far_field - body - fluid);
  const double bearable =
      tolerances::sum_of_volumes * std::abs(body) + tolerances::rounding * far_field + slack;
  if (error <= bearable && body > 0) return;
  throw CadError(
      fmt::format("the volumes do not add up: far field {:.9g}, bodies {:.9g}, fluid {:.9g}; the body's "
                  "shells cross or are turned "
                  "inside out",
                  in_file(far_field, 3), in_file(body, 3), in_file(fluid, 3)));
}

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer each(shape, TopAbs_FACE); each.More(); each.Next())
    faces.push_back(TopoDS::Face(each.Current()));
  return faces;
}

/// The fluid's boundary while it is put together: faces that look out of the fluid.
struct Walls {
  std::vector<TopoDS_Face> faces;
  TopoDS_Face plane;  ///< the part of the plane of symmetry that reaches the far field; null without one
};

/// Edges that one of the faces uses, and no other.
std::vector<TopoDS_Edge> rim_of(const std::vector<TopoDS_Face>& faces) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Face& face : faces) builder.Add(compound, face);
  return open_edges(compound);
}

FaceLabel symmetry_label() {
  FaceLabel label;
  label.name = "symmetry";
  label.solid = "fluid";
  label.far_field = label.symmetry = true;
  return label;
}

/// Puts the plane of symmetry in place of the bodies' sections: the far field's own faces there become one
/// that gets the outlines of the sections as holes, what they enclose gets faces of its own.
void add_plane(const SymmetryPlane& symmetry, const std::vector<TopoDS_Face>& far_faces,
               const std::vector<TopoDS_Face>& sections, Walls& walls, FaceLabels& labels) {
  const auto loops = find_plane_loops(rim_of(sections), symmetry.tolerance, symmetry.plane());
  if (!loops) {
    throw CadError(
        fmt::format("the body's section at the plane of symmetry has an outline that is no simple "
                    "closed loop: repair the body near coordinate {} = {:.6g}",
                    symmetry.axis, in_file(symmetry.position)));
  }
  std::vector<TopoDS_Wire> outlines;
  for (std::size_t i = 0; i < loops->size(); ++i) {
    if ((*loops)[i].depth == 0) outlines.push_back((*loops)[i].wire);
    if ((*loops)[i].depth % 2 == 1) walls.faces.push_back(make_plane_face(*loops, i));
  }
  const auto rim = find_plane_loops(rim_of(far_faces), symmetry.tolerance, symmetry.plane());
  if (!rim || rim->size() != 1) throw std::logic_error("the far field's section is no single loop");
  walls.plane = make_plane_face(symmetry.plane(), rim->front().wire, outlines);
  for (const TopoDS_Face& island : walls.faces) labels.Bind(island, symmetry_label());
  labels.Bind(walls.plane, symmetry_label());
}

/// Groups faces that share edges; the group of face 0 first, each in order.
std::vector<std::vector<TopoDS_Face>> connected_groups(const std::vector<TopoDS_Face>& faces) {
  geometry::DisjointSets<int> sets(faces.size());
  TopTools_IndexedMapOfShape edges;
  std::vector<int> first_user;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (TopExp_Explorer each(faces[i], TopAbs_EDGE); each.More(); each.Next()) {
      const int edge = edges.Add(each.Current()) - 1;
      if (edge == static_cast<int>(first_user.size())) first_user.push_back(static_cast<int>(i));
      sets.unite(first_user[edge], static_cast<int>(i));
    }
  }
  std::vector<std::vector<TopoDS_Face>> groups(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) groups[sets.root(static_cast<int>(i))].push_back(faces[i]);
  std::erase_if(groups, [](const auto& members) { return members.empty(); });
  return groups;
}

TopoDS_Shell make_closed_shell(const std::vector<TopoDS_Face>& faces) {
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  for (const TopoDS_Face& face : faces) builder.Add(shell, face);
  shell.Closed(true);
  return shell;
}

/// The fluid's solid from its walls. Groups of walls that do not reach the plane of symmetry are voids around
/// bodies; those closed by islands alone are cavities without connection to the outside.
TopoDS_Solid make_fluid_solid(const Walls& walls, const FaceLabels& labels, Volumes& volumes,
                              double& cavities, Changes& changes) {
  TopoDS_Solid fluid;
  BRep_Builder builder;
  builder.MakeSolid(fluid);
  std::vector<TopoDS_Face> all{walls.plane};
  all.insert(all.end(), walls.faces.begin(), walls.faces.end());
  const auto groups = connected_groups(all);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const TopoDS_Shell shell = make_closed_shell(groups[i]);
    const bool has_island = std::ranges::any_of(groups[i], [&](const TopoDS_Face& face) {
      const FaceLabel* label = labels.Seek(face);
      return label != nullptr && label->symmetry;
    });
    if (i == 0 || !has_island) {
      builder.Add(fluid, shell);
      continue;
    }
    cavities += std::abs(volumes.of(shell));
    changes.push_back(
        {"a cavity inside a body, cut open by the plane of symmetry, does not reach the fluid: "
         "left out",
         tight_box(shell).center()});
  }
  return fluid;
}

/// Puts the outlines of sections beside the plane on it. Returns a bound on the volume that this changes.
double put_sections_on_plane(const std::vector<TopoDS_Face>& sections, const SymmetryPlane& symmetry,
                             Changes& changes) {
  const AxisPlane plane{symmetry.axis, symmetry.position};
  std::vector<TopoDS_Edge> beside;
  Box box;
  double length = 0;
  for (const TopoDS_Edge& edge : rim_of(sections)) {
    if (distance_from(plane, edge) <= symmetry.tolerance) continue;
    beside.push_back(edge);
    box.add(tight_box(edge));
    length += box.diagonal();
  }
  if (beside.empty()) return 0;
  const PutOnPlane put = put_on_plane(beside, plane);
  changes.push_back(
      {fmt::format("{} edges of a flat side beside the plane of symmetry put on it (edges nearer "
                   "than {:.3g}, {:.0e} of the diagonal, are)",
                   put.edges, in_file(symmetry.reach), tolerances::on_symmetry),
       put.where, put.most});
  return put.most * length * box.diagonal();
}

NamedShape surround_half(NamedShape bodies, const SymmetryPlane& symmetry, const TopoDS_Solid& far_field,
                         Volumes& volumes, Changes& changes) {
  Walls walls;
  std::vector<TopoDS_Face> far_faces, far_walls;
  for (const TopoDS_Face& face : faces_of(far_field)) {
    (symmetry.holds(face) ? far_faces : far_walls).push_back(face);
  }
  std::vector<TopoDS_Face> body_walls, sections;
  double body_volume = 0;
  for (const TopoDS_Shell& shell : outer_shells(bodies.shape, volumes, changes)) {
    const TopoDS_Solid body = solid_of(shell, volumes);
    body_volume += volumes.of(body);
    for (const TopoDS_Face& face : faces_of(body)) {
      (is_flat_side(face, symmetry) ? sections : body_walls).push_back(face);
    }
  }
  const double moved = put_sections_on_plane(sections, symmetry, changes);
  add_plane(symmetry, far_faces, sections, walls, bodies.labels);
  walls.faces.insert(walls.faces.end(), far_walls.begin(), far_walls.end());
  for (const TopoDS_Face& face : body_walls) walls.faces.push_back(TopoDS::Face(face.Reversed()));
  double cavities = 0;
  const TopoDS_Solid fluid = make_fluid_solid(walls, bodies.labels, volumes, cavities, changes);
  require_sum_of_volumes(volumes.of(far_field), body_volume + cavities, volumes.of(fluid), moved);
  bodies.shape = make_compound({fluid});
  return bodies;
}

NamedShape surround_whole(NamedShape bodies, const TopoDS_Solid& far_field, Volumes& volumes,
                          Changes& changes) {
  BRep_Builder builder;
  TopoDS_Solid fluid;
  builder.MakeSolid(fluid);
  builder.Add(fluid, TopExp_Explorer(far_field, TopAbs_SHELL).Current());
  double body_volume = 0;
  for (const TopoDS_Shell& shell : outer_shells(bodies.shape, volumes, changes)) {
    const TopoDS_Solid body = solid_of(shell, volumes);
    body_volume += volumes.of(body);
    builder.Add(fluid, TopExp_Explorer(body, TopAbs_SHELL).Current().Reversed());
  }
  require_sum_of_volumes(volumes.of(far_field), body_volume, volumes.of(fluid));
  bodies.shape = make_compound({fluid});
  return bodies;
}

/// Triangles are not cut at the plane of symmetry.
void require_off_plane(const Box& beside, const SymmetryPlane& symmetry) {
  const double ahead = beside.low[symmetry.axis] - symmetry.position,
               behind = symmetry.position - beside.high[symmetry.axis];
  if ((symmetry.positive ? ahead : behind) > symmetry.tolerance) return;
  throw CadError(
      fmt::format("bodies of triangles reach the plane of symmetry, {}, where triangles are not cut. Remedy: "
                  "farfield.symmetry: none, or triangles on the kept side of the plane alone",
                  describe(symmetry)));
}

}  // namespace

NamedShape surround(NamedShape bodies, const FarFieldOptions& options, Volumes& volumes, Changes& changes,
                    const Box& beside) {
  report_step("building the far field");
  const std::optional<SymmetryPlane> symmetry = find_symmetry(options, bodies);
  Box box = tight_box(bodies.shape);
  if (symmetry && !beside.empty()) require_off_plane(beside, *symmetry);
  Box whole = box;
  whole.add(beside);
  if (symmetry) changes.push_back({describe(*symmetry)});
  if (symmetry) {
    bodies = cut_at_symmetry(std::move(bodies), *symmetry, volumes, changes);
    box = tight_box(bodies.shape);
  }
  box.add(beside);
  const TopoDS_Solid far_field = place_far_field(options, {whole, box}, symmetry, bodies.labels);
  if (!symmetry) return surround_whole(std::move(bodies), far_field, volumes, changes);
  return surround_half(std::move(bodies), *symmetry, far_field, volumes, changes);
}

}  // namespace aeroloom::cad
