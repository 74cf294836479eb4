#include "pipeline/report/task_table.hpp"

#include "parallel/observation/task_kind.hpp"

#include <fmt/format.h>

namespace aeroloom::report {

std::string task_table(const parallel::Communicator& communicator, const parallel::StageClock& clock) {
  std::string mine;
  for (const parallel::TaskRecord& task : clock.tasks()) {
    mine += fmt::format("{},{},{},{},{:.6g},{:.6f},{},{},{},{:.6g}\n", communicator.rank(), task.stage,
                        parallel::name_of(task.kind), task.number, task.predicted, task.cpu_seconds,
                        task.bytes, task.child_bytes, task.round, task.burden);
  }
  std::string table;
  for (const std::string& rows : communicator.gather_values(mine)) {
    if (table.empty())
      table = "rank,stage,kind,number,predicted,cpu_seconds,bytes,child_bytes,round,burden\n";
    table += rows;
  }
  return table;
}

}  // namespace aeroloom::report
