#include "pipeline/study/jobs.hpp"

#include "tests/pipeline/study/studies.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

TEST(Jobs, AskForWhatIsPredicted) {
  const StudyFolder folder("jobs");
  StudyRecord study = a_study(folder.path / "out", {8}, 1);
  study.options.ranks_per_node = 4;
  const JobOptions jobs{folder.path / "jobs", "#SBATCH --account=wing\n", {}};
  write_jobs(study, jobs, [](const std::vector<std::string>&) { return CaseForecast{1e6, 36000, 8e9}; });
  const std::string script = read_file(jobs.folder / "strong_8_1.slurm");
  for (const char* line :
       {"#SBATCH --nodes=2", "#SBATCH --ntasks=8", "#SBATCH --ntasks-per-node=4", "#SBATCH --time=05:00:00",
        "#SBATCH --account=wing", "#SBATCH --signal=B:USR1@120",
        "srun --mpi=pmix --kill-on-bad-exit --nodes=2 --ntasks=8 /opt/aeroloom run /cases/wing.yaml"})
    EXPECT_NE(script.find(line), std::string::npos) << line << "\n" << script;
  EXPECT_NE(read_file(jobs.folder / "serial_1_1.slurm").find("--time=40:00:00"), std::string::npos);
  EXPECT_EQ(results_of_jobs(jobs.folder), folder.path / "out");
  const std::string elsewhere = read_file(jobs.folder / "strong_8_1.sh");
  EXPECT_NE(elsewhere.find("mpirun"), std::string::npos) << elsewhere;
  EXPECT_EQ(elsewhere.find("srun"), std::string::npos) << "SLURM's, on other systems\n" << elsewhere;
  EXPECT_EQ(run_line("bash -n " + (jobs.folder / "strong_8_1.slurm").string(), folder.path / "log").code, 0);
  EXPECT_EQ(run_line("sh -n " + (jobs.folder / "submit.sh").string(), folder.path / "log").code, 0);
}

/// A script of a job with another program in the place of ours, and what it leaves.
class ScriptOfJob : public ::testing::Test {
protected:
  void SetUp() override {
    // sbatch and srun, as far as the scripts need them.
    write_program("bin/sbatch", "echo 4711\n");
    write_program("bin/srun", "while case $1 in --*) ;; *) false ;; esac; do shift; done\nexec \"$@\"\n");
  }

  void write_program(const std::string& name, const std::string& text) const {
    write_file(folder.path / name, "#!/bin/sh\n" + text);
    std::filesystem::permissions(folder.path / name, std::filesystem::perms::owner_all);
  }
  int run_script(const std::filesystem::path& script) const {
    return run_line(
               "PATH=" + quoted((folder.path / "bin").string()) + ":$PATH bash " + quoted(script.string()),
               folder.path / "said")
        .code;
  }
  int run(const std::string& program, const std::string& launcher = "env RANKS={ranks} {command}") {
    write_program("program", program);
    StudyRecord study = a_study(folder.path / "out", {1}, 1);
    study.options.program = (folder.path / "program").string();
    study.runs = {study.runs[1]};
    write_jobs(study, {folder.path / "jobs", "", launcher}, [](const std::vector<std::string>&) {
      return CaseForecast{1, 1, 1};
    });
    const int code = run_script(folder.path / "jobs" / "strong_1_1.slurm");
    marks = read_marks(folder_of(study.options.directory, study.runs[0]));
    return code;
  }
  /// The script is two shells above the one that the program is started by.
  inline static const std::string tell_script =
      "read -r _ _ _ above _ < /proc/$PPID/stat\nread -r _ _ _ script _ < /proc/$above/stat\n"
      "kill -USR1 $script\n";
  /// What a run leaves that ends well; the current folder is the test's.
  std::string leave_report() const {
    return ": > " + (folder.path / "out/runs/strong_1_1/report.json").string() + "\n";
  }

  std::string said() const { return read_file(folder.path / "said"); }

  StudyFolder folder{"script"};
  RunMarks marks;
};

TEST_F(ScriptOfJob, LeavesMarksAndKeepsCheckpoints) {
  EXPECT_EQ(run(leave_report() + "case \"$*\" in *--checkpoints) exit 0 ;; *) exit 9 ;; esac\n"), 0)
      << said();
  EXPECT_EQ(marks.state, RunState::ended);
}

TEST_F(ScriptOfJob, GoesOnFromCheckpoints) {
  std::filesystem::create_directories(folder.path / "out" / "runs" / "strong_1_1" / "checkpoint");
  EXPECT_EQ(run(leave_report() + "case \"$*\" in *--resume) exit 0 ;; *) exit 9 ;; esac\n"), 0) << said();
}

TEST_F(ScriptOfJob, NamesWhatGoesOn) {
  EXPECT_EQ(run("echo 'error: stage volume failed'; exit 5\n"), 5);
  EXPECT_EQ(marks.code, 5);
  EXPECT_NE(said().find("stage volume failed"), std::string::npos) << said();
  EXPECT_NE(said().find("strong_1_1 ended with 5; it goes on from its checkpoints with:"), std::string::npos)
      << said();
}

TEST_F(ScriptOfJob, SubmitsItselfWhenItsTimeIsOver) {
  EXPECT_EQ(run("trap 'exit 143' TERM\n" + tell_script + "sleep 20 & wait\n"), 143);
  EXPECT_EQ(marks.code, 143);
  EXPECT_NE(said().find("time is over; goes on as job 4711"), std::string::npos) << said();
  EXPECT_EQ(read_file(folder.path / "jobs" / "submitted"), "strong_1_1 4711\n");
}

TEST_F(ScriptOfJob, HasTheCodeOfARunThatEndsAtOnce) {
  // Whether the signal or the end of the run comes first to the script is left to chance.
  for (int i = 0; i < 5; ++i) EXPECT_EQ(run("trap '' TERM\n" + tell_script + "exit 3\n"), 3) << said();
}

TEST_F(ScriptOfJob, TakesAnyLineOfAShellAsLauncher) {
  const std::string program = leave_report() + "echo \"$RANKS\" > ranks\n";
  const std::string ranks = "cd " + quoted(folder.path.string()) + "; ";
  for (const char* launcher : {"RANKS={ranks} {command}", "RANKS={ranks}; export RANKS; {command}",
                               "RANKS={ranks} sh -c '{command}'", "RANKS={ranks} sh -c \"exec {command}\"",
                               "echo {command}; RANKS={ranks} {command} # and {command}"}) {
    EXPECT_EQ(run(program, ranks + launcher), 0) << launcher << "\n" << said();
    EXPECT_EQ(read_file(folder.path / "ranks"), "1\n") << launcher;
    std::filesystem::remove(folder.path / "ranks");
    EXPECT_EQ(read_file(folder.path / "jobs" / "strong_1_1.slurm").find('\x01'), std::string::npos);
    EXPECT_EQ(run("exit 5\n", ranks + "RANKS={ranks} {command}"), 5);
  }
}

TEST_F(ScriptOfJob, BeginsNothingMoreOnceItsTimeIsOver) {
  EXPECT_EQ(run("trap 'exit 143' TERM\n" + tell_script + "sleep 20 & wait\n",
                "RANKS={ranks} {command}; touch " + quoted((folder.path / "more").string())),
            143);
  EXPECT_FALSE(std::filesystem::exists(folder.path / "more"));
}

TEST_F(ScriptOfJob, SaysThatARunLeftNoReport) {
  EXPECT_EQ(run("exit 0\n"), 7);
  EXPECT_NE(said().find("strong_1_1 ended with 0 without a report"), std::string::npos) << said();
  EXPECT_EQ(marks.code, 0);
}

/// What would leave a file if a shell took it for more than a name.
constexpr const char* hostile = "a b'c\"d$(touch executed)`touch executed`;touch executed #&\\e%j*";

TEST_F(ScriptOfJob, ExecutesNoNameOfAUserOrAFile) {
  namespace fs = std::filesystem;
  const fs::path before = fs::current_path(), here = folder.path / hostile;
  fs::create_directories(here);
  fs::current_path(here);
  const std::string break_line = "\ntouch executed\n";
  StudyRecord study = a_study(here / ("out" + break_line), {1}, 1);
  study.options.program = (here / "program").string();
  study.options.case_file = (here / ("case" + break_line)).string();
  study.options.overrides = {std::string("a=") + hostile, "b=$(touch executed)"};
  study.runs = {study.runs[1]};
  // Fails, so that the script prints how it goes on, and keeps what it was called with.
  write_program(std::string(hostile) + "/program", "printf '%s\\0' \"$@\" > \"$0.words\"\nexit 5\n");
  const fs::path jobs = here / "jobs";
  for (const std::string launcher : {"", "mpirun -n {ranks} {command}", "RANKS={ranks} sh -c '{command}'",
                                     "RANKS={ranks} sh -c \"{command}; exit \\$?\"; exit $? # {command}"}) {
    write_program("bin/mpirun", "shift 2\nexec \"$@\"\n");
    write_jobs(study, {jobs, "", launcher}, [](const std::vector<std::string>&) {
      return CaseForecast{1, 1, 1};
    });
    for (const char* script : {"strong_1_1.slurm", "strong_1_1.sh"}) {
      EXPECT_EQ(run_script(jobs / script), 5) << launcher << "\n" << said();
      std::string words;
      for (const std::string& word : command_of(study.options, study.runs[0]))
        if (word != study.options.program) words += word + '\0';
      EXPECT_EQ(read_file(here / "program.words"), words + "--checkpoints" + '\0') << launcher;
      fs::remove(here / "program.words");
    }
    // What it says how to go on with, is that.
    const std::string line = said().substr(said().find("from its checkpoints with: ") + 27);
    EXPECT_EQ(run_line(line, folder.path / "log").code, 5) << line;
    EXPECT_TRUE(read_file(here / "program.words").ends_with(std::string("--resume") + '\0')) << line;
  }
  EXPECT_EQ(run_script(jobs / "submit.sh"), 0) << said();
  EXPECT_EQ(read_file(jobs / "submitted"), "strong_1_1 4711\n");
  write_file(jobs / "submitted", "strong_1_1 1;touch${IFS}executed\n$(touch 7\n");
  EXPECT_EQ(query_queue(jobs).at("strong_1_1"), "job 1;touch${IFS}executed, of which sacct says nothing");
  fs::current_path(before);
  for (const fs::directory_entry& each : fs::recursive_directory_iterator(folder.path))
    EXPECT_NE(each.path().filename(), "executed") << each.path();
  EXPECT_FALSE(fs::exists("executed"));
}

TEST(Jobs, NameNoFolderThatAQueueWouldReadAsMore) {
  const StudyFolder folder("break");
  const StudyRecord study = a_study(folder.path / "out", {1}, 1);
  const auto forecast = [](const std::vector<std::string>&) { return CaseForecast{1, 1, 1}; };
  EXPECT_THROW(write_jobs(study, {folder.path / "jobs\ntouch executed", "", ""}, forecast),
               std::invalid_argument);
  write_jobs(study, {folder.path / "a \"b\" %j\\", "", ""}, forecast);
  EXPECT_NE(read_file(folder.path / "a \"b\" %j\\" / "strong_1_1.slurm")
                .find("a \\\"b\\\" %%j\\\\/strong_1_1.out\""),
            std::string::npos);
}

TEST(Jobs, TellWhatTheQueueWroteOfTheirEnd) {
  // No such jobs are known to any queue here.
  const StudyFolder folder("queue");
  write_file(folder.path / "submitted", "strong_4_1 99999998\nstrong_4_2 99999999\n");
  write_file(
      folder.path / "strong_4_1.out",
      "a line\nslurmstepd-node1: error: *** JOB 1 ON node1 CANCELLED AT 2026-11-25T09:46:29 DUE TO NODE "
      "FAILURE, SEE SLURMCTLD LOG FOR DETAILS ***\nlast words\n");
  const std::map<std::string, std::string> said = query_queue(folder.path);
  EXPECT_EQ(said.at("strong_4_1"), "job 99999998 CANCELLED AT 2026-11-25T09:46:29 DUE TO NODE FAILURE");
  EXPECT_EQ(said.at("strong_4_2"), "job 99999999, of which sacct says nothing");
}

}  // namespace
}  // namespace aeroloom::study
