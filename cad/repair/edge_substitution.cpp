#include "cad/repair/edge_substitution.hpp"

#include "cad/model/model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/repair/shells.hpp"

#include <algorithm>
#include <utility>

#include <BRepTools_WireExplorer.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Wire.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Builds each part anew that holds replaced edges; the others stay as they are.
class Rebuild {
public:
  Rebuild(const Substitution& substitution, FaceLabels& labels) : _what(substitution), _labels(labels) {}

  /// Null where nothing is left.
  TopoDS_Shape run(const TopoDS_Shape& shape) {
    if (shape.ShapeType() == TopAbs_FACE) return face(TopoDS::Face(shape));
    if (shape.ShapeType() > TopAbs_FACE) return shape;
    if (const auto* known = find(shape)) return known->Oriented(shape.Orientation());
    const TopoDS_Shape forward = shape.Oriented(TopAbs_FORWARD);
    TopoDS_Shape copy = forward.EmptyCopied();
    bool changed = false, any = false;
    for (TopoDS_Iterator parts(forward); parts.More(); parts.Next()) {
      const TopoDS_Shape part = run(parts.Value());
      changed = changed || part.IsNull() || !part.IsSame(parts.Value());
      if (part.IsNull()) continue;
      _builder.Add(copy, part);
      any = true;
    }
    if (!any && shape.ShapeType() == TopAbs_SHELL) throw CadError("a shell would vanish");
    if (!changed) copy = forward;
    if (changed && shape.ShapeType() == TopAbs_SHELL && is_closed(TopoDS::Shell(forward))) {
      copy.Closed(true);
      if (!is_closed(TopoDS::Shell(copy))) throw CadError("a closed shell would open");
    }
    remember(shape, copy);
    return copy.Oriented(shape.Orientation());
  }

private:
  const TopoDS_Shape* find(const TopoDS_Shape& shape) const {
    const int at = _done.FindIndex(shape);
    return at > 0 ? &_results[at - 1] : nullptr;
  }
  void remember(const TopoDS_Shape& shape, const TopoDS_Shape& result) {
    _done.Add(shape.Oriented(TopAbs_FORWARD));
    _results.push_back(result);
  }

  TopoDS_Shape face(const TopoDS_Face& shape) {
    if (_what.removed_faces.Contains(shape)) return {};
    if (const auto* known = find(shape)) return known->Oriented(shape.Orientation());
    const TopoDS_Face forward = TopoDS::Face(shape.Oriented(TopAbs_FORWARD));
    const TopTools_IndexedMapOfShape edges = map_of(forward, TopAbs_EDGE);
    const bool touched = std::any_of(edges.cbegin(), edges.cend(),
                                     [&](const TopoDS_Shape& edge) { return _what.edges.Contains(edge); });
    TopoDS_Shape result = touched ? with_new_wires(forward) : TopoDS_Shape(forward);
    remember(shape, result);
    if (touched) copy_label(_labels, shape, result);
    return result.Oriented(shape.Orientation());
  }

  TopoDS_Shape with_new_wires(const TopoDS_Face& face) {
    TopoDS_Shape copy = face.EmptyCopied();
    int wires = 0;
    for (TopoDS_Iterator parts(face); parts.More(); parts.Next()) {
      if (parts.Value().ShapeType() != TopAbs_WIRE) {
        _builder.Add(copy, parts.Value());
        continue;
      }
      const TopoDS_Wire wire = TopoDS::Wire(parts.Value());
      const std::vector<TopoDS_Edge> chain = chain_of(wire, face);
      if (chain.empty()) continue;
      TopoDS_Wire made;
      _builder.MakeWire(made);
      for (const TopoDS_Edge& edge : chain) _builder.Add(made, edge);
      made.Closed(true);
      _builder.Add(copy, made.Oriented(wire.Orientation()));
      ++wires;
    }
    if (wires == 0) {
      throw CadError(fmt::format("face '{}' would vanish", shown_name(_labels, face)));
    }
    return copy;
  }

  /// The edges of a wire oriented forward, in the order in which they follow each other where that is known.
  static std::vector<TopoDS_Edge> in_order(const TopoDS_Wire& wire, const TopoDS_Face& face) {
    const TopoDS_Wire forward = TopoDS::Wire(wire.Oriented(TopAbs_FORWARD));
    std::vector<TopoDS_Edge> stored, walked;
    for (TopoDS_Iterator edges(forward); edges.More(); edges.Next())
      stored.push_back(TopoDS::Edge(edges.Value()));
    for (BRepTools_WireExplorer edges(forward, face); edges.More(); edges.Next())
      walked.push_back(edges.Current());
    return walked.size() == stored.size() ? walked : stored;
  }

  std::vector<TopoDS_Edge> chain_of(const TopoDS_Wire& wire, const TopoDS_Face& face) const {
    std::vector<std::pair<TopoDS_Edge, bool>> chain;  // and whether it took the place of another
    for (const TopoDS_Edge& edge : in_order(wire, face)) {
      const int at = _what.edges.FindIndex(edge);
      if (at == 0) {
        chain.emplace_back(edge, false);
        continue;
      }
      EdgeChain parts = _what.chains[at - 1];
      if (edge.Orientation() == TopAbs_REVERSED) {
        std::reverse(parts.begin(), parts.end());
        for (TopoDS_Edge& part : parts) part.Reverse();
      } else if (edge.Orientation() != TopAbs_FORWARD) {
        for (TopoDS_Edge& part : parts) part.Orientation(edge.Orientation());
      }
      for (const TopoDS_Edge& part : parts) chain.emplace_back(part, true);
    }
    // To and fro along what were the two sides of something.
    const auto cancel = [](const auto& a, const auto& b) {
      return a.second && b.second && a.first.IsSame(b.first) && !a.first.IsEqual(b.first) &&
             !BRep_Tool::Degenerated(a.first);
    };
    for (std::size_t i = 0; chain.size() > 1 && i < chain.size();) {
      const std::size_t next = (i + 1) % chain.size();
      if (!cancel(chain[i], chain[next])) {
        ++i;
        continue;
      }
      chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(std::max(i, next)));
      chain.erase(chain.begin() + static_cast<std::ptrdiff_t>(std::min(i, next)));
      i = 0;
    }
    std::vector<TopoDS_Edge> edges;
    for (const auto& [edge, replaced] : chain) edges.push_back(edge);
    return edges;
  }

  const Substitution& _what;
  FaceLabels& _labels;
  BRep_Builder _builder;
  TopTools_IndexedMapOfShape _done;  // oriented forward
  std::vector<TopoDS_Shape> _results;
};

}  // namespace

TopoDS_Shape substitute(const TopoDS_Shape& shape, const Substitution& substitution, FaceLabels& labels) {
  const TopoDS_Shape result = Rebuild(substitution, labels).run(shape);
  if (result.IsNull()) throw CadError("nothing would be left");
  return result;
}

}  // namespace aeroloom::cad
