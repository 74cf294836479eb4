/// The message that a crash of the program itself prints. Such crashes come from the CAD library or the
/// mesher where they run in the rank, without a sandbox (sandbox.hpp).
#pragma once

#include <string_view>

namespace aeroloom::parallel {

/// From now on SIGSEGV, SIGABRT, SIGBUS, SIGFPE and SIGILL print a message to standard error before they end
/// this process. It has the rank and the text of the CrashNote, if there is one.
void tell_crashes(int rank);

/// Replaces the text of the note, for example by a step of the present work.
void set_crash_note(std::string_view what);

/// Names the present work while it lives, for example "stage volume, zone 17". At most one exists at a time;
/// texts are cut after 300 bytes.
class CrashNote {
public:
  explicit CrashNote(std::string_view what);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;
};

}  // namespace aeroloom::parallel
