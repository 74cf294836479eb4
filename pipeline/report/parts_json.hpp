/// The parts of report.json, each from the record alone. Keys: docs/report.md and docs/report.schema.json.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::report {

using Json = nlohmann::ordered_json;

Json geometry_json(const RunRecord& record);
Json sizing_json(const RunRecord& record);
Json surface_json(const RunRecord& record);
/// Null where the case asks for no layers.
Json layers_json(const RunRecord& record);
Json volume_json(const RunRecord& record);
Json mesh_json(const RunRecord& record);
/// Needs `record.quality`; `quality.gate` has the limits of the case.
Json quality_json(const cases::Case& input, const RunRecord& record);
Json improve_json(const cases::Case& input, const RunRecord& record);
Json pinned_json(const RunRecord& record);
Json unresolved_json(const RunRecord& record);
Json patches_json(const RunRecord& record);
/// Of each CAD face; `group` where one of the case's has it.
Json faces_json(const cases::Case& input, const RunRecord& record);
Json regions_json(const RunRecord& record);
Json stages_json(const std::vector<parallel::StageSummary>& stages);
/// Of a report with its stages, and the records of tasks; null where they tell nothing.
Json scaling_json(const Json& report, const std::string& tasks);

}  // namespace aeroloom::report
