#include "pipeline/report/mixed_quality_text.hpp"

#include "pipeline/report/places_json.hpp"
#include "pipeline/report/solver_quality_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

using mesh::CellShape;
using mesh::Measure;

constexpr std::array<std::string_view, mesh::measure_count> titles = {
    "smallest dihedral angle", "largest dihedral angle",      "mean ratio", "radius ratio", "scaled Jacobian",
    "longest / shortest edge", "volume ratio to a neighbour", "volume"};
constexpr std::size_t most_bars = 15;  // lines and characters of a terminal
constexpr int longest_bar = 60;
/// Patches shown; `--json` has all.
constexpr std::size_t shown_patches = 30;

std::string_view title_of(Measure measure) {
  return titles[static_cast<std::size_t>(measure)];
}

std::string tables_of_names(const io::FileMesh& mesh, const mesh::MixedQuality& quality) {
  std::string text = fmt::format("\n{:<32} {:>13} {:>13} {:>13} {:>13} {:>14}\n", "region", "tetrahedra",
                                 "pyramids", "prisms", "hexahedra", "volume");
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    const auto& cells = mesh.region_cells[r];
    text += fmt::format("{:<32} {:>13} {:>13} {:>13} {:>13} {:>14.7g}\n", mesh.regions[r], cells[0], cells[1],
                        cells[2], cells[3], quality.region_volumes[r]);
  }
  text +=
      fmt::format("\n{:<32} {:>13} {:>13} {:>13} {:>14}\n", "patch", "type", "triangles", "quads", "area");
  // "And 1 more" would be no shorter than the one.
  const std::size_t all = mesh.patches.size(), shown = all <= shown_patches + 1 ? all : shown_patches;
  for (std::size_t p = 0; p < shown; ++p) {
    text += fmt::format("{:<32} {:>13} {:>13} {:>13} {:>14.7g}\n", mesh.patches[p].name,
                        name_of(mesh.patches[p].type), mesh.patch_faces[p][0], mesh.patch_faces[p][1],
                        quality.patch_areas[p]);
  }
  if (all > shown) text += fmt::format("and {} more: --json has all\n", all - shown);
  return text;
}

std::string table_of_shape(CellShape shape, const mesh::MixedQuality& quality) {
  std::string text = fmt::format("\n{:<27}{:>10}", mesh::name_of(shape), "min");
  for (const int per_mille : mesh::percentiles_per_mille)
    text += fmt::format("{:>10}", fmt::format("{:g} %", per_mille / 10.0));
  text += fmt::format("{:>10}{:>10}\n", "max", "mean");
  for (const Measure measure : mesh::all_measures) {
    const mesh::MeasureDistribution& of = quality.distribution(shape, measure);
    if (of.cells == 0) continue;
    text += fmt::format("{:<27}{:>10.4g}", title_of(measure), of.minimum);
    for (const double value : of.percentiles) text += fmt::format("{:>10.4g}", value);
    text += fmt::format("{:>10.4g}{:>10.4g}\n", of.maximum, of.mean);
  }
  return text;
}

/// Bars over the bins that are not empty, several bins to a bar where there are many.
std::string histogram_text(CellShape shape, Measure measure, const mesh::MeasureDistribution& of) {
  const std::vector<std::int64_t>& counts = of.histogram.counts;
  std::size_t begin = 0, end = counts.size();
  while (begin < end && counts[begin] == 0) ++begin;
  while (begin < end && counts[end - 1] == 0) --end;
  const std::size_t width = (end - begin + most_bars - 1) / most_bars;
  begin -= begin % width;
  std::vector<std::int64_t> bars;
  for (std::size_t b = begin; b < end; ++b) {
    if ((b - begin) % width == 0) bars.push_back(0);
    bars.back() += counts[b];
  }
  const std::int64_t most = *std::max_element(bars.begin(), bars.end());
  std::string text = fmt::format("\n{} of {}\n", title_of(measure), mesh::name_of(shape));
  for (std::size_t b = 0; b < bars.size(); ++b) {
    const double fraction = static_cast<double>(bars[b]) / static_cast<double>(most);
    const int length = bars[b] == 0 ? 0 : std::max(1, static_cast<int>(std::lround(fraction * longest_bar)));
    const std::size_t first = begin + b * width, after = std::min(first + width, counts.size());
    text +=
        fmt::format("{:>10.4g} .. {:<10.4g}{:>13} {}\n", of.histogram.edge(first), of.histogram.edge(after),
                    bars[b], std::string(static_cast<std::size_t>(length), '#'));
  }
  return text;
}

std::string places_text(const mesh::MixedQuality& quality) {
  std::string text = "\nworst places, of all cells\n";
  for (const mesh::FlawedCell& place : quality.places.all)
    text += fmt::format("{:<5} {}\n", mesh::name_of(mesh::verdict_of(place.severity)), text_of_place(place));
  return text;
}

std::string worst_text(const mesh::MixedQuality& quality) {
  std::string text = places_text(quality) + "\nworst cells, with their middles\n";
  for (const Measure measure : mesh::all_measures) {
    const auto& worst = quality.worst[static_cast<std::size_t>(measure)];
    if (worst.empty()) continue;
    text += fmt::format("{}\n", title_of(measure));
    text += list_of_worst(worst);
  }
  return text;
}

std::string defects_text(const mesh::LinkDefects& defects) {
  std::string text;
  const auto add = [&](mesh::GlobalIndex count, std::string_view what) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(defects.crowded_faces, "faces of more than two cells");
  add(defects.open_faces, "faces of one cell without a boundary face");
  add(defects.stray_faces, "boundary faces beside all cells");
  add(defects.repeated_faces, "boundary faces that come twice");
  return text.empty() ? "none" : text;
}

}  // namespace

std::string quality_text(const io::FileMesh& mesh, const mesh::MixedQuality& quality,
                         const mesh::SolverQuality& solver) {
  std::string text = fmt::format("{} points, {} cells, volume {:.9g}; defects: {}\n", mesh.vertex_count,
                                 mesh.cell_count(), quality.volume, defects_text(quality.defects));
  text += solver_text(solver) + tables_of_names(mesh, quality);
  for (const CellShape shape : mesh::cell_shapes) {
    if (mesh.cell_count(shape) > 0) text += table_of_shape(shape, quality);
  }
  for (const CellShape shape : mesh::cell_shapes) {
    for (const Measure measure : mesh::all_measures) {
      const mesh::MeasureDistribution& of = quality.distribution(shape, measure);
      if (of.cells > 0) text += histogram_text(shape, measure, of);
    }
  }
  return text + worst_text(quality) + worst_text(solver);
}

}  // namespace aeroloom::report
