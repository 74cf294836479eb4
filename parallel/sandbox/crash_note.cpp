#include "parallel/sandbox/crash_note.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>

#include <unistd.h>

namespace aeroloom::parallel {

namespace {

constexpr std::array fatal_signals{SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL};
constexpr std::array fatal_names{"SIGSEGV", "SIGABRT", "SIGBUS", "SIGFPE", "SIGILL"};

// A handler may touch nothing that allocates or locks.
char note_text[301] = "";
char rank_text[32] = "";

void write_to_stderr(const char* text) {
  [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, text, std::strlen(text));
}

extern "C" void tell_crash(int signal) {
  const auto at = std::find(fatal_signals.begin(), fatal_signals.end(), signal) - fatal_signals.begin();
  write_to_stderr(rank_text);
  write_to_stderr("error: ");
  write_to_stderr(note_text[0] != 0 ? note_text : "no sandboxed task");
  write_to_stderr(": crashed with ");
  write_to_stderr(fatal_names[static_cast<std::size_t>(at)]);
  write_to_stderr(
      ", which ends the run: it has no child processes (parallel.sandbox: none). Remedy: run it where they "
      "are "
      "allowed\n");
  raise(signal);  // as if nobody listened (SA_RESETHAND)
}

}  // namespace

void tell_crashes(int rank) {
  std::snprintf(rank_text, sizeof rank_text, "[rank %d] ", rank);
  struct sigaction action {};
  action.sa_handler = tell_crash;
  sigemptyset(&action.sa_mask);
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : fatal_signals) sigaction(signal, &action, nullptr);
}

void set_crash_note(std::string_view what) {
  const std::size_t length = std::min(what.size(), sizeof note_text - 1);
  std::memcpy(note_text, what.data(), length);
  note_text[length] = 0;
}

CrashNote::CrashNote(std::string_view what) {
  set_crash_note(what);
}

CrashNote::~CrashNote() {
  note_text[0] = 0;
}

}  // namespace aeroloom::parallel
