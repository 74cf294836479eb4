#include "pipeline/study/comparison.hpp"

#include "pipeline/report/page/html_text.hpp"
#include "pipeline/study/text_files.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::study {

using namespace page;

Json read_study(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error(fmt::format(
        "'{}' is not the scaling.json of a study: {}. Remedy: 'aeroloom scaling' with the study's case, "
        "or --collect, writes it anew",
        file.string(), what));
  };
  const auto require = [&](const Json& row, std::size_t number, const char* key, bool is_text) {
    const auto found = row.is_object() ? row.find(key) : row.end();
    if (!row.is_object() || found == row.end() || (is_text ? !found->is_string() : !found->is_number()))
      refuse(fmt::format("rows[{}] has no {} '{}'", number, is_text ? "text" : "number", key));
  };
  Json study = read_json(file);
  const Json& rows = find(study, "/rows");
  if (!rows.is_array()) refuse("it has no list 'rows'");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    require(rows[i], i, "series", true);
    require(rows[i], i, "judged_by", true);
    for (const char* key : {"ranks", "ended"}) require(rows[i], i, key, false);
    if (number(find(rows[i], "/ended")) == 0) continue;
    for (const char* key : {"wall_seconds", "busy_cpu_seconds", "efficiency"})
      require(rows[i], i, key, false);
    require(rows[i], i, "hash", true);
  }
  return study;
}

std::string compare_text(const Json& before, const Json& after) {
  std::string out = fmt::format("{:<7} {:>6} {:>10} {:>10} {:>8} {:>11} {:>11}  {}\n", "series", "ranks",
                                "old s", "new s", "ratio", "old eff.", "new eff.", "mesh");
  int found = 0;
  for (const Json& now : find(after, "/rows")) {
    for (const Json& then : find(before, "/rows")) {
      if (find(then, "/series") != find(now, "/series") || find(then, "/ranks") != find(now, "/ranks"))
        continue;
      if (number(find(then, "/ended")) == 0 || number(find(now, "/ended")) == 0) continue;
      // The clock is compared with the clock: what one study judges by CPU the other is asked for, too.
      const auto is_by_cpu_in = [](const Json& row) { return text(find(row, "/judged_by")) == "cpu"; };
      const char* key = is_by_cpu_in(now) || is_by_cpu_in(then) ? "/busy_cpu_seconds" : "/wall_seconds";
      const double old_seconds = number(find(then, key)), new_seconds = number(find(now, key));
      out += fmt::format("{:<7} {:>6.0f} {:>10.2f} {:>10.2f} {:>8.3f} {:>10.0f}% {:>10.0f}%  {}\n",
                         text(find(now, "/series")), number(find(now, "/ranks")), old_seconds, new_seconds,
                         old_seconds > 0 ? new_seconds / old_seconds : 0,
                         100 * number(find(then, "/efficiency")), 100 * number(find(now, "/efficiency")),
                         find(then, "/hash") == find(now, "/hash") ? "the same" : "another");
      ++found;
    }
  }
  return found > 0 ? out : "the two studies have no finished runs of one series on one number of ranks\n";
}

}  // namespace aeroloom::study
