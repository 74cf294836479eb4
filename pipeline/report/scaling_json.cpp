#include "pipeline/report/parts_json.hpp"
#include "pipeline/study/prediction_files.hpp"

#include <stdexcept>

namespace aeroloom::report {

Json scaling_json(const Json& report, const std::string& tasks) {
  try {
    const study::Network usual;
    return study::to_json(study::worthwhile_ranks(study::costs_of(report, tasks), usual), usual);
  } catch (const std::runtime_error&) {
    return {};  // nothing is known of a run that failed or was resumed
  }
}

}  // namespace aeroloom::report
