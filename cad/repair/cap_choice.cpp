#include "cad/repair/cap_choice.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/repair/filled_loops.hpp"
#include "cad/tolerances.hpp"

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include <BOPTools_AlgoTools.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS_Compound.hxx>

namespace aeroloom::cad {
namespace {

/// More uneven openings are damage. Chosen, not measured.
constexpr std::size_t most_uneven = 64;

double capped_area(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return std::abs(properties.Mass());
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
      (cap_faces.Contains(faces.Current()) ? openings : walls) += capped_area(faces.Current());
    }
    if (openings > widest_opening * walls) return false;
  }
  return true;
}

/// Whether the rules name the opening with these edges.
bool is_named(const TopTools_IndexedMapOfShape& edges, const Sewn& sewn, OpeningRules* openings) {
  if (openings == nullptr || openings->empty()) return false;
  std::vector<std::string> names;
  for (const TopoDS_Shape& face : shapes_in(map_of(sewn.shape, TopAbs_FACE))) {
    for (TopExp_Explorer each(face, TopAbs_EDGE); each.More(); each.Next())
      if (edges.Contains(each.Current())) names.push_back(shown_name(sewn.labels, face));
  }
  return openings->take(names, tight_box(std::vector<TopoDS_Shape>(edges.cbegin(), edges.cend())));
}

/// Planar caps, and fillings of what is uneven. Empty if an opening gets none.
std::vector<Cap> cap_all(const Sewn& sewn, const WallSizes& walls, OpeningRules* openings) {
  const auto loops = find_loops(open_edges(sewn.shape));
  if (!loops) return {};
  std::vector<TopoDS_Edge> planar;
  std::vector<Cap> caps;
  std::size_t uneven = 0;
  for (const std::vector<TopoDS_Edge>& loop : *loops) {
    if (!cap_openings(loop, tolerances::planar_opening * walls.diagonal).empty()) {
      planar.insert(planar.end(), loop.begin(), loop.end());
      continue;
    }
    TopTools_IndexedMapOfShape edges;
    for (const TopoDS_Edge& edge : loop) edges.Add(edge);
    const std::optional<Cap> filled = ++uneven > most_uneven
                                          ? std::nullopt
                                          : fill_narrow_loop(loop, walls, is_named(edges, sewn, openings));
    if (!filled) return {};
    caps.push_back(*filled);
  }
  const std::vector<Cap> flat = cap_openings(planar, tolerances::planar_opening * walls.diagonal);
  if (flat.empty() && !planar.empty()) return {};
  caps.insert(caps.begin(), flat.begin(), flat.end());
  return caps;
}

}  // namespace

std::vector<Cap> choose_caps(const Sewn& sewn, double diagonal, OpeningRules* openings, CapForm form) {
  const WallSizes walls{diagonal, form == CapForm::any ? capped_area(sewn.shape) : 0};
  std::vector<Cap> caps = form == CapForm::any
                              ? cap_all(sewn, walls, openings)
                              : cap_openings(open_edges(sewn.shape), tolerances::planar_opening * diagonal);
  std::vector<Cap> unnamed;
  for (const Cap& cap : caps) {
    if (is_named(map_of(cap.face, TopAbs_EDGE), sewn, openings)) continue;
    if (is_gap(cap, walls)) return {};
    unnamed.push_back(cap);
  }
  if (!unnamed.empty() && !close_bodies(sewn.shape, unnamed)) return {};
  return caps;
}

}  // namespace aeroloom::cad
