#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

/// The remedy for each way in which the program ends; the message has the one for the very case.
const char* remedy(int code) {
  switch (static_cast<ExitCode>(code)) {
    case ExitCode::usage:
      return "Correct the case as the message says (docs/configuration). <code>aeroloom check</code> "
             "tries a case "
             "without meshing.";
    case ExitCode::cad:
      return "The geometry cannot be meshed as it is. Run <code>aeroloom check CASE.yaml</code>: it lists "
             "open edges, "
             "faces that intersect and faces that healing changed, with names and coordinates. Mend them in "
             "the CAD "
             "system, or state <code>geometry.domain</code> and <code>farfield</code> where the file was "
             "misunderstood.";
    case ExitCode::surface:
      return "Look at the CAD face and the place that the message names. Smaller sizes there "
             "(<code>sizing.minimum</code>, <code>sizing.feature_minimum</code>) help where curves or faces "
             "are closer "
             "to each other than elements are long; a face that is folded or that crosses another must be "
             "mended in "
             "the CAD.";
    case ExitCode::volume:
      return "Where the message names triangles, open <code>offending_triangles.vtp</code> in ParaView: "
             "faces that "
             "cross or touch each other there are the usual reason. Smaller sizes there, or mended CAD, "
             "help; a "
             "smaller <code>volume.piece_tets</code> helps where memory or time of one zone was the reason.";
    case ExitCode::quality_gate:
      return "The mesh is complete, valid and written; it misses a limit that the case has asked for. See "
             "below where "
             "it does, then use a larger <code>improve.target_angle</code>, smaller sizes at those places, "
             "or a lower "
             "limit.";
    case ExitCode::files:
      return "A file could not be read or written: see whether it is there, whether its folder may be "
             "written, and "
             "whether the disk is full or a quota is used up.";
    case ExitCode::resources:
      return "The memory did not suffice. Use more nodes, fewer ranks on each, larger sizes, or smaller "
             "pieces "
             "(<code>volume.piece_tets</code>); <code>aeroloom check</code> predicts what a case needs.";
    case ExitCode::bug:
      return "This is a defect of the program. Please report it with this page and the case.";
    case ExitCode::ok:
      break;
  }
  return "";
}

/// The stages that had ended before, and what they left.
std::string progress(const Json& report) {
  std::string done;
  const std::string failed = text(find(report, "/failure/stage"));
  for (const Json& stage : find(report, "/stages")) {
    const std::string word = text(find(stage, "/name"));
    if (word != failed && word != "start") done += (done.empty() ? "" : ", ") + escaped(word);
  }
  std::string known = done.empty() ? paragraph("No stage had ended before.")
                                   : paragraph("Stages that ended well: " + done + ".");
  const Json& triangles = find(report, "/surface/triangles");
  if (number(triangles) > 0 && text(find(report, "/mesh/hash")).empty())
    known += paragraph(fmt::format("The surface mesh was finished, with {} triangles, the smallest angle {}.",
                                   count(triangles), degrees(find(report, "/surface/min_angle_deg"))));
  return known;
}

std::string end_badge(const Json& report) {
  if (text(find(report, "/status")) == "ok") return badge("good", "finished");
  return badge("poor", number(find(report, "/exit_code")) == static_cast<int>(ExitCode::quality_gate)
                           ? "quality gate missed"
                           : "failed in stage " + escaped(text(find(report, "/failure/stage"))));
}

std::string tile(const std::string& words, const std::string& value) {
  return fmt::format("<div class=\"tile\"><span>{}</span><b>{}</b></div>\n", words, value);
}

/// Of cells of layers and of neighbours, where these were measured.
std::string tiles_of_flaws(const Json& report) {
  std::string all;
  for (const Json& flaw : find(report, "/quality/flaws")) {
    const std::string kind = text(find(flaw, "/flaw"));
    const std::string value = quantity(find(flaw, "/value"));
    if (kind == "shape") all += tile("worst shape in layers", value);
    if (kind == "size_jump") all += tile("largest neighbour over a cell", value);
    if (kind == "non_orthogonality") all += tile("largest non-orthogonality", degrees(find(flaw, "/value")));
  }
  return all;
}

std::string tiles(const Json& report) {
  std::string all;
  if (!text(find(report, "/mesh/hash")).empty()) {
    const std::string unit = text(find(report, "/geometry/unit"));
    const bool has_layers = !find(report, "/layers").is_null();
    all += tile("tetrahedra", count(find(report, "/mesh/tetrahedra")));
    for (const std::string shape : {"prisms", "pyramids", "hexahedra"}) {
      const Json& cells = find(report, "/mesh/" + shape);
      if (number(cells) > 0) all += tile(shape, count(cells));
    }
    all += tiles_of_flaws(report);
    const std::string where = has_layers ? " off layers" : "";
    all += tile("points", count(find(report, "/mesh/points"))) +
           tile("boundary triangles", count(find(report, "/mesh/boundary_triangles"))) +
           tile("smallest dihedral angle" + where, degrees(find(report, "/quality/min_dihedral_deg"))) +
           tile("largest dihedral angle" + where, degrees(find(report, "/quality/max_dihedral_deg"))) +
           tile("mean ratio on average", ratio(find(report, "/quality/mean_mean_ratio"))) +
           tile("volume", fmt::format("{}{}{}", quantity(find(report, "/mesh/volume")),
                                      unit.empty() ? "" : " ", unit.empty() ? "" : escaped(unit) + "³"));
  } else if (number(find(report, "/surface/triangles")) > 0) {
    all += tile("surface triangles", count(find(report, "/surface/triangles")));
  }
  double most = 0;
  for (const Json& stage : find(report, "/stages"))
    most = std::max(most, number(find(stage, "/peak_rss_bytes_sum")));
  return all + tile("wall time", seconds(find(report, "/wall_seconds"))) +
         tile("ranks", count(find(report, "/ranks"))) + tile("memory, all ranks", memory(most));
}

/// "2026-03-01T10:20:30Z" as people write it.
std::string date_of(const Json& report) {
  std::string date = text(find(report, "/date"));
  if (date.size() != 20) return escaped(date);
  return escaped(date.substr(0, 10) + " " + date.substr(11, 5) + " UTC");
}

}  // namespace

std::string headline(const Json& report) {
  const Json& file = find(report, "/input/file");
  const std::string from = file.is_null() ? "the built-in aircraft" : "<code>" + name(file) + "</code>";
  const std::string hash = text(find(report, "/mesh/hash"));
  return fmt::format(
      "<header>\n<h1>{} {}</h1>\n<p>{} {}, {}</p>\n<div class=\"tiles\">\n{}</div>\n{}</header>\n",
      name(title_of(report)), end_badge(report),
      text(find(report, "/input/kind")) == "mesh" ? "Improved mesh of" : "Mesh of", from, date_of(report),
      tiles(report),
      hash.empty() ? "" : "<p class=\"hash\">hash of the mesh <code>" + escaped(hash) + "</code></p>\n");
}

std::string failure_section(const Json& report) {
  if (!report.contains("failure")) return {};
  const auto code = static_cast<int>(number(find(report, "/exit_code")));
  return fmt::format(
      "<section id=\"failure\" class=\"failure\">\n<h2>{} (exit code {})</h2>\n<pre>{}</pre>\n"
      "<h3>What to do</h3>\n<p>{}</p>\n<h3>How far it came</h3>\n{}</section>\n",
      static_cast<ExitCode>(code) == ExitCode::quality_gate
          ? "The mesh misses a limit of the case"
          : "Stage " + escaped(text(find(report, "/failure/stage"))) + " failed",
      code, long_text(find(report, "/failure/message")), remedy(code), progress(report));
}

std::string warnings_section(const Json& report) {
  // A page that opens at once; report.json has all.
  constexpr std::size_t most_shown = 50, longest_message = 4000;
  std::string items;
  std::size_t shown = 0;
  for (const Json& warning : find(report, "/warnings")) {
    if (++shown > most_shown) continue;
    const Json& times = find(warning, "/times");
    items +=
        fmt::format("<li>{}{}</li>\n", long_text(find(warning, "/message"), longest_message),
                    number(times) > 1 ? " <span class=\"quiet\">(" + count(times) + " times)</span>" : "");
  }
  if (!items.empty()) items = "<ul class=\"warnings\">\n" + items + "</ul>\n";
  if (shown > most_shown)
    items += fmt::format("<p class=\"more\">and {} more, see report.json</p>\n", shown - most_shown);
  const Json& left_out = find(report, "/warnings_left_out");
  if (number(left_out) > 0) items += paragraph(count(left_out) + " further ones were printed and not kept.");
  return section("warnings", "Warnings", items.empty() ? paragraph("There were none.") : items);
}

}  // namespace aeroloom::report::html
