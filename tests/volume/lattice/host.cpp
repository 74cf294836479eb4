/// A program that uses p4est itself beside our forest, for host_test.sh: forest_host WAY, where WAY is
///   before    it has started p4est before
///   after     it starts p4est when our forest is made, and once more after another one
///   only_sc   it has started the library under p4est alone
///   aborts    p4est aborts while the last rank works for us
///   memory    there is no memory left for it there
#include "parallel/communication/host.hpp"

#include "parallel/communication/environment.hpp"
#include "volume/lattice/forest.hpp"

#include <cstdio>
#include <cstring>
#include <string>

#include <p8est.h>
#include <p8est_extended.h>
#include <sys/resource.h>

namespace {

using namespace aeroloom;

int spoken = 0;
void count_words(FILE*, const char*, int, int, int, int, const char*) {
  ++spoken;
}

/// A forest of the host.
std::int64_t grow_own(MPI_Comm group) {
  p8est_connectivity_t* const cube = p8est_connectivity_new_unitcube();
  p8est_t* const forest = p8est_new_ext(group, cube, 0, 2, 1, 0, nullptr, nullptr);
  p8est_balance(forest, P8EST_CONNECT_FULL, nullptr);
  const std::int64_t count = forest->global_num_quadrants;
  p8est_destroy(forest);
  p8est_connectivity_destroy(cube);
  return count;
}

std::int64_t grow_ours(const parallel::Communicator& communicator) {
  const auto criterion = [](const geometry::GridCube& cube) {
    return cube.level < 6 && cube.low == geometry::GridPoint{} ? forest::RefineFlag::split
                                                               : forest::RefineFlag::keep;
  };
  const forest::Forest grown = forest::grow(communicator, criterion);
  partition_by_weight(grown, std::vector<std::int32_t>(grown.local().size(), 1));
  return grown.count();
}

void grow_badly(const parallel::Communicator& communicator, const std::string& way) {
  const auto criterion = [&](const geometry::GridCube& cube) {
    if (communicator.rank() == communicator.size() - 1 && cube.level >= 2) {
      if (way == "aborts") sc_abort_verbose(__FILE__, __LINE__, "a failing assertion");
      sc_malloc(p4est_package_id, std::size_t{1} << 60);
    }
    return cube.level < 3 ? forest::RefineFlag::split : forest::RefineFlag::keep;
  };
  forest::grow(communicator, criterion);
}

bool check(bool holds, const char* what) {
  if (!holds) std::fprintf(stderr, "not so: %s\n", what);
  return holds;
}

/// All leaves of grow_ours and grow_own.
constexpr std::int64_t ours = 43, own = 64;

bool lives_beside(const parallel::Communicator& communicator, const std::string& way) {
  MPI_Comm group = parallel::host_communicator(communicator);
  bool good = true;
  const auto start = [&](bool all) {
    sc_init(group, 0, 0, count_words, SC_LP_ALWAYS);
    if (all) p4est_init(count_words, SC_LP_ALWAYS);
  };
  if (way != "after") {
    start(way == "before");
    const int base = sc_package_id, forest = p4est_package_id, before = spoken;
    good &= check(grow_ours(communicator) == ours, "our forest is as it should be");
    good &= check(sc_package_id == base && p4est_package_id == forest, "what the host has started stays");
    const bool is_told = way == "before" && communicator.is_root();  // by both of them, of their progress
    good &= check((spoken > before) == is_told, "what the host has set up stays in force");
  } else {
    good &= check(grow_ours(communicator) == ours, "our forest is as it should be");
    start(true);
  }
  good &= check(grow_own(group) == own, "the host's forest is as it should be");
  sc_finalize();
  good &= check(grow_ours(communicator) == ours, "our forest is as it should be afterwards");
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string way = argc > 1 ? argv[1] : "";
  parallel::Environment environment(argc, argv);
  const auto world = parallel::Communicator::world();
  if (way == "aborts" || way == "memory") {
    grow_badly(world, way);
    return 1;
  }
  return lives_beside(world, way) ? 0 : 1;
}
