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

/// What scripts for a queue and for other systems do after their variables are set. Nothing is filled in
/// here: what users and files give are values of variables (assignments()).
constexpr const char* body = R"sh(set -u
cd -- "$folder" || exit 7
mkdir -p -- "$run" || exit 7
# What an earlier attempt has kept is gone on from. What it has reported is not of this one.
line=$fresh
[ ! -d "$run/checkpoint" ] || line=$resumed
rm -f -- "$run/report.json"
echo "begin $(date +%s.%N) ${SLURM_JOB_ID:-$$} $(hostname)" >> "$run/marks"
own=$(mktemp -d) || exit 7
trap 'rm -rf -- "$own"' EXIT
over=
# Asked to end: so is all that the launcher has started, and the run says where it stands. Whichever of the two
# comes first, the word or the number of the launcher's process, the other finds it.
tell() {
  over=$1
  : > "$own/told"
  kill -TERM -- "-$(cat "$own/process" 2> /dev/null)" 2> /dev/null
}
trap 'tell time' USR1
trap 'tell end' TERM
# The launcher is a line of a shell: with several commands, none is begun after the word.
launch='trap '\''exit "$?"'\'' TERM USR1
echo "$$" > "$1/process"
[ ! -e "$1/told" ] || exit 143
eval "$2"'
# A shell of its own takes down the run's code: bash loses it where a signal interrupts its wait for a run
# that ends at that moment.
(
  trap : USR1 TERM
  setsid bash -c "$launch" bash "$own" "$line" > "$run/log" 2>&1 < /dev/null
  echo "$?" > "$own/code"
) &
started=$!
while kill -0 "$started" 2> /dev/null; do wait "$started"; done
# That shell was killed where it left none.
code=$(cat "$own/code" 2> /dev/null || echo 137)
# Told before the launcher had begun anything.
[ -z "$over" ] || [ "$code" -ne 0 ] || [ -e "$run/report.json" ] || code=143
echo "end $(date +%s.%N) $code" >> "$run/marks"
if [ -n "$script" ] && [ "$over" = time ] && [ "$(grep -c '^begin' "$run/marks")" -lt 20 ]; then
  id=$(sbatch --parsable "$script") && echo "$name ${id%%;*}" >> "$submitted" && echo "time is over; goes on as job $id"
fi
tail -n 3 -- "$run/log"
if [ "$code" -ne 0 ]; then
  printf '%s\n' "$name ended with $code; it goes on from its checkpoints with: $command --resume"
elif [ ! -e "$run/report.json" ]; then
  printf '%s\n' "$name ended with 0 without a report: see the launcher and the log, $run/log"
  code=7
fi
exit "$code"
)sh";

constexpr const char* head_of_submit = R"sh(#!/bin/sh
# Submits what has not been submitted yet, and notes the jobs.
set -eu
submit() {
  if grep -q "^$1 " "$submitted" 2> /dev/null; then return; fi
  id=$(sbatch --parsable "$2")
  echo "$1 ${id%%;*}" >> "$submitted"
}
)sh";

/// One run as a job.
struct Job {
  std::string name;
  std::string run_folder, script, submitted;
  std::vector<std::string> command;
  int ranks = 1, nodes = 1, ranks_on_node = 1;
  double minutes = 0, megabytes = 0;  ///< of memory, on a node
};

/// `script`: submits itself when its time is over; empty: it does not.
std::string script_text(const Job& job, const Launcher& launcher, const std::string& script) {
  const auto line = [&](const char* option) {
    std::vector<std::string> words = job.command;
    words.emplace_back(option);
    return launcher.line(job.ranks, job.nodes, words);
  };
  return assignments({{"name", job.name},
                      {"folder", fs::current_path().string()},
                      {"run", job.run_folder},
                      {"command", quoted(job.command)},
                      {"fresh", line("--checkpoints")},
                      {"resumed", line("--resume")},
                      {"script", script},
                      {"submitted", job.submitted}}) +
         body;
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
  const bool is_given = !jobs.launcher.empty();
  const Launcher in_queue = is_given ? make_launcher(jobs.launcher) : srun_launcher();
  const Launcher elsewhere = is_given ? in_queue : mpirun_launcher();
  std::map<std::vector<std::string>, CaseForecast> known;  // repeats and numbers of ranks share one
  const std::string submitted = (jobs.folder / submitted_name).string();
  std::string submit = head_of_submit + assignments({{"submitted", submitted}});
  for (const RunSpec& run : record.runs) {
    const fs::path run_folder = folder_of(options.directory, run);
    if (is_done(record, result_of(options.directory, run))) continue;
    if (known.count(run.settings) == 0) known[run.settings] = forecast(run.settings);
    const CaseForecast& size = known[run.settings];
    Job job{run.name(),
            run_folder.string(),
            (jobs.folder / (run.name() + ".slurm")).string(),
            submitted,
            command_of(options, run),
            run.ranks,
            nodes_for(run.ranks, options.ranks_per_node)};
    job.ranks_on_node = (run.ranks + job.nodes - 1) / job.nodes;
    job.minutes = std::max(least_minutes, more_time * size.seconds / run.ranks / 60);
    job.megabytes = more_memory * size.bytes * job.ranks_on_node / run.ranks / bytes_per_megabyte +
                    least_megabytes_of_rank * job.ranks_on_node;
    write_script(
        job.script,
        fmt::format("#!/bin/bash\n#SBATCH --job-name={}\n#SBATCH --nodes={}\n#SBATCH --ntasks={}\n"
                    "#SBATCH --ntasks-per-node={}\n#SBATCH --time={}\n#SBATCH --mem={:.0f}M\n"
                    "#SBATCH --output={}\n#SBATCH --open-mode=append\n#SBATCH --signal=B:USR1@120\n{}",
                    job.name, job.nodes, job.ranks, job.ranks_on_node, hours(job.minutes), job.megabytes,
                    quoted_for_queue((jobs.folder / (job.name + ".out")).string()), jobs.header) +
            script_text(job, in_queue, job.script));
    write_script(
        jobs.folder / (job.name + ".sh"),
        fmt::format(
            "#!/bin/bash\n# For other systems: {} rank(s) on {} node(s), {:.0f} MiB a node, {:.0f} min.\n",
            job.ranks, job.nodes, job.megabytes, job.minutes) +
            script_text(job, elsewhere, ""));
    submit += fmt::format("submit {}\n", quoted({job.name, job.script}));
  }
  write_script(jobs.folder / "submit.sh", submit);
  write_file(jobs.folder / results_name, options.directory.string() + "\n");
}

fs::path results_of_jobs(const fs::path& folder) {
  std::string text = read_file(folder / results_name);
  if (text.ends_with('\n')) text.pop_back();
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
    // Others are no ids, and sacct would answer for none.
    if (id.find_first_not_of("0123456789_") == std::string::npos) ids += (ids.empty() ? "" : ",") + id;
  }
  const fs::path answer = folder / "sacct";
  const Ended ended = ids.empty()
                          ? Ended{}
                          : run_line("exec " + quoted({"sacct", "--noheader", "--parsable2", "--allocations",
                                                       "--format=JobID,State,ExitCode", "--jobs=" + ids}),
                                     answer);
  std::map<std::string, std::string> states;
  if (ended.code == 0 && !ids.empty()) {
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
