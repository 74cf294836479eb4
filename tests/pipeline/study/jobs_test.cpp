#include "pipeline/study/jobs.hpp"

#include "tests/pipeline/study/studies.hpp"

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
  EXPECT_EQ(run_line("bash -n " + (jobs.folder / "strong_8_1.slurm").string(), folder.path / "log").code, 0);
  EXPECT_EQ(run_line("sh -n " + (jobs.folder / "submit.sh").string(), folder.path / "log").code, 0);
}

/// A script of a job with another program in the place of ours, and what it leaves.
class ScriptOfJob : public ::testing::Test {
protected:
  int run(const std::string& program) {
    write_file(folder.path / "program", "#!/bin/sh\n" + program);
    std::filesystem::permissions(folder.path / "program", std::filesystem::perms::owner_all);
    StudyRecord study = a_study(folder.path / "out", {1}, 1);
    study.options.program = (folder.path / "program").string();
    study.runs = {study.runs[1]};
    write_jobs(study, {folder.path / "jobs", "", "env RANKS={ranks} {command}"},
               [](const std::vector<std::string>&) {
                 return CaseForecast{1, 1, 1};
               });
    // sbatch, as far as the script needs it.
    write_file(folder.path / "bin" / "sbatch", "#!/bin/sh\necho 4711\n");
    std::filesystem::permissions(folder.path / "bin" / "sbatch", std::filesystem::perms::owner_all);
    const std::string path = "PATH=" + (folder.path / "bin").string() + ":$PATH ";
    const int code =
        run_line(path + "bash " + (folder.path / "jobs" / "strong_1_1.slurm").string(), folder.path / "said")
            .code;
    marks = read_marks(folder_of(study.options.directory, study.runs[0]));
    return code;
  }
  /// The script is the parent of the shell that the program is started by.
  inline static const std::string tell_script =
      "read -r _ _ _ script _ < /proc/$PPID/stat\nkill -USR1 $script\n";

  std::string said() const { return read_file(folder.path / "said"); }

  StudyFolder folder{"script"};
  RunMarks marks;
};

TEST_F(ScriptOfJob, LeavesMarksAndKeepsCheckpoints) {
  EXPECT_EQ(run("case \"$*\" in *--checkpoints) exit 0 ;; *) exit 9 ;; esac\n"), 0);
  EXPECT_EQ(marks.state, RunState::ended);
}

TEST_F(ScriptOfJob, GoesOnFromCheckpoints) {
  std::filesystem::create_directories(folder.path / "out" / "runs" / "strong_1_1" / "checkpoint");
  EXPECT_EQ(run("case \"$*\" in *--resume) exit 0 ;; *) exit 9 ;; esac\n"), 0);
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
