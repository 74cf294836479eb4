#include "pipeline/study/processor_use.hpp"

#include <algorithm>
#include <fstream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace aeroloom::study {

namespace {

double seconds_in(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessorUse processor_use() {
  ProcessorUse use;
  std::ifstream file("/proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, interrupts = 0, soft_interrupts = 0,
         stolen = 0;
  if (file >> name >> user >> nice >> system >> idle >> waiting >> interrupts >> soft_interrupts >> stolen)
    use.of_all = (user + nice + system + interrupts + soft_interrupts + stolen) /
                 static_cast<double>(::sysconf(_SC_CLK_TCK));
  rusage children{};
  if (::getrusage(RUSAGE_CHILDREN, &children) == 0)
    use.of_children = seconds_in(children.ru_utime) + seconds_in(children.ru_stime);
  return use;
}

std::optional<double> busy_beside(const ProcessorUse& before, const ProcessorUse& after, double seconds) {
  const double all = after.of_all - before.of_all;
  if (all <= 0 || seconds <= 0) return {};
  return std::max(0.0, all - (after.of_children - before.of_children)) / seconds;
}

}  // namespace aeroloom::study
