/// Hostile files: a good file damaged in many places, and what a reader must make of each.
///
/// A reader must come back from every case within seconds, with a clean result or a CollectiveError of kind
/// input or files whose text names the file. Anything else fails the test and says which damage did it: the
/// same case comes again for the same seed.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace aeroloom::io::damage {

/// Which of the cases a test takes: all where AEROLOOM_ALL_DAMAGE is set, as benchmarks/damaged_files.py
/// does. The number shares no factor with the loops over kinds of damage: each kind is among what is left.
inline int stride(int of_tests) {
  return std::getenv("AEROLOOM_ALL_DAMAGE") != nullptr ? 1 : of_tests;
}

/// How much is tried on one file.
struct Options {
  int truncations = 60;  ///< lengths: all up to here of a short file, else spread, the last bytes too
  int flips = 150;       ///< single bits, and bytes replaced by any other, half of them in the first kilobyte
  int fields = 60;       ///< of 4 and 8 bytes, each aligned to 4, each replaced by four absurd values
  int pieces = 30;       ///< runs of bytes taken out, and doubled
  int every = stride(5);                                   ///< of these cases one in so many
  std::uint64_t seed = 1;                                  ///< of the places
  unsigned deadline_seconds = 20;                          ///< of one case, wall clock
  std::int64_t memory_bytes = std::int64_t{1} << 30;       ///< address space a case may add on each rank
  std::function<void(std::string& bytes)> mend = nullptr;  ///< e.g. sets a checksum right again
};

struct Outcome {
  int cases = 0, refused = 0, accepted = 0;
};

/// One damaged file.
struct DamagedFile {
  std::string name;
  std::string bytes;
};

namespace detail {

/// The case being read, for the handler of signals.
inline std::array<char, 256> current_case = {};

inline void tell_case(int signal) {
  const auto print = [](const char* text) {
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(99);
  };
  print(signal == SIGALRM ? "\nHANGS on damage: " : "\nCRASHES on damage: ");
  print(current_case.data());
  print("\n");
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// While it lives, a crash or a hang names its case, and memory is limited.
class Watch {
public:
  explicit Watch(std::int64_t memory_bytes) {
    for (std::size_t i = 0; i < watched.size(); ++i) _before[i] = std::signal(watched[i], tell_case);
    getrlimit(RLIMIT_AS, &_limit);
    std::int64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlimit tighter{static_cast<rlim_t>(pages * sysconf(_SC_PAGESIZE) + memory_bytes), _limit.rlim_max};
    setrlimit(RLIMIT_AS, &tighter);
  }
  ~Watch() {
    alarm(0);
    setrlimit(RLIMIT_AS, &_limit);
    for (std::size_t i = 0; i < watched.size(); ++i) std::signal(watched[i], _before[i]);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  static void begin(const std::string& name, unsigned deadline_seconds) {
    std::snprintf(current_case.data(), current_case.size(), "%s", name.c_str());
    alarm(deadline_seconds);
  }

private:
  static constexpr std::array<int, 6> watched = {SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL};
  std::array<void (*)(int), watched.size()> _before = {};
  rlimit _limit = {};
};

/// Damaged copies one after another; none is kept.
class Damager {
public:
  Damager(const std::string& good, const Options& options) : _good(good), _options(options) {}

  void each(const std::function<void(const DamagedFile&)>& use) {
    truncate(use);
    flip(use);
    overwrite(use);
    cut_and_double(use);
  }

private:
  std::size_t place(std::size_t below) { return below == 0 ? 0 : _random() % below; }
  /// Every other one near the beginning, where formats have their counts.
  std::size_t weighted_place(int turn) {
    return place(turn % 2 == 0 ? std::min<std::size_t>(_good.size(), 1024) : _good.size());
  }
  void give(const std::function<void(const DamagedFile&)>& use, const std::string& name, std::string bytes) {
    if (_seen++ % _options.every != 0) return;
    if (_options.mend) _options.mend(bytes);
    use({name, std::move(bytes)});
  }
  void truncate(const std::function<void(const DamagedFile&)>& use) {
    std::vector<std::size_t> lengths = {0, 1, 3, 4, 7, 8, 12, 16, 28, 32};
    for (std::size_t last = 1; last <= 9; ++last)
      lengths.push_back(_good.size() - std::min(last, _good.size()));
    while (static_cast<int>(lengths.size()) < _options.truncations) {
      const auto turn = static_cast<int>(lengths.size());
      lengths.push_back(weighted_place(turn));
    }
    for (const std::size_t length : lengths) {
      if (length < _good.size())
        give(use, "cut to " + std::to_string(length) + " bytes", _good.substr(0, length));
    }
  }
  void flip(const std::function<void(const DamagedFile&)>& use) {
    for (int i = 0; i < _options.flips && !_good.empty(); ++i) {
      const std::size_t at = weighted_place(i / 2);
      const bool whole = i % 2 == 1;
      const auto mask = static_cast<char>(whole ? 1 + place(255) : std::size_t{1} << place(8));
      std::string bytes = _good;
      bytes[at] = static_cast<char>(bytes[at] ^ mask);
      give(use,
           std::string(whole ? "byte" : "bit") + " changed at " + std::to_string(at) + " by mask " +
               std::to_string(static_cast<unsigned char>(mask)),
           std::move(bytes));
    }
  }
  void overwrite(const std::function<void(const DamagedFile&)>& use) {
    // -1, the largest, a large one whose multiples wrap around, nothing; the first byte is the lowest.
    const std::array<std::string, 4> values = {std::string(8, '\xff'), std::string(7, '\xff') + '\x7f',
                                               std::string(7, '\0') + '\x40', std::string(8, '\0')};
    for (int i = 0; i < _options.fields; ++i) {
      const std::size_t width = i % 4 == 3 ? 4 : 8, at = weighted_place(i) / 4 * 4;
      if (at + width > _good.size()) continue;
      for (std::size_t k = 0; k < values.size(); ++k) {
        std::string bytes = _good;
        bytes.replace(at, width, values[k].substr(8 - width));
        give(use,
             std::to_string(width) + " bytes at " + std::to_string(at) + " set to value " + std::to_string(k),
             std::move(bytes));
      }
    }
  }
  void cut_and_double(const std::function<void(const DamagedFile&)>& use) {
    for (int i = 0; i < _options.pieces && !_good.empty(); ++i) {
      const std::size_t at = weighted_place(i / 2),
                        length = 1 + place(std::min<std::size_t>(_good.size(), 200));
      std::string bytes = _good;
      const std::string where = std::to_string(length) + " bytes at " + std::to_string(at);
      if (i % 2 == 0) {
        bytes.erase(at, length);
        give(use, where + " taken out", std::move(bytes));
      } else {
        bytes.insert(at, _good.substr(at, length));
        give(use, where + " doubled", std::move(bytes));
      }
    }
  }

  const std::string& _good;
  const Options& _options;
  int _seen = 0;
  std::mt19937_64 _random{_options.seed};
};

/// Whether the error is what a user may see of a damaged file.
inline void expect_honest(const parallel::CollectiveError& error, const std::string& name,
                          const std::string& path) {
  const std::string text = error.what();
  const bool right_kind =
      error.kind() == parallel::FailureKind::input || error.kind() == parallel::FailureKind::files;
  EXPECT_TRUE(right_kind) << name << ": kind " << static_cast<int>(error.kind()) << ", " << text;
  EXPECT_NE(text.find(std::filesystem::path(path).filename().string()), std::string::npos)
      << name << ": the text does not name the file: " << text;
}

}  // namespace detail

/// Puts damaged copies of `good` to `path`, one at a time, and lets all ranks `read` each (read, and make of
/// it what users would: assemble and count). `good` is the same on every rank. Removes the file at the end.
/// Collective.
inline Outcome survive(const parallel::Communicator& communicator, const std::string& good,
                       const std::string& path, const std::function<void(const std::string& path)>& read,
                       const Options& options = {}) {
  Outcome outcome;
  const detail::Watch watch(options.memory_bytes);
  detail::Damager(good, options).each([&](const DamagedFile& damaged) {
    if (communicator.is_root()) {
      std::ofstream stream(path, std::ios::binary | std::ios::trunc);
      stream.write(damaged.bytes.data(), static_cast<std::streamsize>(damaged.bytes.size()));
    }
    communicator.barrier();
    detail::Watch::begin(damaged.name, options.deadline_seconds);
    ++outcome.cases;
    try {
      read(path);
      ++outcome.accepted;
    } catch (const parallel::CollectiveError& error) {
      ++outcome.refused;
      detail::expect_honest(error, damaged.name, path);
    } catch (const std::exception& error) {
      ADD_FAILURE() << damaged.name << ": not a CollectiveError: " << error.what();
    }
    communicator.barrier();
  });
  if (communicator.is_root()) std::filesystem::remove(path);
  communicator.barrier();
  return outcome;
}

}  // namespace aeroloom::io::damage
