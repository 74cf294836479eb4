#include "pipeline/report/html.hpp"

#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/base64.hpp"
#include "pipeline/report/page/html_table.hpp"
#include "pipeline/report/page/style.hpp"

#include <cctype>
#include <filesystem>
#include <set>

#include <fmt/format.h>

namespace aeroloom::report {
namespace html {
namespace {

/// The rest of the page stays far below the half megabyte that this leaves.
constexpr std::size_t room_for_pictures = 4'500'000;

std::string legend_of(const Picture& picture) {
  constexpr std::size_t most = 40;
  std::string items;
  for (std::size_t i = 0; i < std::min(most, picture.legend.size()); ++i)
    items +=
        fmt::format("<li>{}{}</li>", swatch(picture.legend[i].colour), name(as_utf8(picture.legend[i].name)));
  if (picture.legend.size() > most)
    items += fmt::format("<li>and {} more</li>", picture.legend.size() - most);
  return items.empty() ? items : "<ul class=\"legend\">" + items + "</ul>\n";
}

/// A legend that an earlier picture has had is not repeated.
std::string figure(const Picture& picture, std::set<std::string>& legends) {
  constexpr int broad = 1200;  // pixels: stands alone in its row of the page
  const std::string legend = legend_of(picture);
  const bool repeated = !legend.empty() && !legends.insert(legend).second;
  return fmt::format(
      "<figure{}>\n<img alt=\"{}\" width=\"{}\" height=\"{}\" src=\"data:image/png;base64,{}\">\n"
      "<figcaption>{}</figcaption>\n{}</figure>\n",
      picture.width >= broad ? " class=\"broad\"" : "", escaped(picture.caption), picture.width,
      picture.height, base64(picture.png),
      escaped(picture.caption) + (repeated ? " <span class=\"quiet\">Colours as above.</span>" : ""),
      repeated ? "" : legend);
}

std::string navigation(const std::string& page) {
  std::string links;
  for (const auto& [id, words] :
       {std::pair("verdict", "Quality"), std::pair("pictures", "Pictures"),
        std::pair("histograms", "Histograms"), std::pair("solver", "Solver"), std::pair("layers", "Layers"),
        std::pair("places", "Places"), std::pair("patches", "Patches"), std::pair("warnings", "Warnings"),
        std::pair("geometry", "Geometry"), std::pair("stages", "Stages"), std::pair("origin", "Origin")}) {
    if (page.find(fmt::format("<section id=\"{}\"", id)) != std::string::npos)
      links += fmt::format("<a href=\"#{}\">{}</a> ", id, words);
  }
  return "<nav>" + links + "</nav>\n";
}

}  // namespace

std::string pictures_section(const std::vector<Picture>& pictures) {
  std::string figures, left_out;
  std::set<std::string> legends;
  std::size_t room = room_for_pictures;
  for (const Picture& picture : pictures) {
    const std::size_t size = picture.png.size() / 3 * 4 + 4;
    if (size > room) {
      left_out += fmt::format("<li>{} (no room within 5 MB)</li>", escaped(picture.caption));
      continue;
    }
    room -= size;
    figures += figure(picture, legends);
  }
  if (!figures.empty()) figures = "<div class=\"figures\">\n" + figures + "</div>\n";
  if (!left_out.empty()) left_out = "<ul>" + left_out + "</ul>\n";
  return section("pictures", "Pictures", figures + left_out);
}

std::string swatch(const std::string& colour) {
  bool known = colour.size() == 7 && colour[0] == '#';
  for (std::size_t i = 1; i < colour.size(); ++i)
    known = known && std::isxdigit(static_cast<unsigned char>(colour[i])) != 0;
  if (!known) return {};
  return fmt::format(
      "<svg class=\"swatch\" viewBox=\"0 0 12 12\" aria-hidden=\"true\"><rect width=\"12\" "
      "height=\"12\" fill=\"{}\"/></svg>",
      colour);
}

std::string title_of(const Json& report) {
  for (const char* path : {"/case", "/input/file"}) {
    const std::string file = text(find(report, path));
    std::string stem = std::filesystem::path(file).stem().string();
    if (!stem.empty()) return stem;
  }
  return "built-in aircraft";
}

}  // namespace html

std::string report_html(const std::string& json, const std::vector<Picture>& pictures) {
  using namespace html;
  const Json report = Json::parse(json);
  const std::string body = failure_section(report) + verdict_section(report) + pictures_section(pictures) +
                           histograms_section(report) + solver_section(report) + layers_section(report) +
                           places_section(report) + patches_section(report, pictures) +
                           warnings_section(report) + geometry_section(report) + stages_section(report) +
                           origin_section(report);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Aeroloom: {}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n{}{}{}</main>\n"
      "<footer>aeroloom {}. How to read this page: docs/reading_the_report.md; all figures: "
      "report.json.</footer>\n"
      "</body>\n</html>\n",
      escaped(title_of(report)), style_sheet(), headline(report), navigation(body), body,
      escaped(text(find(report, "/program/version"))));
}

}  // namespace aeroloom::report
