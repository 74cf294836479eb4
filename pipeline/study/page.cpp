#include "pipeline/study/page.hpp"

#include "pipeline/report/page/html_table.hpp"
#include "pipeline/report/page/html_text.hpp"
#include "pipeline/report/page/line_chart.hpp"
#include "pipeline/report/page/style.hpp"
#include "pipeline/study/processor_use.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::study {

namespace {

using namespace page;

/// A row's judged time is CPU's.
bool is_by_cpu(const Json& row) {
  return text(find(row, "/judged_by")) == "cpu";
}

std::vector<const Json*> rows_of_series(const Json& study, const std::string& series) {
  std::vector<const Json*> rows;
  for (const Json& row : find(study, "/rows"))
    if (text(find(row, "/series")) == series && number(find(row, "/ended")) > 0) rows.push_back(&row);
  return rows;
}

/// Points of rows that are judged by CPU are of another kind than those by the clock.
void part_by_judge(ChartLine& line, const Json& study, const std::string& series) {
  for (const Json* row : rows_of_series(study, series)) line.other_kind.push_back(is_by_cpu(*row));
  line.other_name = line.name + ", by CPU";
}

ChartLine line_of(const Json& study, const std::string& series, const std::string& key,
                  const std::string& name) {
  ChartLine line{name, {}};
  for (const Json* row : rows_of_series(study, series))
    if (const Json& value = find(*row, "/" + key); value.is_number())
      line.points.emplace_back(number(find(*row, "/ranks")), number(value));
  const bool is_judged = key == "speedup" || key == "speedup_of_series" || key == "efficiency" ||
                         key == "tetrahedra_per_second_and_core";
  if (is_judged && !line.points.empty()) part_by_judge(line, study, series);
  return line;
}

ChartLine ideal_line(const Json& study, double constant = 0) {
  ChartLine line{"ideal", {}, true};
  for (const std::string series : {"strong", "weak"}) {
    for (const Json* row : rows_of_series(study, series)) {
      const double ranks = number(find(*row, "/ranks"));
      line.points.emplace_back(ranks, constant > 0 ? constant : ranks);
    }
  }
  std::sort(line.points.begin(), line.points.end());
  line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
  return line;
}

/// Of the strong series as its smallest number of ranks predicts it; by CPU where the series is judged so.
ChartLine predicted_line(const Json& study, const std::string& key) {
  const std::vector<const Json*> rows = rows_of_series(study, "strong");
  const bool by_cpu = std::any_of(rows.begin(), rows.end(), [](const Json* row) { return is_by_cpu(*row); });
  ChartLine line{by_cpu ? "predicted, by CPU" : "predicted", {}};
  double one = 0;
  for (const Json& row : find(study, "/prediction/rows")) {
    const double ranks = number(find(row, "/ranks"));
    const double busy = number(find(row, "/busy_cpu_seconds"));
    if (ranks == 1) one = busy;
    const double speedup = by_cpu && busy > 0 ? one / busy : number(find(row, "/speedup"));
    line.points.emplace_back(ranks, key == "efficiency" ? speedup / ranks : speedup);
  }
  return line;
}

std::string stage_bars(const Json& study) {
  std::vector<std::string> stages;
  std::vector<StackedBar> bars;
  for (const std::string series : {"serial", "strong", "weak"}) {
    for (const Json* row : rows_of_series(study, series)) {
      const char* key = is_by_cpu(*row) ? "/busy_cpu_seconds" : "/wall_seconds";
      StackedBar bar{fmt::format("{}{}{}", series == "strong" ? "" : fmt::format("{} ", series),
                                 number(find(*row, "/ranks")), is_by_cpu(*row) ? "*" : ""),
                     {}};
      for (const Json& stage : find(*row, "/stages")) {
        const std::string name = text(find(stage, "/name"));
        const auto place = std::find(stages.begin(), stages.end(), name);
        const auto at = static_cast<std::size_t>(place - stages.begin());
        if (place == stages.end()) stages.push_back(name);
        bar.parts.resize(std::max(bar.parts.size(), at + 1));
        bar.parts[at] = number(find(stage, key));
      }
      bars.push_back(std::move(bar));
    }
  }
  return stacked_bar_chart("Time per stage, seconds", "", stages, bars);
}

std::string charts(const Json& study) {
  std::vector<ChartLine> speedup{
      line_of(study, "strong", "speedup", "against one rank in one piece"),
      line_of(study, "strong", "speedup_of_series", "against the smallest number of ranks"),
      predicted_line(study, "speedup"), ideal_line(study)};
  if (speedup[0].points.empty()) speedup.erase(speedup.begin());
  const std::vector<ChartLine> efficiency{line_of(study, "strong", "efficiency", "strong"),
                                          line_of(study, "weak", "efficiency", "weak"),
                                          predicted_line(study, "efficiency"), ideal_line(study, 1)};
  std::vector<ChartLine> memory{line_of(study, "strong", "memory_of_rank_bytes", "strong"),
                                line_of(study, "weak", "memory_of_rank_bytes", "weak")};
  for (ChartLine& line : memory)
    for (auto& [x, y] : line.points) y /= 1048576;
  const std::vector<ChartLine> rate{line_of(study, "strong", "tetrahedra_per_second_and_core", "strong"),
                                    line_of(study, "weak", "tetrahedra_per_second_and_core", "weak")};
  const std::vector<ChartLine> imbalance{line_of(study, "strong", "imbalance", "strong"),
                                         line_of(study, "weak", "imbalance", "weak")};
  std::vector<ChartLine> waiting{line_of(study, "strong", "waiting_seconds", "strong"),
                                 line_of(study, "weak", "waiting_seconds", "weak")};
  return "<div class=\"charts\">\n" +
         line_chart(speedup, {.title = "Speed-up of the strong series",
                              .x_name = "ranks",
                              .y_name = "",
                              .logarithmic = true}) +
         line_chart(efficiency, {.title = "Efficiency", .x_name = "ranks", .y_name = "", .percent = true}) +
         stage_bars(study) +
         line_chart(rate, {.title = "Tetrahedra per second and core", .x_name = "ranks", .y_name = ""}) +
         line_chart(memory, {.title = "Memory of the largest rank, MiB", .x_name = "ranks", .y_name = ""}) +
         line_chart(imbalance, {.title = "Busiest rank over the mean, CPU of tasks",
                                .x_name = "ranks",
                                .y_name = "",
                                .y_least = 1}) +
         line_chart(waiting, {.title = "Waiting in messages, seconds", .x_name = "ranks", .y_name = ""}) +
         "</div>\n";
}

std::string row_table(const Json& study) {
  Table table({{"series"},
               {"ranks", Align::right},
               {"nodes", Align::right},
               {"runs", Align::right, "that ended well, of those planned"},
               {"seconds", Align::right, "median; least and most below"},
               {"speed-up", Align::right, "against one rank in one piece"},
               {"in the series", Align::right, "against its smallest number of ranks, times that number"},
               {"efficiency", Align::right},
               {"imbalance", Align::right, "CPU of tasks, busiest rank over the mean"},
               {"waiting", Align::right, "in messages, mean over ranks"},
               {"memory/rank", Align::right, "of the largest"},
               {"tetrahedra", Align::right},
               {"per s, core", Align::right}},
              "scaling.json");
  for (const Json& row : find(study, "/rows")) {
    std::vector<std::string> cells{
        escaped(text(find(row, "/series"))), count(find(row, "/ranks")), count(find(row, "/nodes")),
        fmt::format("{}/{}", count(find(row, "/ended")), count(find(row, "/runs")))};
    if (number(find(row, "/ended")) == 0) {
      cells.push_back(number(find(row, "/failed")) > 0 ? badge("poor", "failed") : badge("plain", "not yet"));
    } else {
      const auto ratio_at = [&](const char* key) {
        const Json& value = find(row, key);
        return value.is_number() ? fmt::format("{:.2f}", number(value)) : std::string("–");
      };
      cells.push_back(fmt::format("{:.2f}{}<br><span class=\"quiet\">{:.2f} to {:.2f}</span>",
                                  number(find(row, "/seconds")), is_by_cpu(row) ? " CPU" : "",
                                  number(find(row, "/seconds_min")), number(find(row, "/seconds_max"))));
      cells.insert(cells.end(),
                   {ratio_at("/speedup"), ratio_at("/speedup_of_series"),
                    percent(number(find(row, "/efficiency"))), ratio_at("/imbalance"),
                    seconds(find(row, "/waiting_seconds")), memory(find(row, "/memory_of_rank_bytes")),
                    count(find(row, "/tetrahedra")), quantity(find(row, "/tetrahedra_per_second_and_core"))});
    }
    table.add(cells);
  }
  return table.html();
}

/// Predicted beside measured, and where the time goes that is not shared out.
std::string prediction_table(const Json& study) {
  if (!find(study, "/prediction/rows").is_array()) return "";
  std::vector<Column> columns{{"ranks", Align::right},
                              {"seconds", Align::right, "predicted"},
                              {"measured", Align::right, "by the clock"},
                              {"CPU", Align::right, "seconds of the busiest rank, predicted"},
                              {"measured", Align::right},
                              {"efficiency", Align::right},
                              {"memory/rank", Align::right, "of the largest, without what a node shares"}};
  const std::vector<std::string> losses{"serial",    "repeated",      "granularity",
                                        "imbalance", "communication", "waiting"};
  for (const std::string& loss : losses) columns.push_back({loss, Align::right, "part of the seconds"});
  Table table(std::move(columns), "scaling.json");
  for (const Json& row : find(study, "/prediction/rows")) {
    std::string wall = "–", busy = "–";
    for (const Json* measured : rows_of_series(study, "strong")) {
      if (find(*measured, "/ranks") != find(row, "/ranks")) continue;
      wall = seconds(find(*measured, "/wall_seconds"));
      busy = seconds(find(*measured, "/busy_cpu_seconds"));
    }
    std::vector<std::string> cells{count(find(row, "/ranks")),
                                   seconds(find(row, "/seconds")),
                                   wall,
                                   seconds(find(row, "/busy_cpu_seconds")),
                                   busy,
                                   percent(number(find(row, "/efficiency"))),
                                   memory(find(row, "/memory_of_rank_bytes"))};
    const double all = number(find(row, "/seconds"));
    for (const std::string& loss : losses)
      cells.push_back(percent(all > 0 ? number(find(row, "/losses/" + loss)) / all : 0));
    table.add(cells);
  }
  return section(
      "prediction", "Predicted from the run on fewest ranks",
      paragraph(fmt::format("{} rank(s) work with 80 % efficiency, {} where geometry does not count. "
                            "Network: {:.3g} s, {:.3g} bytes/s.",
                            count(find(study, "/prediction/ranks_at_80_percent")),
                            count(find(study, "/prediction/ranks_at_80_percent_without_geometry")),
                            number(find(study, "/prediction/latency_seconds")),
                            number(find(study, "/prediction/bytes_per_second")))) +
          table.html());
}

std::string stage_table(const Json& study) {
  std::vector<Column> columns{{"series"}, {"ranks", Align::right}};
  std::vector<std::string> names;
  for (const Json& row : find(study, "/rows"))
    for (const Json& stage : find(row, "/stages"))
      if (const std::string name = text(find(stage, "/name"));
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  for (const std::string& name : names) columns.push_back({escaped(name), Align::right});
  Table table(std::move(columns), "scaling.json");
  for (const Json& row : find(study, "/rows")) {
    if (number(find(row, "/ended")) == 0) continue;
    std::vector<std::string> cells{escaped(text(find(row, "/series"))), count(find(row, "/ranks"))};
    for (const std::string& name : names) {
      std::string cell = "–";
      for (const Json& stage : find(row, "/stages"))
        if (text(find(stage, "/name")) == name)
          cell = fmt::format("{:.2f}",
                             number(find(stage, is_by_cpu(row) ? "/busy_cpu_seconds" : "/wall_seconds")));
      cells.push_back(cell);
    }
    table.add(cells);
  }
  return table.html();
}

std::string run_table(const Json& study) {
  Table table({{"run"},
               {"state"},
               {"code", Align::right},
               {"begun", Align::right},
               {"seconds", Align::right},
               {"hash"},
               {"host"},
               {"busy beside", Align::right, "processors that other programs used"},
               {"what it said"}},
              "scaling.json");
  for (const Json& run : find(study, "/runs")) {
    const std::string state = text(find(run, "/state"));
    const char* kind = state == "ended" ? "good" : state == "failed" ? "poor" : "plain";
    table.add(
        {name(find(run, "/name")), badge(kind, escaped(state)), count(find(run, "/exit_code")),
         count(find(run, "/attempts")), seconds(find(run, "/wall_seconds")),
         "<code>" + escaped(text(find(run, "/hash")).substr(0, 12)) + "</code>", name(find(run, "/host")),
         find(run, "/busy_beside").is_number() ? fmt::format("{:.1f}", number(find(run, "/busy_beside")))
                                               : "–",
         long_text(find(run, "/said"), 400)});
  }
  return table.html();
}

std::string machine_facts(const Json& study) {
  std::string links;
  for (const Json& link : find(study, "/machine/links")) links += (links.empty() ? "" : ", ") + name(link);
  return facts({{"host", name(find(study, "/machine/host"))},
                {"processor", name(find(study, "/machine/processor"))},
                {"processors of a node", count(find(study, "/machine/processors"))},
                {"memory of a node", memory(find(study, "/machine/memory_bytes"))},
                {"network interfaces", links},
                {"system", name(find(study, "/machine/system"))},
                {"versions", name(find(study, "/versions"))}});
}

std::string headline(const Json& study, const std::string& title) {
  double most_ranks = 0, efficiency = 0, rate = 0;
  for (const Json* row : rows_of_series(study, "strong")) {
    if (number(find(*row, "/ranks")) < most_ranks) continue;
    most_ranks = number(find(*row, "/ranks"));
    efficiency = number(find(*row, "/efficiency"));
    rate = number(find(*row, "/tetrahedra_per_second_and_core"));
  }
  const auto tile = [](const std::string& head, const std::string& value) {
    return fmt::format("<div class=\"tile\"><span>{}</span><b>{}</b></div>\n", head, value);
  };
  std::string tiles;
  if (most_ranks > 0)
    tiles = tile("ranks at most", fmt::format("{:.0f}", most_ranks)) +
            tile("efficiency there", percent(efficiency)) +
            tile("tetrahedra per second and core", quantity(rate));
  return fmt::format("<h1>Scaling of {}</h1>\n<div class=\"tiles\">\n{}</div>\n", escaped(title), tiles);
}

std::string remarks(const Json& study) {
  bool any_by_cpu = false, any_missing = false;
  for (const Json& row : find(study, "/rows")) {
    any_by_cpu = any_by_cpu || is_by_cpu(row);
    any_missing = any_missing || number(find(row, "/ended")) < number(find(row, "/runs"));
  }
  int busy_runs = 0;
  double most_beside = 0;
  for (const Json& run : find(study, "/runs")) {
    const double beside = number(find(run, "/busy_beside"));
    if (beside > busy_processors) ++busy_runs;
    most_beside = std::max(most_beside, beside);
  }
  std::string text = paragraph(
      "Seconds are those of the run with the median, or the mean of the two in the middle, from the start of "
      "its processes to the end. Speed-up is "
      "against "
      "one rank that makes the mesh in one piece, the best way through the program for one core; efficiency "
      "is speed-up "
      "over ranks, of the weak series tetrahedra per second and core over those of its smallest number of "
      "ranks.");
  if (any_by_cpu)
    text += paragraph(
        badge("fair", "CPU") +
        " More ranks than processors: rows marked so, and bars with a star, are judged by the CPU seconds "
        "of the busiest rank, "
        "summed over stages, without waiting. That is what balance and repeated work would allow, not "
        "what a clock has shown.");
  if (busy_runs > 0)
    text += paragraph(
        badge("fair", "busy") +
        fmt::format(
            " The machine was busy: during {} of the runs other programs used more than half a processor, "
            "up to {:.1f} of {} beside the ranks of the study. Seconds tell of that, too.",
            busy_runs, most_beside, count(find(study, "/machine/processors"))));
  if (any_missing)
    text += paragraph(badge("fair", "unfinished") + " Some runs have not ended well; see the list below.");
  return text;
}

}  // namespace

std::string study_page(const std::string& json) {
  const Json study = Json::parse(json);
  const std::string stem = std::filesystem::path(text(find(study, "/case"))).stem().string();
  const std::string body =
      headline(study, stem) + remarks(study) + section("charts", "Charts", charts(study)) +
      section("table", "Figures", row_table(study)) + prediction_table(study) +
      section("stages", "Seconds per stage", stage_table(study)) + section("runs", "Runs", run_table(study)) +
      section("machine", "Machine and versions", machine_facts(study)) +
      section("case", "Case",
              "<pre class=\"configuration\">" + long_text(find(study, "/subject")) + "</pre>\n");
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Aeroloom: scaling of {}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n{}</main>\n"
      "<footer>How to read this page: docs/scaling.md; all figures: scaling.json, "
      "scaling.csv.</footer>\n</body>\n</html>\n",
      escaped(stem), style_sheet(), body);
}

}  // namespace aeroloom::study
