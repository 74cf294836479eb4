#include "pipeline/report/page/svg.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace aeroloom::page {
namespace {

constexpr double width = 480, height = 230;
constexpr double left = 44, right = 12, top = 26, bottom = 30;
constexpr double low_end = 0.6;  ///< of the logarithmic axis: a single element is a bar

struct Axes {
  double from, to, most;
  double x(double value) const { return left + (value - from) / (to - from) * (width - left - right); }
  double y(double value) const {
    const double part = std::log(std::max(value, low_end) / low_end) / std::log(most / low_end);
    return height - bottom - part * (height - top - bottom);
  }
};

struct Bins {
  double low, high;
  std::vector<double> counts;
  double edge(std::size_t bin) const {
    return low + (high - low) * static_cast<double>(bin) / static_cast<double>(counts.size());
  }
};

std::optional<Bins> bins_of(const Json& histogram) {
  if (!histogram.is_object()) return std::nullopt;
  Bins bins{number(find(histogram, "/low")), number(find(histogram, "/high"), 1), {}};
  for (const Json& value : find(histogram, "/counts")) bins.counts.push_back(number(value));
  const bool any = std::any_of(bins.counts.begin(), bins.counts.end(), [](double c) { return c > 0; });
  return any && bins.high > bins.low ? std::optional(bins) : std::nullopt;
}

/// All bins that hold anything, and the range that the chart always shows.
Axes axes_of(const Bins& bins, const HistogramChart& chart) {
  Axes axes{chart.from, chart.to, 10};
  for (std::size_t b = 0; b < bins.counts.size(); ++b) {
    if (bins.counts[b] <= 0) continue;
    axes.from = std::min(axes.from, bins.edge(b));
    axes.to = std::max(axes.to, bins.edge(b + 1));
    while (axes.most < bins.counts[b] * 1.1 && axes.most < 1e15) axes.most *= 10;
  }
  return axes;
}

std::string label(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
}

std::string grid(const Axes& axes, const HistogramChart& chart) {
  std::string text;
  const auto line = [&](const char* kind, double x1, double y1, double x2, double y2) {
    text += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>\n",
                        kind, x1, y1, x2, y2);
  };
  for (double count = 1; count <= axes.most; count *= 10) {
    line("grid", left, axes.y(count), width - right, axes.y(count));
    const std::string words = count < 1e3   ? fmt::format("{:.0f}", count)
                              : count < 1e6 ? fmt::format("{:.0f} k", count / 1e3)
                              : count < 1e9 ? fmt::format("{:.0f} M", count / 1e6)
                                            : fmt::format("{:.0f} G", count / 1e9);
    text += label(left - 5, axes.y(count) + 4, "end", words);
  }
  line("axis", left, height - bottom, width - right, height - bottom);
  // As many numbers as there is room for, whatever the range.
  const double tick = std::max(chart.tick, (axes.to - axes.from) / 12);
  const double begin = std::ceil(axes.from / tick - 1e-9);
  for (int n = 0; n <= 12 && (begin + n) * tick <= axes.to + 1e-9 * tick; ++n) {
    const double at = (begin + n) * tick;
    text += label(axes.x(at), height - bottom + 16, "middle", fmt::format("{:.3g}{}", at, chart.unit));
  }
  return text;
}

bool is_past_limit(const HistogramChart& chart, double from, double to) {
  return std::any_of(chart.marks.begin(), chart.marks.end(), [&](const Mark& mark) {
    return mark.limit && (chart.small_is_bad ? to <= mark.at + 1e-9 : from >= mark.at - 1e-9);
  });
}

std::string bars(const Axes& axes, const Bins& bins, const HistogramChart& chart) {
  std::string text;
  for (std::size_t b = 0; b < bins.counts.size(); ++b) {
    if (bins.counts[b] <= 0) continue;
    const double from = bins.edge(b), to = bins.edge(b + 1);
    const double x = axes.x(from), y = axes.y(bins.counts[b]);
    text += fmt::format(
        "<rect class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
        "<title>{:.3g}{} to {:.3g}{}: {}</title></rect>\n",
        is_past_limit(chart, from, to) ? "beyond" : "count", x, y, std::max(1.0, axes.x(to) - x - 0.6),
        height - bottom - y, from, chart.unit, to, chart.unit,
        counted(bins.counts[b], "tetrahedron", "tetrahedra"));
  }
  return text;
}

/// Labels of lines close to each other stand one below the other, on the side where there is room.
std::string marks(const Axes& axes, const HistogramChart& chart) {
  std::string text;
  double row = top + 10;
  for (const Mark& mark : chart.marks) {
    if (mark.at < axes.from || mark.at > axes.to) continue;
    const double x = axes.x(mark.at);
    const bool at_left = x > (left + width - right) / 2;
    text +=
        fmt::format("<line class=\"mark\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>\n", x,
                    top, height - bottom);
    text += label(at_left ? x - 4 : x + 4, row, at_left ? "end" : "start", escaped(mark.label));
    row += 14;
  }
  return text;
}

}  // namespace

std::string histogram_chart(const Json& histogram, const HistogramChart& chart) {
  const std::optional<Bins> bins = bins_of(histogram);
  if (!bins) return {};
  const Axes axes = axes_of(*bins, chart);
  return fmt::format(
      "<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n"
      "<text class=\"title\" x=\"{}\" y=\"14\">{}</text>\n{}{}{}</svg>\n",
      width, height, escaped(chart.title), left, escaped(chart.title), grid(axes, chart),
      bars(axes, *bins, chart), marks(axes, chart));
}

std::string small_histogram(const Json& counts) {
  double most = 1;
  for (const Json& value : counts) most = std::max(most, number(value));
  std::string bars;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    const double tall = 20 * number(counts[b]) / most;
    bars += fmt::format("<rect class=\"count\" x=\"{}\" y=\"{:.1f}\" width=\"5\" height=\"{:.1f}\"/>", 6 * b,
                        20 - tall, tall);
  }
  return fmt::format("<svg class=\"small\" viewBox=\"0 0 {} 20\" aria-hidden=\"true\">{}</svg>",
                     6 * counts.size(), bars);
}

std::string load_chart(const std::vector<std::string>& stages,
                       const std::vector<std::vector<double>>& seconds) {
  double most = 0;
  for (const std::vector<double>& rank : seconds) {
    double sum = 0;
    for (const double part : rank) sum += part;
    most = std::max(most, sum);
  }
  if (most <= 0) return {};
  constexpr double row = 18, names = 64, sums = 56, wide = 800;
  std::string text;
  for (std::size_t r = 0; r < seconds.size(); ++r) {
    const double y = row * static_cast<double>(r);
    double x = names, sum = 0;
    text += label(0, y + 13, "start", fmt::format("rank {}", r));
    for (std::size_t s = 0; s < seconds[r].size(); ++s) {
      const double size = seconds[r][s] / most * (wide - names - sums);
      if (size > 0)
        text += fmt::format(
            "<rect class=\"stage{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"14\"><title>{}: "
            "{}</title></rect>\n",
            s % 10, x, y + 2, size, escaped(stages.at(s)), page::seconds(seconds[r][s]));
      x += size;
      sum += seconds[r][s];
    }
    text += label(x + 4, y + 13, "start", page::seconds(sum));
  }
  std::string legend;
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const bool any =
        std::any_of(seconds.begin(), seconds.end(), [&](const auto& rank) { return rank[s] > 0; });
    if (any)
      legend += fmt::format(
          "<li><svg viewBox=\"0 0 12 12\" aria-hidden=\"true\"><rect class=\"stage{}\" width=\"12\" "
          "height=\"12\"/></svg>{}</li>",
          s % 10, escaped(stages[s]));
  }
  return fmt::format(
      "<div class=\"wide\"><svg class=\"loads\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"CPU seconds "
      "by rank and "
      "stage\">\n{}</svg></div>\n"
      "<ul class=\"legend\">{}</ul>\n",
      wide, row * static_cast<double>(seconds.size()), text, legend);
}

}  // namespace aeroloom::page
