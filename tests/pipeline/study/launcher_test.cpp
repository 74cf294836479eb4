#include "pipeline/study/launcher.hpp"

#include "tests/pipeline/study/studies.hpp"

#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

TEST(Launcher, FillsItsPattern) {
  const Launcher launcher = make_launcher("srun -N {nodes} -n {ranks} nice {command}");
  EXPECT_EQ(launcher.line(8, 2, {"/opt/aeroloom", "run", "it's a case.yaml"}),
            "srun -N 2 -n 8 nice /opt/aeroloom run 'it'\\''s a case.yaml'");
  EXPECT_EQ(launcher.line(1, 1, {"x"}), "srun -N 1 -n 1 nice x");
  EXPECT_EQ((Launcher{"mpirun -n {ranks} {command}", false}.line(1, 1, {"x", "a b"})), "exec x 'a b'");
}

TEST(Launcher, RefusesPatternsThatStartNothing) {
  EXPECT_THROW(make_launcher("mpirun {command}"), std::invalid_argument);
  EXPECT_THROW(make_launcher("mpirun -n {ranks}"), std::invalid_argument);
  // Where a name cannot be quoted.
  for (const char* pattern :
       {"x {ranks} `{command}`", "x {ranks} \"`{command}`\"", "x {ranks} sh -c \"ssh host '{command}'\"",
        "x {ranks} sh -c 'ssh host \"{command}\"'", "x {ranks} sh -c \"ssh host \\\"{command}\\\"\"",
        "x {ranks} <<EOF\n{command}\nEOF"})
    EXPECT_THROW(make_launcher(pattern), std::invalid_argument) << pattern;
}

TEST(Launcher, GivesNamesToShellsWithinTheLine) {
  const StudyFolder folder("quotes");
  const std::string name = "a'b\"c$(exit 1)`exit 1`\\ \n#;d";
  for (const char* pattern :
       {"x={ranks}; {command}", "x={ranks} sh -c '{command}'", "x={ranks} sh -c \"{command}\"",
        "x={ranks}; echo \"$({command})\"", "x=\"'{ranks}'\" y=$((1 + (2))) {command} # '{command}'",
        "x=\"$(echo \")\")\" sh -c '{command}' \\' {ranks}"}) {
    const Ended ended =
        run_line(make_launcher(pattern).line(1, 1, {"printf", "%s", name}), folder.path / "log");
    EXPECT_EQ(ended.code, 0) << pattern;
    std::string said = read_file(folder.path / "log");
    if (said.ends_with('\n')) said.pop_back();
    EXPECT_EQ(said, name) << pattern;
  }
}

TEST(Launcher, TellsHowALineEnded) {
  const StudyFolder folder("lines");
  const std::filesystem::path log = folder.path / "log";
  EXPECT_EQ(run_line("echo said; echo wrong >&2; exit 3", log).code, 3);
  EXPECT_EQ(read_file(log), "said\nwrong\n");
  EXPECT_EQ(run_line("kill -9 $$", log).code, 128 + 9);
}

TEST(Launcher, GivesOnTheFirstEnvironment) {
  const StudyFolder folder("environment");
  ::setenv("AEROLOOM_ADDED_LATER", "1", 1);
  EXPECT_EQ(run_line("echo \"${AEROLOOM_ADDED_LATER-unset}\"; test -n \"$PATH\"", folder.path / "log").code,
            0);
  EXPECT_EQ(read_file(folder.path / "log"), "unset\n");
}

TEST(Launcher, EndsALineWithAllThatItStarted) {
  const StudyFolder folder("ended");
  std::thread other([&] {
    while (!std::filesystem::exists(folder.path / "begun"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    end_line();
  });
  const std::string begun = (folder.path / "begun").string();
  const Ended ended =
      run_line("sleep 100 & echo $! > " + begun + ".part; mv " + begun + ".part " + begun + "; wait",
               folder.path / "log");
  other.join();
  EXPECT_GE(ended.code, 128);
  EXPECT_LT(ended.seconds, 30);
  const std::string child = read_file(begun);
  EXPECT_FALSE(std::filesystem::exists("/proc/" + child.substr(0, child.find('\n')) + "/cwd/"));
}

TEST(Launcher, WaitsForRanksInGroupsOfTheirOwn) {
  const StudyFolder folder("ranks");
  const std::string rank = (folder.path / "rank").string();
  std::thread other([&] {
    while (!std::filesystem::exists(rank)) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    end_line();
    const std::string process = read_file(rank);
    EXPECT_FALSE(std::filesystem::exists("/proc/" + process.substr(0, process.find('\n')) + "/cwd/"));
  });
  // The launcher hands the signal on and is gone at once; its rank takes its time.
  const std::string launcher = fmt::format(
      "set -m\n(trap 'sleep 0.7; exit' TERM; echo $BASHPID > {0}.part; mv {0}.part {0}; while :; do sleep "
      "0.05; done) &\n"
      "trap \"kill -TERM $!; exit 3\" TERM\nwait",
      rank);
  EXPECT_EQ(run_line("exec bash -c " + quoted(launcher), folder.path / "log").code, 3);
  other.join();
}

TEST(Launcher, EndsWhatALineLeftThatASignalEnded) {
  const StudyFolder folder("left");
  const std::string begun = (folder.path / "begun").string();
  EXPECT_EQ(run_line("sleep 100 & echo $! > " + begun + "; kill -9 $$", folder.path / "log").code, 128 + 9);
  const std::string child = read_file(begun);
  EXPECT_FALSE(std::filesystem::exists("/proc/" + child.substr(0, child.find('\n')) + "/cwd/"));
}

}  // namespace
}  // namespace aeroloom::study
