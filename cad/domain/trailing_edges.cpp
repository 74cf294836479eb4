#include "cad/domain/trailing_edges.hpp"

#include "cad/model/patches.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/topology/blunt_edges.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using Kind = BluntEdgeFinding::Kind;

/// Strips wider than this many times the limit are not what the user means: not a word about them. Chosen,
/// not measured.
constexpr double remarkable_excess = 3;

/// Strips that are left, by name at most; the others are counted.
constexpr std::size_t most_named = 20;
/// Faces that are no strips between two others are spoken of where they are this many times longer than wide:
/// those that a user may take for a trailing edge. Chosen, not measured.
constexpr double remarkable_slenderness = 50;

/// Whether the user may have meant the face, though it stays.
bool is_remarkable(const BluntEdgeFinding& found, const TrailingEdgeOptions& options) {
  if (found.kind == Kind::wide) return found.edge.widest <= remarkable_excess * found.limit;
  if (found.kind != Kind::refused) return false;
  return options.width > 0 ? found.edge.widest <= options.width
                           : found.edge.widest * remarkable_slenderness <= found.edge.length;
}

bool is_asked_for(const Model& model, FaceId id, const std::vector<std::string>& patterns) {
  if (patterns.empty()) return true;
  const Face& face = model.face(id);
  return std::ranges::any_of(patterns, [&](const std::string& pattern) {
    return matches_pattern(face.name, pattern) || matches_pattern(model.patches()[face.patch], pattern);
  });
}

void require_matches(const Model& model, const std::vector<std::string>& patterns) {
  for (const std::string& pattern : patterns) {
    bool any = false;
    for (FaceId f = 0; f < model.face_count() && !any; ++f) any = is_asked_for(model, f, {pattern});
    if (any) continue;
    throw CadError(
        fmt::format("TrailingEdgeOptions::faces: no face and no patch of this model is called '{}'. Remedy: "
                    "`aeroloom check` "
                    "lists the patches; * stands for any characters",
                    pattern));
  }
}

Change describe_left(const Model& model, const BluntEdge& strip, const std::string& reason) {
  return {fmt::format("strip '{}', {:.4g} long and about {:.3g} wide, was not closed: {}",
                      model.face(strip.face).name, strip.length, strip.widest, reason),
          strip.place};
}

}  // namespace

ClosedStrips close_strips(const Model& model, std::vector<BluntEdge> strips) {
  const auto attempt = [&](const std::vector<BluntEdge>& some, std::string& reason) -> std::optional<Model> {
    try {
      return close_blunt_edges(model, some);
    } catch (const CadError& error) {
      reason = error.what();
      return std::nullopt;
    }
  };
  std::string reason;
  if (auto closed = attempt(strips, reason)) return {*std::move(closed), std::move(strips), {}};
  ClosedStrips result{model, {}, {}};
  std::ranges::stable_sort(strips,
                           [](const BluntEdge& a, const BluntEdge& b) { return a.length > b.length; });
  for (const BluntEdge& strip : strips) {
    result.closed.push_back(strip);
    if (auto closed = attempt(result.closed, reason)) {
      result.model = *std::move(closed);
      continue;
    }
    result.closed.pop_back();
    result.left.push_back({strip, reason});
  }
  return result;
}

Change describe_closed(const Model& model, const BluntEdge& strip) {
  const auto neighbour = [&](int side) { return model.face(strip.borders[side].front().neighbour).name; };
  return {
      fmt::format("trailing edge '{}', {:.4g} long and at most {:.3g} wide, was closed to a curve half-way "
                  "between '{}' and '{}'",
                  model.face(strip.face).name, strip.length, strip.widest, neighbour(0), neighbour(1)),
      strip.place, 0.5 * strip.widest};
}

Model sharpen_trailing_edges(Model model, const TrailingEdgeOptions& options, Changes& changes) {
  if (options.treatment != TrailingEdges::sharpen) return model;
  report_step("sharpening trailing edges");
  require_matches(model, options.faces);
  std::vector<BluntEdge> strips;
  Changes left;
  int smooth = 0;
  for (FaceId id = 0; id < model.face_count(); ++id) {
    if (!is_asked_for(model, id, options.faces)) continue;
    const BluntEdgeFinding found = examine_blunt_edge(model, id, options.width);
    if (found.kind == Kind::closable) strips.push_back(found.edge);
    if (found.kind == Kind::smooth) ++smooth;
    if (is_remarkable(found, options)) left.push_back(describe_left(model, found.edge, found.reason));
  }
  const std::size_t named = std::min(left.size(), most_named);
  changes.insert(changes.end(), left.begin(), left.begin() + static_cast<std::ptrdiff_t>(named));
  if (named < left.size())
    changes.push_back({fmt::format("{} more strips were not closed", left.size() - named)});
  if (smooth > 0) {
    changes.push_back(
        {fmt::format("{} narrow faces go on smoothly in their neighbours: no trailing edges", smooth)});
  }
  if (strips.empty()) {
    changes.push_back({"no trailing edge was closed"});
    return model;
  }
  ClosedStrips result = close_strips(model, std::move(strips));
  for (const BluntEdge& strip : result.closed) changes.push_back(describe_closed(model, strip));
  for (const auto& [strip, reason] : result.left) changes.push_back(describe_left(model, strip, reason));
  return std::move(result.model);
}

}  // namespace aeroloom::cad
