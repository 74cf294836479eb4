/// Entry of every test program: GoogleTest under the parallel environment, on any number of ranks. Rank 0
/// prints; the others print only what fails on them. Beside the options of GoogleTest:
///   --files=a_test,b_test   only what these sources define
///   --without=Suite.*:...   not these: what runs on one rank alone, where there are more
///   --only=Suite.*:...      these alone: what is worth five ranks
///   --no-comparison         not what by its name compares numbers of ranks: it has nothing to compare
/// A name or pattern that chooses nothing is an error: lists in CMakeLists.txt stay true.
#include "parallel/communication/communicator.hpp"
#include "parallel/communication/environment.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fnmatch.h>
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

/// A test: its full name and the stem of the source that defines it.
struct Test {
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
      tests.push_back(
          {std::string(suite.name()) + "." + info.name(), std::filesystem::path(info.file()).stem()});
    }
  }
  return tests;
}

bool has_name(const Test& test, const std::string& pattern) {
  return fnmatch(pattern.c_str(), test.name.c_str(), 0) == 0;
}

/// What follows `option` on the command line, cut at `separator`.
std::vector<std::string> values_of(std::string_view option, char separator, int argc, char** argv) {
  std::vector<std::string> values;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument(argv[i]);
    if (!argument.starts_with(option)) continue;
    std::istringstream list{std::string(argument.substr(option.size()))};
    for (std::string value; std::getline(list, value, separator);) values.push_back(value);
  }
  return values;
}

/// Names of the tests that `values` choose. Throws std::runtime_error for a value that chooses none.
std::set<std::string> chosen(const std::vector<Test>& tests, const std::vector<std::string>& values,
                             const std::function<bool(const Test&, const std::string&)>& fits) {
  std::set<std::string> names;
  for (const std::string& value : values) {
    bool any = false;
    for (const Test& test : tests) {
      if (!fits(test, value)) continue;
      names.insert(test.name);
      any = true;
    }
    if (!any) throw std::runtime_error("no test fits " + value);
  }
  return names;
}

/// Whether the test compares what several numbers of ranks give.
bool is_comparison(const Test& test) {
  constexpr std::array<const char*, 6> names = {"*AnyNumberOfRanks*", "*any_number_of_ranks*",
                                                "*AnyRankCount*",     "*.*DependOnRanks*",
                                                "*OnOneRank*",        "*OfOneRank"};
  return std::any_of(names.begin(), names.end(), [&](const char* name) { return has_name(test, name); });
}

/// Adds what the options leave out to GoogleTest's filter.
void leave_out(int argc, char** argv) {
  const auto by_file = [](const Test& test, const std::string& file) { return test.file == file; };
  const std::vector<Test> tests = all_tests();
  const auto files = chosen(tests, values_of("--files=", ',', argc, argv), by_file);
  const auto without = chosen(tests, values_of("--without=", ':', argc, argv), has_name);
  const auto only = chosen(tests, values_of("--only=", ':', argc, argv), has_name);
  const bool no_comparison = std::find(argv, argv + argc, std::string_view("--no-comparison")) != argv + argc;
  std::string left_out;
  for (const Test& test : tests) {
    if ((!files.empty() && !files.contains(test.name)) || (!only.empty() && !only.contains(test.name)) ||
        without.contains(test.name) || (no_comparison && is_comparison(test))) {
      left_out += (left_out.empty() ? "" : ":") + test.name;
    }
  }
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
    leave_out(argc, argv);
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
