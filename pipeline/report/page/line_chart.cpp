#include "pipeline/report/page/line_chart.hpp"

#include "pipeline/report/page/html_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace aeroloom::page {
namespace {

/// The room of a chart within its picture.
struct Frame {
  double wide = 480, high = 270, from_left = 56, from_right = 14, from_top = 28, from_bottom = 42;
  double right_end() const { return wide - from_right; }
  double lower_end() const { return high - from_bottom; }
};

struct Scale {
  double low, high;
  bool is_logarithmic;
  double part(double value) const {
    if (!is_logarithmic) return (value - low) / (high - low);
    return std::log(value / low) / std::log(high / low);
  }
};

std::string words(double x, double y, const char* anchor, const std::string& text, const char* kind = "") {
  return fmt::format("<text{} x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", kind, x, y, anchor,
                     escaped(text));
}

std::string rule(const char* kind, double x1, double y1, double x2, double y2) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n", kind,
                     x1, y1, x2, y2);
}

std::string short_number(double value) {
  if (value >= 1e6) return fmt::format("{:.3g} M", value / 1e6);
  if (value >= 1e4) return fmt::format("{:.3g} k", value / 1e3);
  return fmt::format("{:.3g}", value);
}

/// 1, 2 or 5 times a power of ten, so that about five fit.
double step_for(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (range / (factor * power) <= 6) return factor * power;
  return 10 * power;
}

std::vector<double> ticks_of(const Scale& scale) {
  std::vector<double> ticks;
  if (scale.is_logarithmic) {
    const int between = std::max(1, static_cast<int>(std::ceil(std::log2(scale.high / scale.low) / 8)));
    for (double tick = scale.low; tick <= scale.high * 1.0001; tick *= std::pow(2, between))
      ticks.push_back(tick);
  } else {
    const double step = step_for(scale.high - scale.low);
    for (double tick = std::ceil(scale.low / step) * step; tick <= scale.high + 1e-9 * step; tick += step)
      ticks.push_back(tick);
  }
  return ticks;
}

/// Shapes that differ without colour; a class each for colour. Hollow ones have the colour at their edge.
std::string marker(std::size_t line, double x, double y, bool is_hollow = false) {
  constexpr double r = 4;
  const std::string kind =
      is_hollow ? fmt::format("hollow stroke{}", line % 4) : fmt::format("line{}", line % 4);
  switch (line % 4) {
    case 0:
      return fmt::format("<circle class=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\">", kind, x, y, r);
    case 1:
      return fmt::format("<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\">", kind,
                         x - r, y - r, 2 * r, 2 * r);
    case 2:
      return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l5 9h-10z\">", kind, x, y - 5);
    default:
      return fmt::format("<path class=\"{}\" d=\"M{:.1f} {:.1f}l5 5l-5 5l-5 -5z\">", kind, x, y - 5);
  }
}

const char* name_of_marker(std::size_t line) {
  constexpr std::array<const char*, 4> names{"circle", "rect", "path", "path"};
  return names.at(line % 4);
}

bool is_other(const ChartLine& line, std::size_t point) {
  return point < line.other_kind.size() && line.other_kind[point];
}

std::string legend_entry(const ChartLine& line, std::size_t number) {
  if (line.ideal)
    return fmt::format(
        "<li><svg viewBox=\"0 0 24 12\" aria-hidden=\"true\"><path class=\"ideal\" d=\"M0 6L24 "
        "6\"/></svg>{}</li>",
        escaped(line.name));
  bool any_plain = false, any_other = false;
  for (std::size_t i = 0; i < line.points.size(); ++i) (is_other(line, i) ? any_other : any_plain) = true;
  std::string entries;
  for (const bool is_hollow : {false, true}) {
    if (is_hollow ? any_other : any_plain)
      entries += fmt::format("<li><svg viewBox=\"0 0 12 12\" aria-hidden=\"true\">{}</{}></svg>{}</li>",
                             marker(number, 6, 6, is_hollow), name_of_marker(number),
                             escaped(is_hollow ? line.other_name : line.name));
  }
  return entries;
}

/// The smallest power of two above, or a bit more than the largest.
double upper_end(double largest, bool is_logarithmic) {
  return is_logarithmic ? std::exp2(std::ceil(std::log2(largest) - 1e-9)) : 1.08 * largest;
}

}  // namespace

std::string line_chart(const std::vector<ChartLine>& lines, const LineChart& chart) {
  double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
  std::set<double> places;
  for (const ChartLine& line : lines) {
    for (const auto& [x, y] : line.points) {
      x_low = std::min(x_low, x), x_high = std::max(x_high, x);
      y_low = std::min(y_low, y), y_high = std::max(y_high, y);
      places.insert(x);
    }
  }
  if (places.empty() || y_high <= 0) return {};
  const Frame frame;
  const Scale across{x_low, std::max(x_high, 2 * x_low), true};
  const Scale up = chart.logarithmic ? Scale{std::exp2(std::floor(std::log2(y_low) + 1e-9)),
                                             std::max(upper_end(y_high, true), 2 * y_low), true}
                                     : Scale{chart.y_least, upper_end(y_high, false), false};
  const auto x_of = [&](double x) {
    return frame.from_left + 12 + across.part(x) * (frame.right_end() - frame.from_left - 24);
  };
  const auto y_of = [&](double y) {
    return frame.lower_end() - up.part(y) * (frame.lower_end() - frame.from_top);
  };
  std::string body;
  for (const double tick : ticks_of(up)) {
    body += rule("grid", frame.from_left, y_of(tick), frame.right_end(), y_of(tick));
    body += words(frame.from_left - 6, y_of(tick) + 4, "end",
                  chart.percent ? fmt::format("{:.0f} %", 100 * tick) : short_number(tick));
  }
  for (const double place : places)
    body += words(x_of(place), frame.lower_end() + 16, "middle", short_number(place));
  body += rule("axis", frame.from_left, frame.lower_end(), frame.right_end(), frame.lower_end());
  body += words(frame.right_end(), frame.high - 8, "end", chart.x_name);
  std::string legend;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const ChartLine& line = lines[l];
    if (line.points.empty()) continue;
    std::string path, markers;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const auto& [x, y] = line.points[i];
      const bool is_joined = i > 0 && is_other(line, i) == is_other(line, i - 1);
      path += fmt::format("{}{:.1f} {:.1f}", is_joined ? "L" : "M", x_of(x), y_of(y));
      if (!line.ideal)
        markers += marker(l, x_of(x), y_of(y), is_other(line, i)) +
                   fmt::format("<title>{}, {}: {}</title></{}>\n",
                               escaped(is_other(line, i) ? line.other_name : line.name), short_number(x),
                               chart.percent ? fmt::format("{:.0f} %", 100 * y) : short_number(y),
                               name_of_marker(l));
    }
    body += fmt::format("<path class=\"{}\" d=\"{}\"/>\n",
                        line.ideal ? "ideal" : fmt::format("stroke{}", l % 4), path) +
            markers;
    legend += legend_entry(line, l);
  }
  return fmt::format(
      "<div><svg class=\"chart\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" aria-label=\"{}\">\n"
      "<text class=\"title\" x=\"{:g}\" y=\"14\">{}</text>\n{}</svg>\n<ul class=\"legend\">{}</ul></div>\n",
      frame.wide, frame.high, escaped(chart.title), frame.from_left, escaped(chart.title), body, legend);
}

std::string stacked_bar_chart(const std::string& title, const std::string& unit,
                              const std::vector<std::string>& parts, const std::vector<StackedBar>& bars) {
  double most = 0;
  for (const StackedBar& bar : bars) {
    double sum = 0;
    for (const double part : bar.parts) sum += part;
    most = std::max(most, sum);
  }
  if (most <= 0) return {};
  const Frame frame;
  const Scale up{0, 1.08 * most, false};
  const double room = (frame.right_end() - frame.from_left) / static_cast<double>(bars.size());
  const double wide = std::min(54.0, 0.7 * room);
  const auto y_of = [&](double y) {
    return frame.lower_end() - up.part(y) * (frame.lower_end() - frame.from_top);
  };
  std::string body;
  for (const double tick : ticks_of(up)) {
    body += rule("grid", frame.from_left, y_of(tick), frame.right_end(), y_of(tick));
    body += words(frame.from_left - 6, y_of(tick) + 4, "end", short_number(tick) + unit);
  }
  for (std::size_t p = 0; p < bars.size(); ++p) {
    const double x = frame.from_left + (static_cast<double>(p) + 0.5) * room;
    double below = 0;
    for (std::size_t k = 0; k < bars[p].parts.size(); ++k) {
      const double size = bars[p].parts[k];
      if (size <= 0) continue;
      const double high = y_of(below) - y_of(below + size);
      body += fmt::format(
          "<rect class=\"stage{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"><title>{}: "
          "{}{}</title></rect>\n",
          k % 10, x - wide / 2, y_of(below + size), wide, high, escaped(parts[k]), short_number(size), unit);
      if (high >= 12) body += words(x, y_of(below + size / 2) + 4, "middle", parts[k]);
      below += size;
    }
    body += words(x, frame.lower_end() + 16, "middle", bars[p].name);
  }
  body += rule("axis", frame.from_left, frame.lower_end(), frame.right_end(), frame.lower_end());
  return fmt::format(
      "<div><svg class=\"chart stacked\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" aria-label=\"{}\">\n"
      "<text class=\"title\" x=\"{:g}\" y=\"14\">{}</text>\n{}</svg></div>\n",
      frame.wide, frame.high, escaped(title), frame.from_left, escaped(title), body);
}

}  // namespace aeroloom::page
