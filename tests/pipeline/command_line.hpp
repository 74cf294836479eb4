/// Command lines in this process, as a user types them: what they print and how they end.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json_fwd.hpp>

namespace aeroloom::pipeline {

/// How a command ended, the same on every rank; the text of all ranks, by rank.
struct CommandResult {
  int code = -1;
  std::string out, err;
  double seconds = 0;  ///< of the slowest rank

  std::string text() const { return out + err; }
  bool has(const std::string& word) const { return text().find(word) != std::string::npos; }
};
/// How often a word stands in a text.
int count_of(const std::string& word, const std::string& text);

/// What the command said, for messages of tests.
std::ostream& operator<<(std::ostream& stream, const CommandResult& ended);

/// Runs commands of the program in a folder of this test alone, which all ranks share: it is the current
/// directory while the test runs, empty at its start, gone at its end. After a command the log is quiet and
/// no warning is kept. Nothing here may limit memory or give up the sandbox: both last as long as the
/// process.
///
/// Children of the sandbox were started elsewhere: files that they read, of CAD and of VTK, are named with
/// their folder.
class CommandLine : public testing::Test {
protected:
  void SetUp() override;
  void TearDown() override;

  /// `aeroloom LINE` on all ranks. Words are parted by blanks, but within quotes. Collective.
  CommandResult run(const std::string& line) const;
  CommandResult run(const std::vector<std::string>& words) const;
  /// On rank 0 by itself; all ranks wait for it and have the result. Collective.
  CommandResult run_alone(const std::string& line) const;
  /// On the calling rank by itself. Not collective.
  CommandResult run_here(const std::string& line) const;

  /// Runs the line and expects the exit code and each of the words in what is printed. Returns it.
  /// Collective.
  CommandResult expect(int code, const std::string& line, const std::vector<std::string>& words = {}) const;

  /// Rank 0 writes; the place in the folder, with it. Collective.
  std::string write(const std::string& name, const std::string& text) const;
  /// Rank 0 changes files, the others wait. Collective.
  template <class Work>
  void at_root(Work work) const {
    world.barrier();
    if (world.is_root()) work();
    world.barrier();
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  /// The mesh of the last run, for commands that read it.
  std::string mesh() const { return path("out/mesh.pvtu"); }
  std::string read(const std::string& name) const;
  nlohmann::json read_json(const std::string& name) const;
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  const parallel::Communicator world = parallel::Communicator::world();
  std::filesystem::path folder;

private:
  CommandResult run_on(const parallel::Communicator& ranks, const std::vector<std::string>& words) const;
  std::filesystem::path _left;  // the current directory before
};

/// A wing on a body from a file, very coarse, without pictures.
std::string coarse_wing();
/// The fluid in a duct with a branch: some thousand tetrahedra, the quickest case there is.
std::string coarse_duct();
/// The built-in aircraft, coarse.
std::string coarse_transport();
/// The example of groups of faces; its last section is that of outputs.
std::string groups_case();

}  // namespace aeroloom::pipeline
