/// How busy the processors of this machine are beside the runs of a study.
#pragma once

#include <optional>

namespace aeroloom::study {

/// Of a processor, by other programs while a run lasts: from here on its seconds tell of that, too. Chosen,
/// not measured.
inline constexpr double busy_processors = 0.5;

/// CPU seconds since the machine and this program began.
struct ProcessorUse {
  double of_all = 0;       ///< of all programs
  double of_children = 0;  ///< of this program's children that have ended, with their children
};
ProcessorUse processor_use();

/// The mean number of processors that other programs have kept busy in between; empty where the system does
/// not tell.
std::optional<double> busy_beside(const ProcessorUse& before, const ProcessorUse& after, double seconds);

}  // namespace aeroloom::study
