#include "pipeline/study/jobs.hpp"

#include "pipeline/study/results.hpp"
#include "pipeline/study/text_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

namespace aeroloom::study {

namespace fs = std::filesystem;

namespace {

// A job that is ended by its limit is lost, one that asks for too much only waits: four times the time and
// half as much again of the memory predicted, and of memory what the program has before the first element.
// Chosen, not measured.
constexpr double least_minutes = 10, more_time = 4;
constexpr double more_memory = 1.5, least_megabytes_of_rank = 512;
constexpr double bytes_per_megabyte = 1048576;
constexpr const char* results_name = "results";
constexpr const char* submitted_name = "submitted";

/// Scripts for a queue and for a shell share what they do; only how a run is signalled that its time is over
/// is the queue's.
constexpr const char* body = R"sh(
set -u
cd {folder}
run={run}
mkdir -p "$run"
# What an earlier attempt has kept is gone on from.
keep=--checkpoints
[ -d "$run/checkpoint" ] && keep=--resume
echo "begin $(date +%s.%N) ${{SLURM_JOB_ID:-$$}} $(hostname)" >> "$run/marks"
own=$(mktemp -d) || exit 1
trap 'rm -rf "$own"' EXIT
over=
# Asked to end: so is the run, which says where it stands. Whichever of the two comes first, the word or the
# number of the run's process, the other finds it.
tell() {{ over=$1; : > "$own/told"; kill -TERM "$(cat "$own/process" 2> /dev/null)" 2> /dev/null; }}
trap 'tell time' USR1
trap 'tell end' TERM
# A shell of its own takes down the run's code: bash loses it where a signal interrupts its wait for a run
# that ends at that moment.
(
  trap : USR1 TERM
  ( echo "$BASHPID" > "$own/process"; [ ! -e "$own/told" ] || exit 143; exec {line} ) > "$run/log" 2>&1
  echo "$?" > "$own/code"
) &
started=$!
while kill -0 "$started" 2> /dev/null; do wait "$started"; done
# That shell was killed where it left none.
code=$(cat "$own/code" 2> /dev/null || echo 137)
echo "end $(date +%s.%N) $code" >> "$run/marks"
{again}
tail -n 3 "$run/log"
if [ "$code" -ne 0 ]; then
  echo "{name} ended with $code; it goes on from its checkpoints with: {command} --resume"
fi
exit "$code"
)sh";

constexpr const char* again =
    R"sh(if [ "$over" = time ] && [ "$(grep -c '^begin' "$run/marks")" -lt 20 ]; then
  id=$(sbatch --parsable {script}) && echo "{name} ${{id%%;*}}" >> {submitted} && echo "time is over; goes on as job $id"
fi)sh";

std::string line_for(const Launcher& launcher, const RunSpec& run, int nodes, const std::string& command) {
  // The command is a text for the shell already.
  std::string line = launcher.line(run.ranks, nodes, {"\x01"});
  const std::string placed = "'\x01'";
  const std::size_t at = line.find(placed);
  return line.replace(at, placed.size(), command);
}

std::string hours(double minutes) {
  const auto all = static_cast<int>(std::ceil(minutes));
  return fmt::format("{:02}:{:02}:00", all / 60, all % 60);
}

void write_script(const fs::path& file, const std::string& text) {
  write_file(file, text);
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
}

}  // namespace

void write_jobs(const StudyRecord& record, const JobOptions& jobs,
                const std::function<CaseForecast(const std::vector<std::string>&)>& forecast) {
  const StudyOptions& options = record.options;
  const Launcher launcher =
      jobs.launcher.empty()
          ? Launcher{"srun --mpi=pmix --kill-on-bad-exit --nodes={nodes} --ntasks={ranks} {command}", true}
          : make_launcher(jobs.launcher);
  std::map<std::vector<std::string>, CaseForecast> known;  // repeats and numbers of ranks share one
  std::string submit = "#!/bin/sh\n# Submits what has not been submitted yet, and notes the jobs.\nset -eu\n";
  const fs::path submitted = jobs.folder / submitted_name;
  for (const RunSpec& run : record.runs) {
    if (read_marks(folder_of(options.directory, run)).state == RunState::ended) continue;
    if (known.count(run.settings) == 0) known[run.settings] = forecast(run.settings);
    const CaseForecast& size = known[run.settings];
    const int nodes = nodes_for(run.ranks, options.ranks_per_node);
    const int on_node = (run.ranks + nodes - 1) / nodes;
    const double minutes = std::max(least_minutes, more_time * size.seconds / run.ranks / 60);
    const double megabytes = more_memory * size.bytes * on_node / run.ranks / bytes_per_megabyte +
                             least_megabytes_of_rank * on_node;
    const std::string name = run.name();
    const fs::path script = jobs.folder / (name + ".slurm");
    const std::string command = quoted(command_of(options, run));
    const std::string line = line_for(launcher, run, nodes, command + " $keep");
    const auto text = [&](const std::string& resubmit) {
      return fmt::format(fmt::runtime(body),
                         fmt::arg("run", quoted(folder_of(options.directory, run).string())),
                         fmt::arg("folder", quoted(fs::current_path().string())), fmt::arg("line", line),
                         fmt::arg("again", resubmit), fmt::arg("name", name), fmt::arg("command", command));
    };
    write_script(
        script,
        fmt::format("#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --nodes={}\n#SBATCH --ntasks={}\n"
                    "#SBATCH --ntasks-per-node={}\n#SBATCH --time={}\n#SBATCH --mem={:.0f}M\n"
                    "#SBATCH --output={}\n#SBATCH --open-mode=append\n#SBATCH --signal=B:USR1@120\n{}",
                    name, nodes, run.ranks, on_node, hours(minutes), megabytes,
                    quoted((jobs.folder / (name + ".out")).string()), jobs.header) +
            text(fmt::format(fmt::runtime(again), fmt::arg("script", quoted(script.string())),
                             fmt::arg("name", name), fmt::arg("submitted", quoted(submitted.string())))));
    write_script(
        jobs.folder / (name + ".sh"),
        fmt::format(
            "#!/bin/bash\n# For other systems: {} rank(s) on {} node(s), {:.0f} MiB a node, {:.0f} min.\n",
            run.ranks, nodes, megabytes, minutes) +
            text(""));
    submit += fmt::format(
        "grep -q '^{0} ' {1} 2> /dev/null || {{ id=$(sbatch --parsable {2}); echo \"{0} ${{id%%;*}}\" >> "
        "{1}; }}\n",
        name, quoted(submitted.string()), quoted(script.string()));
  }
  write_script(jobs.folder / "submit.sh", submit);
  write_file(jobs.folder / results_name, options.directory.string() + "\n");
}

fs::path results_of_jobs(const fs::path& folder) {
  std::string text = read_file(folder / results_name);
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

namespace {

/// The last that the queue wrote of a job's end into what the job printed, or nothing.
std::string last_word_of_queue(const fs::path& printed) {
  std::ifstream lines(printed);
  std::string word;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find("CANCELLED AT ");
    if (line.find("error: *** ") == std::string::npos || begin == std::string::npos) continue;
    word = line.substr(begin, line.find_first_of(",*", begin) - begin);
    word.erase(word.find_last_not_of(' ') + 1);
  }
  return word;
}

}  // namespace

std::map<std::string, std::string> query_queue(const fs::path& folder) {
  std::map<std::string, std::string> jobs, of_runs;
  std::ifstream file(folder / submitted_name);
  std::string ids;
  for (std::string name, id; file >> name >> id;) {
    jobs[name] = id;  // the last counts
    ids += (ids.empty() ? "" : ",") + id;
  }
  if (ids.empty()) return of_runs;
  const fs::path answer = folder / "sacct";
  const Ended ended = run_line(
      "exec sacct --noheader --parsable2 --allocations --format=JobID,State,ExitCode --jobs=" + ids, answer);
  std::map<std::string, std::string> states;
  if (ended.code == 0) {
    std::ifstream lines(answer);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t bar = line.find('|');
      if (bar == std::string::npos) continue;
      std::string state = line.substr(bar + 1);
      std::replace(state.begin(), state.end(), '|', ' ');
      states[line.substr(0, bar)] = state;
    }
  }
  for (const auto& [name, id] : jobs) {
    std::string state = states.count(id) > 0 ? states[id] : last_word_of_queue(folder / (name + ".out"));
    of_runs[name] =
        fmt::format("job {}{}{}", id, state.empty() ? ", of which sacct says nothing" : " ", state);
  }
  return of_runs;
}

}  // namespace aeroloom::study
