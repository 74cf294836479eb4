#include "pipeline/report/page/html_table.hpp"

#include "pipeline/report/page/html_text.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace aeroloom::page {
namespace {

constexpr std::size_t most_rows = 50;

const char* css_class(Align align) {
  return align == Align::right ? " class=\"number\"" : "";
}

}  // namespace

void Table::add(const std::vector<std::string>& cells) {
  if (++_rows > most_rows) return;
  _shown += "<tr>";
  for (std::size_t c = 0; c < cells.size(); ++c)
    _shown += fmt::format("<td{}>{}</td>", css_class(_columns.at(c).align), cells[c]);
  _shown += "</tr>\n";
}

std::string Table::html() const {
  if (empty()) return {};
  std::string heads;
  for (const Column& column : _columns) {
    const std::string hint = column.hint.empty() ? "" : " title=\"" + escaped(column.hint) + "\"";
    heads += fmt::format("<th scope=\"col\"{}{}>{}</th>", css_class(column.align), hint, column.head);
  }
  std::string more;
  if (_rows > most_rows)
    more = fmt::format("<p class=\"more\">and {} more, see {}</p>\n",
                       count(static_cast<std::int64_t>(_rows - most_rows)), _file);
  return fmt::format(
      "<div class=\"wide\"><table>\n<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table></div>\n{}",
      heads, _shown, more);
}

std::string section(const std::string& id, const std::string& title, const std::string& body) {
  if (body.empty()) return {};
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, body);
}

std::string part(const std::string& title, const std::string& body) {
  if (body.empty()) return {};
  return fmt::format("<div class=\"part\">\n<h3>{}</h3>\n{}</div>\n", title, body);
}

std::string paragraph(const std::string& body) {
  return "<p>" + body + "</p>\n";
}

std::string badge(const std::string& kind, const std::string& words) {
  const char* sign = kind == "good" ? "✓ " : kind == "fair" ? "! " : kind == "poor" ? "✗ " : "";
  return fmt::format("<span class=\"badge {}\">{}{}</span>", kind, sign, words);
}

std::string facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string body;
  for (const auto& [head, value] : rows)
    body += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", head, value);
  return body.empty() ? body : "<dl>\n" + body + "</dl>\n";
}

std::string bar(double part) {
  const double filled = std::clamp(part, 0.0, 1.0);
  return fmt::format(
      "<svg class=\"bar\" viewBox=\"0 0 100 10\" preserveAspectRatio=\"none\" aria-hidden=\"true\">"
      "<rect class=\"trough\" width=\"100\" height=\"10\"/>"
      "<rect class=\"filled\" width=\"{:.1f}\" height=\"10\"/></svg>",
      100 * filled);
}

}  // namespace aeroloom::page
