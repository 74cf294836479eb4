#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"

#include <utility>

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

std::string solver_measures_table(const Json& solver) {
  Table table({{"measure"},
               {"worst", Align::right},
               {"average", Align::right},
               {"beyond", Align::right, "faces or cells that checkMesh counts"},
               {"of"}});
  table.add({"non-orthogonality", degrees(find(solver, "/non_orthogonality/largest_deg")),
             degrees(find(solver, "/non_orthogonality/average_deg")),
             count(find(solver, "/non_orthogonality/above_70_deg")), "inner faces, above 70°"});
  table.add({"skewness", quantity(find(solver, "/skewness/largest")), "–",
             count(find(solver, "/skewness/above_4")), "faces, above 4"});
  table.add({"aspect ratio", quantity(find(solver, "/aspect_ratio/largest")), "–",
             count(find(solver, "/aspect_ratio/above_1000")), "cells, above 1000"});
  table.add({"determinant", quantity(find(solver, "/determinant/smallest")),
             quantity(find(solver, "/determinant/mean")), count(find(solver, "/determinant/below_0.001")),
             "cells, below 0.001"});
  table.add({"smaller / larger volume", quantity(find(solver, "/volume_ratio/smallest")),
             quantity(find(solver, "/volume_ratio/mean")), "–", "inner faces"});
  return table.html();
}

std::string classes_table(const Json& classes) {
  Table table({{"inner faces"},
               {"faces", Align::right},
               {"average angle", Align::right, "non-orthogonality: the angle of the mean cosine"},
               {"largest angle", Align::right},
               {"above 70°", Align::right},
               {"largest volume ratio", Align::right, "larger over smaller"},
               {"above 10", Align::right},
               {"above 30", Align::right}});
  for (const auto& [key, words] :
       {std::pair("within_layers", "within layers"), std::pair("at_front", "at the front of layers"),
        std::pair("off_layers", "off layers")}) {
    const Json& of = find(classes, fmt::format("/{}", key));
    if (number(find(of, "/faces")) == 0) continue;
    table.add({words, count(find(of, "/faces")), degrees(find(of, "/average_deg")),
               degrees(find(of, "/largest_deg")), count(find(of, "/above_70_deg")),
               quantity(find(of, "/largest_volume_ratio")), count(find(of, "/volume_ratio_above_10")),
               count(find(of, "/volume_ratio_above_30"))});
  }
  return table.empty() ? std::string() : part("Faces by class", table.html());
}

/// The three worst by each measure; report.json has ten.
std::string worst_solver_table(const Json& worst) {
  constexpr std::size_t shown = 3;
  Table table({{"measure"}, {"value", Align::right}, {"shape"}, {"cell", Align::right}, {"at"}});
  for (const auto& [key, words] :
       {std::pair("non_orthogonality", "non-orthogonality, degrees"), std::pair("skewness", "skewness"),
        std::pair("aspect_ratio", "aspect ratio"), std::pair("determinant", "determinant"),
        std::pair("volume_ratio", "smaller / larger volume")}) {
    std::size_t rows = 0;
    for (const Json& place_of : find(worst, fmt::format("/{}", key))) {
      if (++rows > shown) break;
      table.add({words, quantity(find(place_of, "/value")), escaped(text(find(place_of, "/shape"))),
                 count(find(place_of, "/cell")), place(find(place_of, "/center"))});
    }
  }
  return table.empty() ? std::string() : part("Worst faces and cells", table.html());
}

}  // namespace

std::string solver_section(const Json& report) {
  const Json& solver = find(report, "/quality/solver");
  if (!solver.is_object()) return {};
  return section("solver", "As cell-centred solvers judge",
                 paragraph("All cells of all shapes, by the definitions of OpenFOAM's "
                           "<code>checkMesh</code>.") +
                     solver_measures_table(solver) + classes_table(find(solver, "/faces")) +
                     worst_solver_table(find(solver, "/worst")));
}

}  // namespace aeroloom::report::html
