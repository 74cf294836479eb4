#include "pipeline/domain/trailing_edges.hpp"

#include "cad/domain/trailing_edges.hpp"
#include "cad/model/topology/blunt_edges.hpp"
#include "sizing/field/closed_corners.hpp"
#include "sizing/lifting/trailing_edges.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::domain {

double moved(const JudgedEdge& edge) {
  return 0.5 * edge.widest;
}

const char* name_of(EdgeFate fate) {
  switch (fate) {
    case EdgeFate::closed:
      return "closed";
    case EdgeFate::graded:
      return "graded";
    default:
      return "kept";
  }
}

namespace {

std::string borders_move(const JudgedEdge& edge) {
  return fmt::format("by {:.3g}, at most {:.2g} % of the local chord ({:.3g} where it is shortest)",
                     moved(edge), 50 * edge.share, edge.chord);
}

std::string unresolved(const JudgedEdge& edge) {
  return fmt::format("elements along it would be up to {:.2g} times as long as it is wide", edge.aspect);
}

void grade(JudgedEdge& edge, const std::string& reason) {
  edge.fate = EdgeFate::graded;
  edge.what = fmt::format("trailing edge '{}', {:.4g} long and {:.3g} to {:.3g} wide, is graded: {}, and {}",
                          edge.name, edge.length, edge.narrowest, edge.widest, unresolved(edge), reason);
}

void keep(JudgedEdge& edge) {
  edge.fate = EdgeFate::kept;
  edge.what = fmt::format("trailing edge '{}', {:.4g} long and {:.3g} to {:.3g} wide, is kept", edge.name,
                          edge.length, edge.narrowest, edge.widest);
}

/// Whether nowhere along the strip its borders would move by more than a part of the size there.
bool moves_little(const cad::BluntEdge& strip, const TrialSizes& trial) {
  if (0.5 * strip.widest <= closing_share_of_size * trial.minimum) return true;
  std::vector<geometry::Vec3> places;
  for (const cad::BluntStation& station : strip.stations) places.push_back(station.place);
  const std::vector<double> sizes = trial.sizes_without_strips(places);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (0.5 * strip.stations[i].width > closing_share_of_size * sizes[i]) return false;
  return true;
}

void judge(JudgedEdge& edge, const cad::BluntEdge& strip, const TrialSizes& trial) {
  if (edge.aspect <= largest_kept_aspect) return keep(edge);
  if (0.5 * edge.share > closing_share_of_chord) {
    return grade(edge, fmt::format("closing it would move its borders {}, more than {:g} %",
                                   borders_move(edge), 100 * closing_share_of_chord));
  }
  if (!moves_little(strip, trial)) {
    return grade(edge, fmt::format("closing it would move its borders {}, more than {:g} of the local size",
                                   borders_move(edge), closing_share_of_size));
  }
  edge.fate = EdgeFate::closed;
}

void tell_closed(JudgedEdge& edge, const cad::Change& change) {
  edge.what = fmt::format(
      "{}: {}. Its borders move {}. A blunt end of {:.2g} % of the chord has a base drag of about "
      "{:.1g} drag counts (Hoerner), which the mesh will not show; geometry.trailing_edges: keep leaves it "
      "blunt",
      change.what, unresolved(edge), borders_move(edge), 100 * edge.share, base_drag_counts(edge.share));
}

JudgedEdge* find(TrailingEdgeReport& report, cad::FaceId face) {
  const auto found =
      std::find_if(report.begin(), report.end(), [&](const JudgedEdge& edge) { return edge.face == face; });
  return found == report.end() ? nullptr : &*found;
}

}  // namespace

namespace {

/// Of elements along the strip at its narrowest. One that ends in a point and is nowhere wider than corners
/// are closed by asks for nothing (sizing/field/closed_corners.hpp).
double aspect_along(const cad::BluntEdge& strip, const TrialSizes& trial) {
  if (!(strip.narrowest > 0)) return 1 / closing_share_of_chord;
  const bool is_pointed = strip.ends[0].empty() || strip.ends[1].empty();
  sizing::SizingOptions options;
  options.minimum = trial.minimum;
  if (is_pointed && strip.widest < sizing::closing_gap(options)) return trial.minimum / strip.narrowest;
  return trial.aspect_at(strip.narrowest);
}

}  // namespace

TrailingEdgeReport judge_trailing_edges(const cad::Model& domain,
                                        const std::vector<sizing::TrailingEdge>& edges,
                                        const TrialSizes& trial) {
  TrailingEdgeReport report;
  for (const sizing::TrailingEdge& each : edges) {
    const cad::BluntEdge& strip = each.strip;
    JudgedEdge edge{strip.face,      domain.face(strip.face).name,
                    strip.place,     strip.length,
                    strip.narrowest, strip.widest,
                    each.chord,      each.fraction};
    edge.aspect = aspect_along(strip, trial);
    judge(edge, strip, trial);
    report.push_back(std::move(edge));
  }
  return report;
}

std::optional<cad::Model> close_trailing_edges(const cad::Model& domain,
                                               const std::vector<sizing::TrailingEdge>& edges,
                                               TrailingEdgeReport& report) {
  std::vector<cad::BluntEdge> strips;
  for (const sizing::TrailingEdge& each : edges) {
    if (find(report, each.strip.face)->fate == EdgeFate::closed) strips.push_back(each.strip);
  }
  if (strips.empty()) return std::nullopt;
  cad::ClosedStrips result = cad::close_strips(domain, std::move(strips));
  for (const cad::BluntEdge& strip : result.closed)
    tell_closed(*find(report, strip.face), cad::describe_closed(domain, strip));
  for (const auto& [strip, reason] : result.left)
    grade(*find(report, strip.face), fmt::format("it cannot be closed: {}", reason));
  if (result.closed.empty()) return std::nullopt;
  return std::move(result.model);
}

void judge_again(TrailingEdgeReport& report, const sizing::SizingOptions& sizes) {
  for (JudgedEdge& edge : report) {
    if (edge.fate == EdgeFate::closed || !(edge.narrowest > 0)) continue;
    edge.aspect = sizing::narrow_size(edge.narrowest, sizes) / edge.narrowest;
    if (edge.aspect <= largest_kept_aspect) keep(edge);
  }
}

cad::Model close_again(const cad::Model& domain, const TrailingEdgeReport& report) {
  std::vector<cad::BluntEdge> strips;
  for (const JudgedEdge& edge : report) {
    if (edge.fate == EdgeFate::closed) strips.push_back(cad::examine_blunt_edge(domain, edge.face, 0).edge);
  }
  return strips.empty() ? domain : cad::close_blunt_edges(domain, strips);
}

bool has_closed(const TrailingEdgeReport& report) {
  return std::any_of(report.begin(), report.end(),
                     [](const JudgedEdge& edge) { return edge.fate == EdgeFate::closed; });
}

double base_drag_counts(double width_over_chord) {
  // Hoerner, Fluid-Dynamic Drag, 1965, chapter 3: 0.135 (h/c)^(4/3) / cd^(1/3), with the drag of a clean
  // transonic section and counts of 1e-4.
  constexpr double counts = 1e4, hoerner = 0.135, exponent = 4.0 / 3, section_drag = 0.006;
  return counts * hoerner * std::pow(width_over_chord, exponent) / std::cbrt(section_drag);
}

}  // namespace aeroloom::domain
