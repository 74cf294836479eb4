#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

std::string_view words_for(std::string_view limit) {
  if (limit == "gap") return "walls opposite";
  if (limit == "validity") return "bad cells";
  if (limit == "slope") return "lower neighbours";
  if (limit == "crossing") return "layers of another side";
  if (limit == "ending") return "faces that layers may not end on";
  if (limit == "no_direction") return "edges without a direction";
  return limit;
}

/// The limits, the widest first, as parts of the area.
std::string limits_text(const Json& limited) {
  std::vector<std::pair<double, std::string>> limits;
  for (const auto& [key, part] : limited.items()) limits.emplace_back(number(part), escaped(words_for(key)));
  std::stable_sort(limits.begin(), limits.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string words;
  for (const auto& [part, name] : limits)
    words += fmt::format("{}{} {}", words.empty() ? "" : ", ", percent(part), name);
  return words.empty() ? "–" : words;
}

/// With the side of inner faces that has layers.
std::string name_and_side(const Json& patch) {
  const Json& side = find(patch, "/side");
  std::string words = name(find(patch, "/name"));
  if (!side.is_string() || side == "none") return words;
  return fmt::format("{} ({})", words, side == "both" ? "both sides" : escaped(side.get<std::string>()));
}

std::string asked_end(const Json& patch) {
  std::string words;
  if (!find(patch, "/count").is_null()) words = fmt::format("{} layers", count(find(patch, "/count")));
  if (!find(patch, "/total").is_null())
    words += fmt::format("{}{} high", words.empty() ? "" : ", ", quantity(find(patch, "/total")));
  return words.empty() ? "isotropic" : words;
}

std::string heights_table(const Json& patches, const Json& boundary_layer) {
  Table table(
      {{"patch"},
       {"first", Align::right, "height of the first layer asked for, along the normal"},
       {"growth", Align::right},
       {"end", Align::left, "what the layers are to end at"},
       {"layers", Align::right, "mean over the area, and the number asked for"},
       {"most", Align::right},
       {"height", Align::right, "of all layers together, mean over the area"},
       {"over boundary layer", Align::right, "height over the boundary layer of a flat plate"},
       {"last / edge", Align::right, "last layer over the edges of the wall there; 0.7 is aimed at"}});
  for (const Json& patch : patches) {
    const Json& height = find(patch, "/height_mean");
    const double thickness = number(boundary_layer);
    table.add({name_and_side(patch), quantity(find(patch, "/first")), quantity(find(patch, "/growth")),
               asked_end(patch),
               fmt::format("{:.1f} of {:.1f}", number(find(patch, "/layers_mean")),
                           number(find(patch, "/layers_wanted_mean"))),
               count(find(patch, "/layers_max")), quantity(height),
               thickness > 0 ? ratio(number(height) / thickness) : "–", ratio(find(patch, "/last_mean"))});
  }
  return table.html();
}

std::string coverage_table(const Json& patches) {
  Table table({{"patch"},
               {"all layers", Align::right, "all that were asked for, or up to a smooth step"},
               {"fewer", Align::right},
               {"none", Align::right},
               {"first is low", Align::right, "below 0.8 of what is asked for, where columns lean"},
               {"what took layers away", Align::left, "as parts of the area"}});
  for (const Json& patch : patches) {
    table.add({name_and_side(patch), percent(number(find(patch, "/full"))),
               percent(number(find(patch, "/partial"))), percent(number(find(patch, "/empty"))),
               percent(number(find(patch, "/low_first"))), limits_text(find(patch, "/limited"))});
  }
  return part("How much of the walls", table.html());
}

}  // namespace

std::string layers_section(const Json& report) {
  const Json& layers = find(report, "/layers");
  const Json& patches = find(layers, "/patches");
  if (!patches.is_array() || patches.empty()) return {};
  const Json& boundary_layer = find(layers, "/boundary_layer");
  std::string words =
      fmt::format("{} of the walls have all layers asked for, {} none.",
                  percent(number(find(layers, "/full"))), percent(number(find(layers, "/empty"))));
  if (!boundary_layer.is_null())
    words += fmt::format(" The boundary layer of a flat plate at the case's Reynolds number is {} thick.",
                         quantity(boundary_layer));
  return section("layers", "Boundary layers",
                 paragraph(words) + heights_table(patches, boundary_layer) + coverage_table(patches));
}

}  // namespace aeroloom::report::html
