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

/// The last error, without heap memory, which may be what has failed.
struct LastError {
  parallel::Rank rank = 0;
  const char* doing = "";
  char message[512] = {};
};
LastError& last_error() {
  static LastError error;
  return error;
}

/// Keeps the messages of an error, without the stack that follows. The parameters are those of libsc's
/// sc_log_handler_t.
void keep_error(FILE*, const char*, int, int, int, int priority, const char* text) {
  if (priority < SC_LP_ERROR || std::strstr(text, "stack frames") || std::strncmp(text, "Stack", 5) == 0)
    return;
  char* const message = last_error().message;
  const std::size_t length = std::strlen(message), room = sizeof(last_error().message) - length;
  std::snprintf(message + length, room, "%s%s", length > 0 ? " " : "", text);
  message[std::strcspn(message, "\n")] = '\0';
}

/// A package without a number yet must not be passed to sc.
bool is_registered(int package) {
  return package >= 0 && sc_package_is_registered(package) != 0;
}

[[noreturn]] void end_all_ranks(const char* why, int exit_code) {
  std::fprintf(stderr, "error (rank %d): %s an octree: %s\n", last_error().rank, last_error().doing, why);
  parallel::abort_all_ranks(exit_code);
}

void on_abort() {
  const char* const message = last_error().message;
  if (std::strstr(message, "alloc")) end_without_memory();
  char why[640];
  std::snprintf(why, sizeof(why), "p4est has ended (%s)", message);
  end_all_ranks(why, exit_bug);
}

}  // namespace

LibraryScope::LibraryScope(parallel::Rank rank, const char* doing) {
  last_error() = {rank, doing, {}};
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
  last_error().doing = doing;
}

std::string p4est_version() {
  return P4EST_PACKAGE_VERSION;
}

void end_without_memory() {
  end_all_ranks(parallel::out_of_memory_text().c_str(), parallel::exit_out_of_memory);
}

}  // namespace aeroloom::forest
