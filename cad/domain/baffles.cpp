#include "cad/domain/baffles.hpp"

#include "cad/domain/booleans.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <BOPTools_AlgoTools3D.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <IntTools_Context.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <fmt/format.h>
#include <gp_Pnt2d.hxx>
#include <gp_Vec2d.hxx>

namespace aeroloom::cad {
namespace {

std::string describe_loose(const FaceLabels& labels, const TopoDS_Face& face) {
  const FaceLabel* const label = labels.Seek(face);
  if (label == nullptr || label->number < 0) return "a face";
  return fmt::format("face {} '{}'", label->number, shown_name(*label));
}

/// What became of a loose face.
struct PlacedFace {    // NOLINT(bugprone-exception-escape): the CAD library's maps copy when they are moved
  int images = 0;      ///< the parts that it became
  int baffles = 0;     ///< of them, those inside of a region
  int interfaces = 0;  ///< and those between two, which had no face there
  TopTools_IndexedMapOfShape kept;
  bool is_kept() const { return baffles + interfaces > 0; }
};

/// The solids of the fluid with the loose faces in them.
struct FusedFluid {  // NOLINT(bugprone-exception-escape): as above
  std::vector<TopoDS_Solid> solids;
  FaceLabels labels;
  std::vector<PlacedFace> placed;  ///< by loose face
};

/// Divides solids and faces where they meet, and where `cuts` lie on them.
FusedFluid fuse_loose(const NamedShape& fluid, const std::vector<TopoDS_Edge>& cuts) {
  const std::vector<TopoDS_Solid> before = solids_of(fluid.shape);
  TopTools_ListOfShape arguments = list_of(before);
  for (const LooseFace& loose : fluid.loose) arguments.Append(loose.face);
  for (const TopoDS_Edge& cut : cuts) arguments.Append(cut);
  BRepAlgoAPI_BuilderAlgo fuse;
  fuse.SetArguments(arguments);
  perform(fuse, "placing faces inside of the fluid");
  FusedFluid fused{solids_of(fuse.Shape()), fluid.labels, {}};
  follow_labels(fuse, before, fused.labels);
  TopTools_IndexedMapOfShape of_solids;  // faces that the solids had
  for (const TopoDS_Shape& face : shapes_in(map_of(fluid.shape, TopAbs_FACE))) {
    of_solids.Add(face);
    for (const TopoDS_Shape& image : fuse.Modified(face)) of_solids.Add(image);
  }
  const TopoDS_Shape all = make_compound(fused.solids);
  const TopTools_IndexedMapOfShape inside = faces_inside_solids(all), faces = map_of(all, TopAbs_FACE);
  for (const LooseFace& loose : fluid.loose) {
    TopTools_ListOfShape images = fuse.Modified(loose.face);
    if (images.IsEmpty() && !fuse.IsDeleted(loose.face)) images.Append(loose.face);
    PlacedFace& placed = fused.placed.emplace_back();
    for (const TopoDS_Shape& image : images) {
      ++placed.images;
      if (!faces.Contains(image) || of_solids.Contains(image)) continue;
      ++(inside.Contains(image) ? placed.baffles : placed.interfaces);
      placed.kept.Add(image.Oriented(TopAbs_FORWARD));
      if (!fused.labels.IsBound(image)) copy_label(fused.labels, loose.face, image);
    }
  }
  return fused;
}

/// The line of constant parameter across a face through a point of it: that which crosses a curve with this
/// direction in the parameter plane.
TopoDS_Edge line_across(const TopoDS_Face& face, const gp_Pnt2d& at, const gp_Vec2d& along) {
  double u_low, u_high, v_low, v_high;
  BRepTools::UVBounds(face, u_low, u_high, v_low, v_high);
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  gp_Pnt point;
  gp_Vec by_u, by_v;
  surface->D1(at.X(), at.Y(), point, by_u, by_v);
  const bool runs_along_u = std::abs(along.X()) * by_u.Magnitude() > std::abs(along.Y()) * by_v.Magnitude();
  const Handle(Geom_Curve) curve = runs_along_u ? surface->UIso(at.X()) : surface->VIso(at.Y());
  return runs_along_u ? BRepBuilderAPI_MakeEdge(curve, v_low, v_high).Edge()
                      : BRepBuilderAPI_MakeEdge(curve, u_low, u_high).Edge();
}

/// Where edges of baffles end inside of a face of the fluid, without dividing it: lines that do.
void add_cuts(const TopoDS_Face& face, const TopTools_IndexedMapOfShape& baffle_edges,
              std::vector<TopoDS_Edge>& cuts) {
  std::vector<TopoDS_Edge> inner;
  TopTools_IndexedMapOfShape border;
  for (TopExp_Explorer edges(face, TopAbs_EDGE); edges.More(); edges.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
    if (bounds_material(edge))
      TopExp::MapShapes(edge, TopAbs_VERTEX, border);
    else if (baffle_edges.Contains(edge))
      inner.push_back(edge);
  }
  const auto ends_at = [&](const TopoDS_Vertex& vertex) {
    return std::count_if(inner.begin(), inner.end(), [&](const TopoDS_Edge& edge) {
      return TopExp::FirstVertex(edge).IsSame(vertex) || TopExp::LastVertex(edge).IsSame(vertex);
    });
  };
  for (const TopoDS_Edge& edge : inner) {
    double first, last;
    const Handle(Geom2d_Curve) image = BRep_Tool::CurveOnSurface(edge, face, first, last);
    if (image.IsNull()) continue;
    for (const bool at_end : {false, true}) {
      const TopoDS_Vertex vertex = at_end ? TopExp::LastVertex(edge) : TopExp::FirstVertex(edge);
      if (border.Contains(vertex) || ends_at(vertex) > 1) continue;
      gp_Pnt2d at;
      gp_Vec2d along;
      image->D1(at_end ? last : first, at, along);
      cuts.push_back(line_across(face, at, along));
    }
  }
}

std::vector<TopoDS_Edge> find_cuts(const FusedFluid& fused) {
  TopTools_IndexedMapOfShape baffle_edges;
  for (const PlacedFace& placed : fused.placed) {
    for (const TopoDS_Shape& face : shapes_in(placed.kept))
      TopExp::MapShapes(face, TopAbs_EDGE, baffle_edges);
  }
  std::vector<TopoDS_Edge> cuts;
  for (const TopoDS_Shape& face : shapes_in(map_of(make_compound(fused.solids), TopAbs_FACE)))
    add_cuts(TopoDS::Face(face.Oriented(TopAbs_FORWARD)), baffle_edges, cuts);
  return cuts;
}

bool has_kept(const FusedFluid& fused) {
  return std::any_of(fused.placed.begin(), fused.placed.end(),
                     [](const PlacedFace& f) { return f.is_kept(); });
}

void refuse_baffles(const NamedShape& fluid, const FusedFluid& fused) {
  std::string first;
  int count = 0;
  for (std::size_t i = 0; i < fluid.loose.size(); ++i) {
    if (!fused.placed[i].is_kept()) continue;
    if (count++ > 0) continue;
    const TopoDS_Face& face = fluid.loose[i].face;
    first = fmt::format("{} around {}", describe_loose(fluid.labels, face),
                        place_in_file(tight_box(face).center()));
  }
  throw CadError(
      fmt::format("{} lies inside of the fluid and bounds no solid{}. Remedy: keep it as a baffle "
                  "(DomainOptions::baffles: keep), or leave it out of the geometry",
                  first, count > 1 ? fmt::format(", and so do {} more", count - 1) : std::string()));
}

/// Fused until no baffle ends inside of a wall.
FusedFluid fuse_with_cuts(const NamedShape& fluid) {
  constexpr int rounds = 4;  // each may divide faces that baffles meet; chosen, not measured
  std::vector<TopoDS_Edge> cuts;
  FusedFluid fused = fuse_loose(fluid, cuts);
  for (int round = 1; has_kept(fused); ++round) {
    const std::vector<TopoDS_Edge> more = find_cuts(fused);
    if (more.empty()) break;
    if (round == rounds) {
      const BRepAdaptor_Curve line(more.front());
      throw CadError(fmt::format(
          "a baffle ends inside of a face near {}, which lines there do not divide. Remedy: divide that "
          "face along the baffle in the CAD program",
          place_in_file(to_vec(line.Value(line.FirstParameter())))));
    }
    cuts.insert(cuts.end(), more.begin(), more.end());
    fused = fuse_loose(fluid, cuts);
  }
  return fused;
}

void require_same_volume(const std::vector<TopoDS_Solid>& before, const std::vector<TopoDS_Solid>& after,
                         Volumes& volumes) {
  const double wanted = volume_of(before, volumes), found = volume_of(after, volumes);
  if (std::abs(wanted - found) <= tolerances::integrated_volume * wanted) return;
  throw CadError(fmt::format(
      "placing baffles in the fluid changes its volume from {:.9g} to {:.9g}. Remedy: keep baffles clearly "
      "apart from walls, or have them share their edges in the CAD program",
      in_file(wanted, 3), in_file(found, 3)));
}

void drop(const LooseFace& loose, Changes& changes) {
  const Vec3 center = tight_box(loose.face).center();
  changes.push_back(
      {fmt::format("a loose face around {} belongs to no solid: dropped", place_in_file(center))});
}

std::string describe_placed(const PlacedFace& placed) {
  std::string text = "lies inside of the fluid: kept as a baffle";
  if (placed.interfaces > 0) {
    text = placed.baffles > 0 ? "divides the fluid: kept as a baffle, and as the interface between regions"
                              : "divides the fluid: kept as the interface between regions";
  }
  const bool partly = placed.baffles + placed.interfaces < placed.images;
  return text + (partly ? ", without what of it lies outside or on walls" : "");
}

void list_placed(const NamedShape& fluid, const FusedFluid& fused, Changes& changes) {
  for (std::size_t i = 0; i < fluid.loose.size(); ++i) {
    const LooseFace& loose = fluid.loose[i];
    const PlacedFace& placed = fused.placed[i];
    if (placed.is_kept()) {
      changes.push_back({describe_loose(fluid.labels, loose.face) + " " + describe_placed(placed),
                         tight_box(loose.face).center()});
    } else {
      drop(loose, changes);
    }
  }
}

/// Open shells that are nowhere in the fluid are no bodies either.
void require_sheets_inside(const NamedShape& fluid, const FusedFluid& fused) {
  bool has_sheets = false;
  for (std::size_t i = 0; i < fluid.loose.size(); ++i) {
    if (!fluid.loose[i].in_sheet) continue;
    if (fused.placed[i].is_kept()) return;
    has_sheets = true;
  }
  if (has_sheets) throw CadError(fluid.sheet_fault);
}

/// Drops loose faces that reach no box of a solid.
void drop_distant(NamedShape& fluid, Changes& changes) {
  Box all;
  for (const TopoDS_Solid& solid : solids_of(fluid.shape)) all.add(tight_box(solid));
  std::vector<LooseFace> near;
  for (const LooseFace& loose : fluid.loose) {
    if (loose.in_sheet || tight_box(loose.face).overlaps(all))
      near.push_back(loose);
    else
      drop(loose, changes);
  }
  fluid.loose = std::move(near);
}

}  // namespace

int count_loose_inside(const NamedShape& solids) {
  const std::vector<TopoDS_Solid> all = solids_of(solids.shape);
  Handle(IntTools_Context) context = new IntTools_Context;
  const auto lies_inside = [&](const LooseFace& loose) {
    gp_Pnt point;
    gp_Pnt2d at;
    if (BOPTools_AlgoTools3D::PointInFace(loose.face, point, at, context) != 0) return false;
    return std::any_of(all.begin(), all.end(), [&](const TopoDS_Solid& solid) {
      BRepClass3d_SolidClassifier classifier(solid, point, tolerances::library_length);
      return classifier.State() == TopAbs_IN;
    });
  };
  return static_cast<int>(std::count_if(solids.loose.begin(), solids.loose.end(), lies_inside));
}

void drop_loose(NamedShape& bodies, Changes& changes) {
  if (!bodies.sheet_fault.empty()) {
    throw CadError(bodies.sheet_fault + (count_loose_inside(bodies) > 0
                                             ? ", or take its solids as the fluid (DomainOptions::kind: "
                                               "fluid), if what lies in them is a baffle"
                                             : ""));
  }
  for (const LooseFace& loose : bodies.loose) drop(loose, changes);
  bodies.loose.clear();
}

bool place_baffles(NamedShape& fluid, Baffles treatment, Volumes& volumes, Changes& changes) {
  drop_distant(fluid, changes);
  if (fluid.loose.empty()) return false;
  FusedFluid fused;
  try {
    fused = fuse_with_cuts(fluid);
  } catch (const CadError& error) {
    const bool are_asked_for = std::any_of(fluid.loose.begin(), fluid.loose.end(),
                                           [](const LooseFace& f) { return f.in_solid || f.in_sheet; });
    if (are_asked_for) throw;
    for (const LooseFace& loose : fluid.loose) drop(loose, changes);
    changes.push_back({fmt::format("{} loose faces could not be placed in the fluid, where they may be "
                                   "baffles: {}",
                                   fluid.loose.size(), error.what()),
                       {},
                       0,
                       true});
    fluid.loose.clear();
    return false;
  }
  const bool has_baffles = has_kept(fused);
  if (has_baffles && treatment == Baffles::refuse) refuse_baffles(fluid, fused);
  require_sheets_inside(fluid, fused);
  list_placed(fluid, fused, changes);
  fluid.loose.clear();
  if (!has_baffles) return false;
  const std::vector<TopoDS_Solid> before = solids_of(fluid.shape);
  require_same_volume(before, fused.solids, volumes);
  if (fused.solids.size() > before.size()) {
    changes.push_back({fmt::format("faces across the fluid divide its {} region(s) into {}", before.size(),
                                   fused.solids.size())});
  }
  fluid.shape = make_compound(fused.solids);
  fluid.labels = fused.labels;
  return true;
}

}  // namespace aeroloom::cad
