#include "cad/repair/half_shells.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/repair/border_chains.hpp"
#include "cad/repair/filled_loops.hpp"
#include "cad/repair/half_cut.hpp"
#include "cad/repair/narrow_loops.hpp"
#include "cad/repair/plane_loops.hpp"
#include "cad/repair/sewing.hpp"
#include "cad/repair/shells.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <BOPTools_AlgoTools.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Vertex.hxx>
#include <fmt/format.h>
#include <gp_Dir.hxx>

namespace aeroloom::cad {
namespace {

double length_along(const TopoDS_Edge& edge) {
  return GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
}

double surface_area(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return std::abs(properties.Mass());
}

std::string name_of(const AxisPlane& plane) {
  return fmt::format("{} = {:.6g}", "xyz"[plane.axis], in_file(plane.position));
}

/// Length of the edges nearer to a plane than `reach`.
double length_on(const AxisPlane& plane, const std::vector<TopoDS_Edge>& edges, double reach) {
  double length = 0;
  for (const TopoDS_Edge& edge : edges)
    if (distance_from(plane, edge) <= reach) length += length_along(edge);
  return length;
}

/// Closes one shape at one plane, step by step.
class HalfCloser {
public:
  HalfCloser(const TopoDS_Shape& open, const FaceLabels& labels, const HalfPlane& half) {
    BRepBuilderAPI_Copy copy(open);
    _shape = copy.Shape();
    for (const TopoDS_Shape& face : shapes_in(map_of(open, TopAbs_FACE))) {
      if (!labels.IsBound(face)) continue;
      for (TopExp_Explorer image(copy.ModifiedShape(face), TopAbs_FACE); image.More(); image.Next())
        _half.labels.Bind(image.Current(), labels.Find(face));
    }
    _box = tight_box(_shape);
    _reach = tolerances::on_symmetry * _box.diagonal();
    _openings = half.openings;
    choose_plane(half);
  }

  ClosedHalf close() {
    if (!_half.fault.empty() || !cut()) return std::move(_half);
    put_border_on_plane();
    if (fill_beside_plane() && close_on_plane()) make_shells();
    return std::move(_half);
  }

private:
  bool fail(std::string fault) {
    _half.fault = std::move(fault);
    return false;
  }

  void choose_plane(const HalfPlane& half) {
    if (const auto plane = plane_along(open_edges(_shape), _box, half)) {
      _half.plane = *plane;
      return;
    }
    if (half.axis) {
      _half.plane = {*half.axis, half.position.value_or(0)};
      const double position = _half.plane.position;
      if (_box.low[*half.axis] < position && position < _box.high[*half.axis]) return;
    }
    fail(fmt::format("no open edge is nearer than {:.3g} ({:.0e} of the diagonal) to the plane of symmetry{}",
                     in_file(_reach), tolerances::on_symmetry,
                     half.position ? " " + name_of(_half.plane) : ""));
  }

  bool is_positive() const {
    const double above = _box.high[_half.plane.axis] - _half.plane.position,
                 below = _half.plane.position - _box.low[_half.plane.axis];
    return above > std::min(_reach, below);
  }

  /// Cuts off what lies beyond the plane.
  bool cut() {
    const int axis = _half.plane.axis;
    const bool positive = is_positive();
    const double beyond =
        positive ? _half.plane.position - _box.low[axis] : _box.high[axis] - _half.plane.position;
    if (beyond <= _reach) return true;
    const std::optional<HalfCut> cut = cut_open_half(_shape, {_half.plane, positive, _reach}, _half.labels);
    if (!cut)
      return fail(
          fmt::format("it reaches {:.3g} beyond the plane of symmetry {}, and the CAD library does not "
                      "cut it there",
                      in_file(beyond), name_of(_half.plane)));
    _shape = cut->shape;
    _box = tight_box(_shape);
    Vec3 at = _box.center();
    at[axis] = _half.plane.position;
    _half.changes.push_back(
        {fmt::format("an open half reached {:.4g} beyond its plane of symmetry {}: cut there",
                     in_file(beyond), name_of(_half.plane)),
         at, std::abs(cut->aside)});
    return true;
  }

  void put_border_on_plane() {
    std::vector<TopoDS_Edge> near;
    for (const TopoDS_Edge& edge : open_edges(_shape))
      (distance_from(_half.plane, edge) <= _reach ? near : _beside).push_back(edge);
    const PutOnPlane put = put_on_plane(near, _half.plane);
    BRep_Builder builder;
    for (const TopoDS_Edge& edge : near)
      for (const TopoDS_Vertex& vertex : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)})
        _feet.Add(vertex);
    for (const TopoDS_Edge& edge : _beside) {
      for (const TopoDS_Vertex& vertex : {TopExp::FirstVertex(edge), TopExp::LastVertex(edge)}) {
        const gp_Pnt at = BRep_Tool::Pnt(vertex);
        const double height = std::abs(_half.plane.height(at));
        if (height > _reach) continue;
        if (height > 0)
          builder.UpdateVertex(vertex, _half.plane.foot(at), BRep_Tool::Tolerance(vertex) + height);
        _feet.Add(vertex);
      }
    }
    if (put.most <= tolerances::same_place * _box.diagonal()) return;
    _half.changes.push_back(
        {fmt::format("{} open edges put on the plane of symmetry {} (edges nearer than "
                     "{:.3g}, {:.0e} of the diagonal, are)",
                     put.edges, name_of(_half.plane), in_file(_reach), tolerances::on_symmetry),
         put.where, put.most});
  }

  std::vector<std::string> names_along(const BorderChain& chain) const {
    TopTools_IndexedMapOfShape edges;
    for (const TopoDS_Edge& edge : chain.edges) edges.Add(edge);
    std::vector<std::string> names;
    for (TopExp_Explorer faces(_shape, TopAbs_FACE); faces.More(); faces.Next()) {
      for (TopExp_Explorer each(faces.Current(), TopAbs_EDGE); each.More(); each.Next()) {
        const std::string name = shown_name(_half.labels, faces.Current());
        if (edges.Contains(each.Current()) && !name.empty() && std::ranges::find(names, name) == names.end())
          names.push_back(name);
      }
    }
    return names;
  }

  /// Whether the rules name a chain, which may be wide then.
  bool is_named(const BorderChain& chain) const {
    if (_openings == nullptr) return false;
    Box box;
    for (const TopoDS_Edge& edge : chain.edges) box.add(tight_box(edge));
    return _openings->take(names_along(chain), box);
  }

  /// Names of the faces along a chain, with the length of the chain.
  std::string describe_chain(const BorderChain& chain, double length) const {
    return fmt::format("an opening of {} edges, {:.4g} long, of '{}'", chain.edges.size(), in_file(length),
                       fmt::join(names_along(chain), "', '"));
  }

  void add_cap(const TopoDS_Face& face) {
    FaceLabel label;
    label.name = fmt::format("cap_{}", ++_cap_count);
    label.cap = true;
    _half.labels.Bind(face, label);
    _added.push_back(face);
  }

  bool fill_beside_plane() {
    Vec3 branch;
    const auto chains = find_chains(_beside, _feet, branch);
    if (!chains) return fail(fmt::format("open edges branch at {}", place_in_file(branch)));
    if (_openings != nullptr && _openings->refuse() && !chains->empty())
      return fail("DomainOptions::close refuses to close openings beside the plane");
    _walls = surface_area(_shape);
    for (const BorderChain& chain : *chains)
      if (!(chain.on_plane ? fill_down(chain) : cap_loop(chain))) return false;
    return true;
  }

  bool fill_down(const BorderChain& chain) {
    const bool named = is_named(chain);
    const FillLimits limits{_reach, tolerances::planar_opening * _box.diagonal(),
                            (named ? 1 : tolerances::widest_ruled) * _box.diagonal()};
    const ChainFilling filling = fill_to_plane(chain, _half.plane, limits);
    double area = 0;
    for (const TopoDS_Face& face : filling.faces) area += surface_area(face);
    const std::string text = describe_chain(chain, filling.length);
    const bool is_wide = filling.is_wide || (filling.faces.size() > 1 && filling.width > limits.widest);
    if (is_wide || filling.faces.empty() || (!named && area > tolerances::widest_filling * _walls)) {
      if (span(chain, text, named)) return true;
      return fail(
          fmt::format("{}, which leaves the plane of symmetry {} by up to {:.4g} at {}, is too wide to be "
                      "closed",
                      text, name_of(_half.plane), in_file(filling.width), place_in_file(filling.where)));
    }
    for (const TopoDS_Face& face : filling.faces) add_cap(face);
    _half.changes.push_back(
        {fmt::format("{}, up to {:.4g} beside the plane of symmetry {}: closed down to the "
                     "plane by {} face(s) of area {:.4g}",
                     text, in_file(filling.width), name_of(_half.plane), filling.faces.size(),
                     in_file(area, 2)),
         filling.where});
    return true;
  }

  /// Closes a narrow chain by one face, as a blunt trailing edge that ends at the plane.
  bool span(const BorderChain& chain, const std::string& text, bool named) {
    std::vector<TopoDS_Edge> loop = chain.edges;
    const TopoDS_Vertex begin = TopExp::FirstVertex(loop.front(), true),
                        end = TopExp::LastVertex(loop.back(), true);
    if (!begin.IsSame(end)) {
      BRepBuilderAPI_MakeEdge chord(end, begin);
      if (!chord.IsDone()) return false;
      loop.push_back(chord.Edge());
    }
    const std::vector<Cap> caps = span_narrow_loop(
        loop, {tolerances::planar_opening * _box.diagonal(), tolerances::widest_ruled * _box.diagonal()});
    for (const Cap& each : caps) add_filling(each, text, "a narrow");
    if (!caps.empty()) return true;
    const std::optional<Cap> cap = fill_narrow_loop(loop, {_box.diagonal(), _walls}, named);
    return cap && add_filling(*cap, text, "an uneven");
  }

  bool add_filling(const Cap& cap, const std::string& text, const char* form) {
    add_cap(cap.face);
    _half.changes.push_back(
        {fmt::format("{}: closed by {} face of area {:.4g}", text, form, in_file(cap.area, 2)), cap.center,
         cap.deviation});
    return true;
  }

  bool cap_loop(const BorderChain& chain) {
    const std::vector<Cap> caps = cap_openings(chain.edges, tolerances::planar_opening * _box.diagonal());
    const bool named = is_named(chain);
    double length = 0;
    for (const TopoDS_Edge& edge : chain.edges) length += length_along(edge);
    const std::string text = describe_chain(chain, length);
    if (caps.size() == 1 && (caps.front().area <= tolerances::widest_filling * _walls || named))
      return add_filling(caps.front(), text, "a planar");
    if (span(chain, text, named)) return true;
    const gp_Pnt place = BRep_Tool::Pnt(TopExp::FirstVertex(chain.edges.front()));
    return fail(
        fmt::format("{}, at {}, is no small or narrow one and does not lead to the plane of symmetry {}",
                    text, place_in_file(to_vec(place)), name_of(_half.plane)));
  }

  TopoDS_Compound everything() const {
    TopoDS_Compound all;
    BRep_Builder builder;
    builder.MakeCompound(all);
    for (const TopoDS_Shape& face : shapes_in(map_of(_shape, TopAbs_FACE))) builder.Add(all, face);
    for (const TopoDS_Face& face : _added) builder.Add(all, face);
    return all;
  }

  bool close_on_plane() {
    const std::vector<TopoDS_Edge> border = open_edges(everything());
    const double tolerance = tolerances::same_place * _box.diagonal();
    gp_XYZ normal(0, 0, 0), origin(0, 0, 0);
    normal.SetCoord(_half.plane.axis + 1, is_positive() ? -1 : 1);
    origin.SetCoord(_half.plane.axis + 1, _half.plane.position);
    const auto loops = find_plane_loops(border, tolerance, gp_Pln(origin, gp_Dir(normal)));
    if (!loops || loops->empty()) {
      return fail(fmt::format("its {} open edges on the plane of symmetry {} form no simple closed loops",
                              border.size(), name_of(_half.plane)));
    }
    double area = 0, length = 0;
    for (std::size_t i = 0; i < loops->size(); ++i) {
      if ((*loops)[i].depth % 2 == 0) add_cap(make_plane_face(*loops, i));
      area += ((*loops)[i].depth % 2 == 0 ? 1 : -1) * (*loops)[i].area;
    }
    for (const TopoDS_Edge& edge : border) length += length_along(edge);
    _half.changes.push_back(
        {fmt::format("an open half of {} loop(s), {:.4g} long and of area {:.4g}, closed by "
                     "its plane of symmetry {}",
                     loops->size(), in_file(length), in_file(area, 2), name_of(_half.plane))});
    return true;
  }

  void make_shells() {
    TopTools_ListOfShape pieces;
    BOPTools_AlgoTools::MakeConnexityBlocks(everything(), TopAbs_EDGE, TopAbs_FACE, pieces);
    BRep_Builder builder;
    for (const TopoDS_Shape& piece : pieces) {
      TopoDS_Shape shell;
      TopoDS_Shell empty;
      builder.MakeShell(empty);
      shell = empty;
      for (TopExp_Explorer faces(piece, TopAbs_FACE); faces.More(); faces.Next())
        builder.Add(shell, faces.Current());
      BOPTools_AlgoTools::OrientFacesOnShell(shell);
      shell.Closed(is_closed(TopoDS::Shell(shell)));
      if (!shell.Closed()) {
        _half.shells.clear();
        fail(fmt::format("faces around {} stay open", place_in_file(tight_box(shell).center())));
        return;
      }
      _half.shells.push_back(TopoDS::Shell(shell));
    }
  }

  ClosedHalf _half;
  TopoDS_Shape _shape;
  Box _box;
  double _reach = 0, _walls = 0;     ///< area of the walls
  std::vector<TopoDS_Edge> _beside;  ///< open edges that are not on the plane
  TopTools_IndexedMapOfShape _feet;  ///< vertices on the plane
  std::vector<TopoDS_Face> _added;
  int _cap_count = 0;
  OpeningRules* _openings = nullptr;
};

}  // namespace

ClosedHalf close_half(const TopoDS_Shape& open, const FaceLabels& labels, const HalfPlane& half) {
  report_step("closing an open half at its plane of symmetry");
  return HalfCloser(open, labels, half).close();
}

std::optional<AxisPlane> plane_along(const std::vector<TopoDS_Edge>& open, const Box& box,
                                     const HalfPlane& half) {
  const double reach = tolerances::on_symmetry * box.diagonal();
  std::optional<AxisPlane> best;
  double most = 0;
  for (const int axis : half.axis ? std::vector{*half.axis} : std::vector{0, 1, 2}) {
    std::vector<double> positions{half.position.value_or(0)};
    const double low = box.low[axis], high = box.high[axis];
    // A body that reaches across 0 by little is to end there.
    const bool is_across =
        low < -reach && high > reach && std::min(-low, high) <= tolerances::widest_ruled * box.diagonal();
    if (half.axis && !half.position && !is_across) positions.insert(positions.end(), {low, high});
    for (const double position : positions) {
      const AxisPlane plane{axis, position};
      const double length = length_on(plane, open, reach);
      if (length > most) most = length, best = plane;
    }
  }
  return best;
}

std::optional<AxisPlane> plane_of_openings(const std::vector<TopoDS_Edge>& open, double diagonal) {
  double all = 0;
  for (const TopoDS_Edge& edge : open) all += length_along(edge);
  std::optional<AxisPlane> best;
  double most = 0.5 * all;
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, 3> coordinates = {0, 0, 0};
    if (!open.empty()) {
      const gp_Pnt at = BRep_Tool::Pnt(TopExp::FirstVertex(open.front()));
      coordinates[1] = at.Coord(axis + 1);
    }
    for (const double position : coordinates) {
      const AxisPlane plane{axis, position};
      const double length = length_on(plane, open, tolerances::on_symmetry * diagonal);
      if (length > most) most = length, best = plane;
    }
  }
  return best;
}

}  // namespace aeroloom::cad
