#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"
#include "pipeline/report/page/svg.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

/// Judgements of a smallest dihedral angle for a flow solver: rules of thumb for isotropic tetrahedra.
struct Judgement {
  double from;  ///< degrees
  const char* kind;
  const char* words;
};
constexpr std::array judgements = {
    Judgement{15, "good", "no thin elements: gradients and fluxes are as accurate as the sizes allow"},
    Judgement{5, "fair",
              "a few thin elements: finite-volume solvers run, with less accurate gradients there; implicit "
              "ones may "
              "need some more iterations"},
    Judgement{
        1, "fair",
        "slivers at some places: start with first order or a small CFL number, and look at the places below"},
    Judgement{0, "poor",
              "nearly flat elements: many solvers lose accuracy there or diverge; see the places below "
              "before using "
              "this mesh"}};

std::string judgement_of(const Json& report) {
  const Json& smallest = find(report, "/quality/min_dihedral_deg");
  for (const Judgement& j : judgements) {
    if (number(smallest) < j.from) continue;
    return fmt::format("<li>{} Smallest dihedral angle {}: {}.</li>\n", badge(j.kind, j.kind),
                       degrees(smallest), j.words);
  }
  return {};
}

/// Long thin elements have good angles and a small mean ratio. From here on a ratio is good: a regular
/// tetrahedron drawn out to five times its length; and fair, or else nearly flat. Chosen, not measured.
constexpr double good_ratio = 0.3, fair_ratio = 0.02;

std::string judgement_of_shape(const Json& report) {
  const Json& least = find(report, "/quality/min_mean_ratio");
  const Json& mean = find(report, "/quality/mean_mean_ratio");
  const char* kind = number(least) >= good_ratio ? "good" : number(least) >= fair_ratio ? "fair" : "poor";
  const std::string worst = number(least) >= good_ratio ? "" : ": the worst are stretched or flat";
  return fmt::format(
      "<li>{} Mean ratio {} on average and {} at least{}. Of a regular tetrahedron it is 1.</li>\n",
      badge(kind, kind), ratio(mean), ratio(least), worst);
}

/// What was looked for in cells of layers, in neighbours and in faces.
std::string judgement_of_flaws(const Json& report) {
  std::string items;
  for (const Json& flaw : find(report, "/quality/flaws")) {
    const std::string kind = text(find(flaw, "/flaw")), verdict = escaped(text(find(flaw, "/verdict")));
    const std::string at = escaped(text(find(flaw, "/shape"))) + ", at " + place(find(flaw, "/center"));
    if (kind == "shape")
      items += fmt::format(
          "<li>{} Cells of layers: shape {} at least ({}). Flat along the wall is no flaw; 1 is straight, 0 "
          "twisted or without volume.</li>\n",
          badge(verdict, verdict), quantity(find(flaw, "/value")), at);
    if (kind == "size_jump")
      items += fmt::format("<li>{} Neighbours of a cell are up to {} times as large ({}).</li>\n",
                           badge(verdict, verdict), quantity(find(flaw, "/value")), at);
    if (kind == "non_orthogonality")
      items += fmt::format("<li>{} Faces between cells: non-orthogonality {} at most ({}).</li>\n",
                           badge(verdict, verdict), degrees(find(flaw, "/value")), at);
    if (kind == "skewness")
      items += fmt::format("<li>{} Faces: skewness {} at most ({}).</li>\n", badge(verdict, verdict),
                           quantity(find(flaw, "/value")), at);
  }
  return items;
}

std::string below_target(const Json& report) {
  const auto tetrahedra = [&](const char* kind) {
    return number(find(report, fmt::format("/improve/below_target/{}/tetrahedra", kind)));
  };
  const double pinned = tetrahedra("pinned"), features = tetrahedra("unresolved_features"),
               held = tetrahedra("held_by_surface"), beside = tetrahedra("beside"), rest = tetrahedra("rest");
  const double all = pinned + features + held + beside + rest;
  const std::string target = degrees(find(report, "/improve/target_angle_deg"));
  if (find(report, "/improve/enabled") != Json(true))
    return "<li>" + badge("plain", "target") +
           " Improvement was switched off (<code>improve.enabled</code>).</li>\n";
  if (all == 0)
    return fmt::format(
        "<li>{} Every tetrahedron reaches the target of {} (<code>improve.target_angle</code>).</li>\n",
        badge("good", "target"), target);
  std::string text =
      fmt::format("<li>{} {} below the target of {}:", badge(rest > 0 ? "fair" : "good", "target"),
                  counted(all, "tetrahedron is", "tetrahedra are"), target);
  if (pinned > 0) text += fmt::format(" {} forced by sharp angles of the CAD;", count(pinned));
  if (features > 0)
    text += fmt::format(" {} at narrow regions or gaps finer than the elements;", count(features));
  if (held > 0)
    text += fmt::format(" {} on a surface or on layers that were to stay as they are;", count(held));
  if (beside > 0) text += fmt::format(" {} beside such ones;", count(beside));
  text += rest > 0 ? fmt::format(" {} that no sharp angle, strip or gap of the CAD explains.", count(rest))
                   : " all that are left are explained.";
  return text + "</li>\n";
}

std::string gate_table(const Json& gate) {
  Table table({{"limit"}, {"asked for", Align::right}, {"mesh has", Align::right}, {"verdict"}});
  for (const Json& row : gate) {
    const bool met = find(row, "/met") == Json(true);
    table.add({"<code>" + escaped(text(find(row, "/key"))) + "</code>",
               escaped(text(find(row, "/side"))) + " " + quantity(find(row, "/limit")),
               quantity(find(row, "/value")), badge(met ? "good" : "poor", met ? "met" : "missed")});
  }
  return table.html();
}

std::string gate_sentence(const Json& gate, bool written) {
  if (!gate.is_array() || gate.empty())
    return "<li>" + badge("plain", "gate") +
           " The case sets no limits (<code>improve.gate</code>, <code>layers.gate</code>), so none is "
           "missed.</li>\n";
  std::size_t missed = 0;
  for (const Json& row : gate) missed += find(row, "/met") == Json(true) ? 0 : 1;
  if (missed == 0)
    return fmt::format("<li>{} {} met.</li>\n", badge("good", "gate passed"),
                       gate.size() == 1 ? "The one limit is" : fmt::format("All {} limits are", gate.size()));
  return fmt::format("<li>{} {} of {} missed{}.</li>\n", badge("poor", "gate failed"), missed,
                     counted(gate.size(), "limit"), written ? "; the mesh was written nevertheless" : "");
}

/// Limits and targets that belong into the chart of a measure.
std::vector<Mark> marks_for(const Json& report, const std::string& key, double target, double worst,
                            const std::string& unit) {
  std::vector<Mark> marks = {{worst, fmt::format("worst {:.3g}{}", worst, unit), false}};
  if (target > 0) marks.push_back({target, fmt::format("target {:.3g}{}", target, unit), false});
  for (const Json& row : find(report, "/quality/gate")) {
    if (text(find(row, "/key")) == "improve.gate." + key) {
      const double limit = number(find(row, "/limit"));
      marks.push_back({limit, fmt::format("limit {:.3g}{}", limit, unit), true});
    }
  }
  return marks;
}

std::string charts(const Json& report) {
  const double target = number(find(report, "/improve/target_angle_deg"));
  const auto value = [&](const char* path) { return number(find(report, path)); };
  std::string all;
  all += histogram_chart(
      find(report, "/quality/min_dihedral/histogram"),
      {"Smallest dihedral angle of each tetrahedron", "°", 10, 0, 72, true,
       marks_for(report, "smallest_angle", target, value("/quality/min_dihedral/minimum"), "°")});
  all += histogram_chart(
      find(report, "/quality/max_dihedral/histogram"),
      {"Largest dihedral angle of each tetrahedron", "°", 20, 70, 180, false,
       marks_for(report, "largest_angle", 180 - 1.5 * target, value("/quality/max_dihedral/maximum"), "°")});
  all += histogram_chart(find(report, "/quality/mean_ratio/histogram"),
                         {"Mean ratio", "", 0.2, 0, 1, true,
                          marks_for(report, "min_mean_ratio", 0, value("/quality/mean_ratio/minimum"), "")});
  all += histogram_chart(find(report, "/quality/radius_ratio/histogram"),
                         {"Radius ratio", "", 0.2, 0, 1, true,
                          marks_for(report, "", 0, value("/quality/radius_ratio/minimum"), "")});
  return all.empty() ? all : "<div class=\"charts\">\n" + all + "</div>\n";
}

std::string distributions(const Json& report) {
  Table table({{"measure"},
               {"smallest", Align::right},
               {"0.1 %", Align::right, "the value that 0.1 % of the tetrahedra do not exceed"},
               {"1 %", Align::right},
               {"5 %", Align::right},
               {"mean", Align::right},
               {"largest", Align::right}});
  for (const auto& [key, words] :
       {std::pair("min_dihedral", "smallest dihedral angle"),
        std::pair("max_dihedral", "largest dihedral angle"), std::pair("mean_ratio", "mean ratio"),
        std::pair("radius_ratio", "radius ratio")}) {
    const Json& of = find(report, fmt::format("/quality/{}", key));
    const auto shown = std::string_view(key).ends_with("dihedral") ? degrees : ratio;
    table.add({words, shown(find(of, "/minimum")), shown(find(of, "/percentile_0.1")),
               shown(find(of, "/percentile_1")), shown(find(of, "/percentile_5")), shown(find(of, "/mean")),
               shown(find(of, "/maximum"))});
  }
  return table.html();
}

/// Measures that compare neighbours, where the gate has asked for them.
std::string cells_table(const Json& cells) {
  Table table({{"measure"},
               {"shape"},
               {"smallest", Align::right},
               {"median", Align::right},
               {"mean", Align::right},
               {"largest", Align::right}});
  if (!cells.is_object()) return {};
  for (const auto& [shape, measures] : cells.items()) {
    if (shape == "worst") continue;
    for (const auto& [measure, of] : measures.items())
      table.add({escaped(measure), escaped(shape), quantity(find(of, "/minimum")),
                 quantity(find(of, "/percentile_50")), quantity(find(of, "/mean")),
                 quantity(find(of, "/maximum"))});
  }
  return part("All measures", table.html());
}

}  // namespace

std::string verdict_section(const Json& report) {
  if (find(report, "/quality").is_null()) return {};
  const Json& gate = find(report, "/quality/gate");
  const std::string valid = "<li>" + badge("good", "valid") +
                            " Checked over all ranks: positive volumes, every face between two cells or "
                            "on the boundary, a closed boundary, and the volume that it encloses.</li>\n";
  return section(
      "verdict", "Is this mesh good?",
      "<ul class=\"verdict\">\n" +
          gate_sentence(gate,
                        number(find(report, "/exit_code")) == static_cast<int>(ExitCode::quality_gate)) +
          valid + judgement_of(report) + judgement_of_shape(report) + judgement_of_flaws(report) +
          below_target(report) + "</ul>\n" + gate_table(gate) +
          paragraph(
              find(report, "/layers").is_null()
                  ? "<span class=\"quiet\">Isotropic tetrahedra without boundary layers: for inviscid flow, "
                    "wall functions, or as the mesh outside of layers. The words on angles are rules of "
                    "thumb."
                    "</span>"
                  : "<span class=\"quiet\">The words on angles are rules of thumb for the tetrahedra off the "
                    "boundary layers. Cells of layers are flat on purpose: their shape and the sizes of "
                    "neighbours count.</span>"));
}

std::string histograms_section(const Json& report) {
  if (find(report, "/quality").is_null()) return {};
  return section(
      "histograms", "Quality of the tetrahedra",
      paragraph("Numbers of tetrahedra on logarithmic scales: single elements count, and are seen, in the "
                "tails.") +
          charts(report) + distributions(report) + cells_table(find(report, "/quality/cells")));
}

}  // namespace aeroloom::report::html
