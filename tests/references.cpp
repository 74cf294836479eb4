#include "tests/references.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <span>

#include <gtest/gtest.h>

namespace aeroloom::references {

namespace fs = std::filesystem;

namespace {

/// Where the next text of the running test is kept; empty for nowhere.
fs::path next_place() {
  static std::map<std::string, int> calls;
  const char* folder = std::getenv("AEROLOOM_REFERENCES");
  if (folder == nullptr) return {};
  const auto& test = *testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test.test_suite_name()) + "." + test.name();
  std::replace(name.begin(), name.end(), '/', '_');
  const int call = calls[name]++;
  return fs::path(folder) / (name + "." + std::to_string(call));
}

}  // namespace

std::string of_one_rank(const parallel::Communicator& ranks, const std::string& here,
                        const std::function<std::string()>& make) {
  const fs::path place = next_place();
  if (ranks.size() == 1) {
    if (!place.empty()) {
      fs::create_directories(place.parent_path());
      std::ofstream(place) << here;
    }
    return here;
  }
  std::error_code none;
  const bool is_kept = !place.empty() && fs::exists(place, none) &&
                       fs::last_write_time(place) > fs::last_write_time(fs::read_symlink("/proc/self/exe"));
  if (!is_kept) return make();
  std::ifstream stream(place);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void expect_as_on_one_rank(const std::function<std::string(const parallel::Communicator&)>& outcome) {
  const auto world = parallel::Communicator::world();
  const std::string here = outcome(world);
  const auto bytes = std::as_bytes(std::span(here));
  for (const parallel::Bytes& other : world.all_gather({bytes.begin(), bytes.end()})) {
    EXPECT_TRUE(std::equal(other.begin(), other.end(), bytes.begin(), bytes.end()))
        << "another rank has another one";
  }
  if (!world.is_root()) return;
  const std::string alone = of_one_rank(world, here, [&] { return outcome(parallel::Communicator::self()); });
  EXPECT_TRUE(here == alone) << "on one rank it is another";
}

}  // namespace aeroloom::references
