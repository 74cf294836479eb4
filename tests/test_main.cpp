/// Entry of every test program: GoogleTest under the parallel environment, on any number of ranks. Rank 0
/// prints; the others print only what fails on them. Suites `...Local` know nothing of other ranks: they run
/// on one rank alone. Beside the options of GoogleTest:
///   --files=a_test,b_test   only what these sources define
/// A name that chooses nothing is an error, and so is a number of ranks on which nothing runs: lists in
/// CMakeLists.txt stay true.
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/environment.hpp"

#include <cstdio>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace {

/// Prints the failures of a rank other than 0.
class FailuresOnly : public testing::EmptyTestEventListener {
public:
  explicit FailuresOnly(int rank) : _rank(rank) {}
  void OnTestPartResult(const testing::TestPartResult& result) override {
    if (result.failed()) {
      std::fprintf(stderr, "[rank %d] %s:%d: %s\n", _rank, result.file_name() ? result.file_name() : "?",
                   result.line_number(), result.message());
    }
  }

private:
  int _rank;
};

/// A test and the stem of the source that defines it.
struct Test {
  std::string suite;
  std::string name;
  std::string file;
};

std::vector<Test> all_tests() {
  std::vector<Test> tests;
  const auto& unit = *testing::UnitTest::GetInstance();
  for (int s = 0; s < unit.total_test_suite_count(); ++s) {
    const auto& suite = *unit.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const auto& info = *suite.GetTestInfo(t);
      tests.push_back({suite.name(), info.name(), std::filesystem::path(info.file()).stem()});
    }
  }
  return tests;
}

/// Whether the test knows nothing of other ranks: its suite is named `...Local`.
bool is_local(const Test& test) {
  return test.suite.ends_with("Local");
}

/// The sources that the command line names.
std::set<std::string> files_asked_for(int argc, char** argv) {
  constexpr std::string_view option = "--files=";
  std::set<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument(argv[i]);
    if (!argument.starts_with(option)) continue;
    std::istringstream list{std::string(argument.substr(option.size()))};
    for (std::string file; std::getline(list, file, ',');) files.insert(file);
  }
  return files;
}

/// Adds to GoogleTest's filter what is of other sources than `files`, unless they are empty, and what does
/// not run on so many ranks. Throws std::runtime_error for a file without tests, and where nothing is left.
void leave_out(const std::set<std::string>& files, int ranks) {
  std::set<std::string> seen;
  std::string left_out;
  bool any = false;
  for (const Test& test : all_tests()) {
    seen.insert(test.file);
    const bool chosen = files.empty() || files.contains(test.file);
    if (chosen && (ranks == 1 || !is_local(test)))
      any = true;
    else
      left_out += (left_out.empty() ? "" : ":") + test.suite + "." + test.name;
  }
  for (const std::string& file : files) {
    if (!seen.contains(file)) throw std::runtime_error("no test is of " + file);
  }
  if (!any) throw std::runtime_error("nothing runs on " + std::to_string(ranks) + " ranks");
  if (left_out.empty()) return;
  std::string filter = GTEST_FLAG_GET(filter);
  filter += (filter.find('-') == std::string::npos ? "-" : ":") + left_out;
  GTEST_FLAG_SET(filter, filter);
}

}  // namespace

int main(int argc, char** argv) {
  aeroloom::parallel::Environment environment(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const auto world = aeroloom::parallel::Communicator::world();
  try {
    leave_out(files_asked_for(argc, argv), world.size());
  } catch (const std::runtime_error& error) {
    if (world.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  if (!world.is_root()) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly(world.rank()));
  }
  const int mine = RUN_ALL_TESTS();
  return static_cast<int>(world.maximum(static_cast<std::int64_t>(mine)));
}
