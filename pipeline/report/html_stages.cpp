#include "pipeline/report/html_sections.hpp"
#include "pipeline/report/page/html_table.hpp"
#include "pipeline/report/page/svg.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::report::html {
namespace {

bool was_resumed(const Json& report, const std::string& stage) {
  const Json& resumed = find(report, "/resumed");
  return std::find(resumed.begin(), resumed.end(), Json(stage)) != resumed.end();
}

/// The busiest rank over the mean. Below a hundredth of a second the clock's steps rule it.
std::string imbalance(const Json& stage) {
  constexpr double least_shown = 0.01;
  const double mean = number(find(stage, "/cpu_seconds_mean"));
  return mean < least_shown ? "–" : fmt::format("{:.2f}", number(find(stage, "/cpu_seconds_max")) / mean);
}

/// Bytes of messages of all kinds.
std::string sent(const Json& stage) {
  double bytes = 0;
  for (const Json& messages : find(stage, "/messages")) bytes += number(find(messages, "/bytes"), 0);
  return bytes > 0 ? memory(bytes) : "–";
}

std::string stage_table(const Json& report) {
  Table table(
      {{"stage"},
       {"wall", Align::right, "of the slowest rank"},
       {"of all", Align::left, "part of the wall time"},
       {"CPU min", Align::right, "of tasks, over ranks"},
       {"mean", Align::right},
       {"max", Align::right},
       {"max/mean", Align::right, "1.00: all ranks have the same work"},
       {"checks", Align::right, "CPU of checks of what was made, largest over ranks"},
       {"other", Align::right, "CPU that is neither tasks nor checks nor messages, largest over ranks"},
       {"waiting", Align::right, "in messages, until other ranks come included, mean over ranks"},
       {"sent", Align::right, "bytes of messages to other ranks, all ranks together"},
       {"pieces", Align::right},
       {"memory", Align::right, "of the largest rank at its peak"},
       {"all ranks", Align::right}});
  const double wall = number(find(report, "/wall_seconds"));
  for (const Json& stage : find(report, "/stages")) {
    const std::string word = text(find(stage, "/name"));
    const double own = number(find(stage, "/wall_seconds"));
    table.add(
        {escaped(word) + (was_resumed(report, word) ? " <span class=\"quiet\">from a checkpoint</span>" : ""),
         seconds(own), wall > 0 ? bar(own / wall) : "", seconds(find(stage, "/cpu_seconds_min")),
         seconds(find(stage, "/cpu_seconds_mean")), seconds(find(stage, "/cpu_seconds_max")),
         imbalance(stage), seconds(find(stage, "/check_seconds")), seconds(find(stage, "/other_seconds")),
         seconds(find(stage, "/waiting_seconds_mean")), sent(stage), count(find(stage, "/pieces")),
         memory(find(stage, "/peak_rss_bytes_max")), memory(find(stage, "/peak_rss_bytes_sum"))});
  }
  return table.html();
}

/// Bars of the ranks where report.json lists them all.
std::string loads_of_ranks(const Json& report) {
  std::vector<std::string> stages;
  const Json& first = find(report, "/stages/0/cpu_seconds_by_rank");
  std::vector<std::vector<double>> seconds_of(first.is_array() ? first.size() : 0);
  for (const Json& stage : find(report, "/stages")) {
    const Json& of_ranks = find(stage, "/cpu_seconds_by_rank");
    if (of_ranks.size() != seconds_of.size()) return {};
    stages.push_back(text(find(stage, "/name")));
    for (std::size_t r = 0; r < seconds_of.size(); ++r) seconds_of[r].push_back(number(of_ranks[r]));
  }
  return load_chart(stages, seconds_of);
}

/// Of many ranks, how many of them have which load.
std::string load_histograms(const Json& report) {
  Table table({{"stage"},
               {"CPU min", Align::right},
               {"mean", Align::right},
               {"max", Align::right},
               {"ranks from no load (left) to the largest (right)"}});
  for (const Json& stage : find(report, "/stages")) {
    const Json& counts = find(stage, "/cpu_seconds_histogram/counts");
    if (counts.is_null() || number(find(stage, "/cpu_seconds_max")) <= 0) continue;
    table.add({escaped(text(find(stage, "/name"))), seconds(find(stage, "/cpu_seconds_min")),
               seconds(find(stage, "/cpu_seconds_mean")), seconds(find(stage, "/cpu_seconds_max")),
               small_histogram(counts)});
  }
  return table.html();
}

std::string versions(const Json& list) {
  std::vector<std::pair<std::string, std::string>> rows;
  if (list.is_object()) {
    for (const auto& [library, version] : list.items())
      rows.emplace_back(escaped(library), escaped(text(version)));
  }
  return part("Versions", facts(rows));
}

}  // namespace

std::string stages_section(const Json& report) {
  const std::string table = stage_table(report);
  if (table.empty()) return {};
  const std::string bars = loads_of_ranks(report);
  return section("stages", "Time and memory",
                 table +
                     paragraph(fmt::format("{} in all, on {}.", seconds(find(report, "/wall_seconds")),
                                           counted(find(report, "/ranks"), "rank"))) +
                     part("Work of each rank: CPU time of tasks, by stage", bars) +
                     (bars.empty() ? part("Work over ranks", load_histograms(report)) : ""));
}

std::string origin_section(const Json& report) {
  const Json& input = find(report, "/input");
  std::vector<std::pair<std::string, std::string>> rows;
  if (const Json& file = find(report, "/case"); file.is_string())
    rows.emplace_back("case", "<code>" + name(file) + "</code>");
  if (const Json& file = find(input, "/file"); file.is_string())
    rows.emplace_back("input", "<code>" + name(file) + "</code>");
  if (const Json& bytes = find(input, "/bytes"); bytes.is_number())
    rows.emplace_back("size", count(bytes) + " bytes");
  if (const std::string hash = text(find(input, "/hash")); !hash.empty())
    rows.emplace_back("hash of the input", "<code>" + escaped(hash) + "</code>");
  constexpr std::size_t longest_configuration = 200'000;  // far below the page's room for pictures
  const std::string configuration = long_text(find(report, "/configuration"), longest_configuration);
  return section("origin", "Where it comes from",
                 facts(rows) + versions(find(report, "/versions")) +
                     (configuration.empty()
                          ? ""
                          : "<details>\n<summary>The whole configuration, defaults included</summary>\n"
                            "<pre class=\"configuration\">" +
                                configuration + "</pre>\n</details>\n"));
}

}  // namespace aeroloom::report::html
