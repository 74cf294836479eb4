#include "pipeline/case/layer_gate.hpp"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

constexpr std::size_t shown_patches = 3, shown_causes = 2;

/// What keeps a column from its layers, in words.
const char* words_for(layers::LayerLimit limit) {
  using layers::LayerLimit;
  switch (limit) {
    case LayerLimit::no_direction:
      return "edges too sharp for a column";
    case LayerLimit::ending:
      return "faces beside them that layers may not end on";
    case LayerLimit::gap:
      return "walls too near opposite";
    case LayerLimit::validity:
      return "cells that would be bad";
    case LayerLimit::slope:
      return "neighbours of another height";
    case LayerLimit::crossing:
      return "layers that would meet others";
    case LayerLimit::none:
      break;
  }
  return "";
}

double lacking_area(const layers::PatchLayers& patch) {
  return patch.area - patch.full_area;
}

/// Beyond what the sums of areas are rounded by.
bool has_lack(const layers::PatchLayers& patch) {
  return lacking_area(patch) > 1e-12 * patch.area;
}

/// The causes with the largest areas, the largest first.
std::string causes_of(const layers::PatchLayers& patch) {
  std::vector<layers::LayerLimit> causes;
  const auto area = [&](layers::LayerLimit limit) {
    return patch.limited_area[static_cast<std::size_t>(limit)];
  };
  for (const layers::LayerLimit limit : layers::all_layer_limits)
    if (limit != layers::LayerLimit::none && area(limit) > 0) causes.push_back(limit);
  std::stable_sort(causes.begin(), causes.end(),
                   [&](layers::LayerLimit a, layers::LayerLimit b) { return area(a) > area(b); });
  std::string text;
  for (std::size_t i = 0; i < std::min(shown_causes, causes.size()); ++i)
    text += (i == 0 ? ", mostly for " : " and ") + std::string(words_for(causes[i]));
  return text;
}

/// The patches that ask for layers and lack some, that with the largest area without first.
std::vector<std::size_t> lacking_patches(const layers::LayerOptions& asked,
                                         const layers::LayerReport& report) {
  std::vector<std::size_t> patches;
  for (std::size_t p = 0; p < report.patches.size(); ++p)
    if (asked.patches.at(p).first > 0 && has_lack(report.patches[p])) patches.push_back(p);
  std::stable_sort(patches.begin(), patches.end(), [&](std::size_t a, std::size_t b) {
    return lacking_area(report.patches[a]) > lacking_area(report.patches[b]);
  });
  return patches;
}

/// Of the area of all patches with layers. What lacks, not what is full, is summed: walls that lack nothing
/// have exactly one.
double full_fraction(const layers::LayerOptions& asked, const layers::LayerReport& report) {
  double area = 0, lacking = 0;
  for (std::size_t p = 0; p < report.patches.size(); ++p) {
    if (asked.patches.at(p).first <= 0) continue;
    area += report.patches[p].area;
    if (has_lack(report.patches[p])) lacking += lacking_area(report.patches[p]);
  }
  return area > 0 ? (area - lacking) / area : 0;
}

}  // namespace

std::vector<GateLimit> compare_with_gate(const LayerGate& gate, const layers::LayerOptions& asked,
                                         const layers::LayerReport& report) {
  if (!gate.full_area) return {};
  return {{"layers.gate.full_area", *gate.full_area, full_fraction(asked, report), false}};
}

std::string missed_limits(const LayerGate& gate, const layers::LayerOptions& asked,
                          const layers::LayerReport& report, const std::vector<std::string>& patches) {
  std::string text;
  for (const GateLimit& limit : compare_with_gate(gate, asked, report)) {
    if (!limit.met())
      text += fmt::format("\n  {} is {:.4g}, not {:g} at least", limit.key, limit.value, limit.limit);
  }
  if (text.empty()) return text;
  const std::vector<std::size_t> lacking = lacking_patches(asked, report);
  for (std::size_t i = 0; i < std::min(shown_patches, lacking.size()); ++i) {
    const layers::PatchLayers& patch = report.patches[lacking[i]];
    text += fmt::format("\n  patch '{}' lacks layers on {:.3g} % of its area, and has none on {:.3g} %{}",
                        patches.at(lacking[i]), 100 * lacking_area(patch) / patch.area,
                        100 * patch.empty_area / patch.area, causes_of(patch));
  }
  if (lacking.size() > shown_patches)
    text += fmt::format("\n  and {} more patches, see layers.patches[] of the report",
                        lacking.size() - shown_patches);
  if (lacking.empty()) text += "\n  no wall asks for layers";
  return "the layers miss what was asked for; the mesh was written nevertheless:" + text +
         "\n  remedy: fewer or lower layers there (layers.patches.NAME with count or total), smaller sizes "
         "in "
         "narrow places, or a lower limit";
}

std::string missing_layers(const layers::LayerOptions& asked, const layers::LayerReport& report,
                           const std::vector<std::string>& patches) {
  std::size_t walls = 0;
  std::vector<std::size_t> bare;
  for (std::size_t p = 0; p < report.patches.size(); ++p) {
    const layers::PatchLayers& patch = report.patches[p];
    if (asked.patches.at(p).first <= 0 || patch.area <= 0) continue;
    ++walls;
    if (patch.most_layers == 0) bare.push_back(p);
  }
  if (walls == 0)
    return "layers are asked for, and no wall is there to have them. Remedy: the type of a patch (patches), "
           "or no 'layers'";
  if (bare.empty()) return {};
  std::stable_sort(bare.begin(), bare.end(), [&](std::size_t a, std::size_t b) {
    return report.patches[a].area > report.patches[b].area;
  });
  std::string names;
  for (std::size_t i = 0; i < std::min(shown_patches, bare.size()); ++i)
    names += fmt::format("{}'{}'", i == 0 ? "" : ", ", patches.at(bare[i]));
  if (bare.size() > shown_patches) names += fmt::format(" and {} more", bare.size() - shown_patches);
  return fmt::format(
      "{} of {} walls that ask for layers have none at all ({}){}. Remedy: fewer or lower "
      "layers there (layers.patches), or smaller sizes",
      bare.size(), walls, names, causes_of(report.patches[bare.front()]));
}

}  // namespace aeroloom::cases
