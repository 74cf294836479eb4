/// Entry of every test program: GoogleTest under the parallel environment, on any number of ranks. Rank 0
/// prints; the others print only what fails on them.
#include "parallel/communicator.hpp"
#include "parallel/environment.hpp"

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

}  // namespace

int main(int argc, char** argv) {
  aeroloom::parallel::Environment environment(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  const auto world = aeroloom::parallel::Communicator::world();
  if (!world.is_root()) {
    auto& listeners = testing::UnitTest::GetInstance()->listeners();
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly(world.rank()));
  }
  const int mine = RUN_ALL_TESTS();
  return static_cast<int>(world.maximum(static_cast<std::int64_t>(mine)));
}
