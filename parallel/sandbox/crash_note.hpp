/// The message where the program itself crashes. Sandboxed runs (sandbox.hpp) keep that from happening;
/// where there are none the CAD library and the mesher run in the rank.
#pragma once

#include <string_view>

namespace aeroloom::parallel {

/// From now on a signal that ends this process for a fault of its own (SIGSEGV, SIGABRT, SIGBUS, SIGFPE,
/// SIGILL) is told on standard error, with the rank and the CrashNote there is, before it does. Rank: for the
/// text.
void tell_crashes(int rank);

/// Puts another text into the note, such as a step of what is under way.
void set_crash_note(std::string_view what);

/// Names the work under way while this lives, such as "stage volume, zone 17"; one at a time, cut after 300
/// bytes.
class CrashNote {
public:
  explicit CrashNote(std::string_view what);
  ~CrashNote();
  CrashNote(const CrashNote&) = delete;
  CrashNote& operator=(const CrashNote&) = delete;
};

}  // namespace aeroloom::parallel
