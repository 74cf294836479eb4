#include "volume/lattice/p4est_library.hpp"

#include "parallel/communication/environment.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "volume/lattice/p4est_version.hpp"

#include <cstdio>
#include <cstring>

#include <p4est_base.h>

namespace aeroloom::forest {
namespace {

constexpr int exit_bug = 70;

/// Without the heap: it may be what has failed.
struct LastWords {
  parallel::Rank rank = 0;
  const char* doing = "";
  char said[512] = {};
};
LastWords& last_words() {
  static LastWords words;
  return words;
}

/// Keeps what is said of an error; of the stack that follows only that it was said before. The parameters are
/// those of libsc's sc_log_handler_t.
void keep_error(FILE*, const char*, int, int, int, int priority, const char* text) {
  if (priority < SC_LP_ERROR || std::strstr(text, "stack frames") || std::strncmp(text, "Stack", 5) == 0)
    return;
  char* const said = last_words().said;
  const std::size_t length = std::strlen(said), room = sizeof(last_words().said) - length;
  std::snprintf(said + length, room, "%s%s", length > 0 ? " " : "", text);
  said[std::strcspn(said, "\n")] = '\0';
}

/// A package that has no number yet must not be asked for.
bool is_registered(int package) {
  return package >= 0 && sc_package_is_registered(package) != 0;
}

[[noreturn]] void end_all_ranks(const char* why, int exit_code) {
  std::fprintf(stderr, "error (rank %d): %s an octree: %s\n", last_words().rank, last_words().doing, why);
  parallel::abort_all_ranks(exit_code);
}

void on_abort() {
  const char* const said = last_words().said;
  if (std::strstr(said, "alloc")) end_without_memory();
  char why[640];
  std::snprintf(why, sizeof(why), "p4est has ended (%s)", said);
  end_all_ranks(why, exit_bug);
}

}  // namespace

LibraryScope::LibraryScope(parallel::Rank rank, const char* doing) {
  last_words() = {rank, doing, {}};
  if (!is_registered(sc_package_id)) {
    sc_package_id = sc_package_register(keep_error, SC_LP_ERROR, "libsc", "The SC Library");
    sc_set_abort_handler(on_abort);
    _registered_base = true;
  }
  if (!is_registered(p4est_package_id)) {
    p4est_init(keep_error, SC_LP_ERROR);
    _registered_forest = true;
  }
}

LibraryScope::~LibraryScope() {
  if (_registered_forest) {
    sc_package_unregister(p4est_package_id);
    p4est_package_id = -1;
  }
  if (_registered_base) {
    sc_package_unregister(sc_package_id);
    sc_package_id = -1;
    sc_set_abort_handler(nullptr);
  }
}

void LibraryScope::now(const char* doing) {
  last_words().doing = doing;
}

std::string p4est_version() {
  return P4EST_PACKAGE_VERSION;
}

void end_without_memory() {
  end_all_ranks(parallel::out_of_memory_text().c_str(), parallel::exit_out_of_memory);
}

}  // namespace aeroloom::forest
