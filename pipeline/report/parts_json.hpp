/// The sections of report.json, made from the record. Keys: docs/report.md, docs/report.schema.json.
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
/// Null if the case asks for no layers.
Json layers_json(const RunRecord& record);
Json volume_json(const RunRecord& record);
Json mesh_json(const RunRecord& record);
/// Needs `record.quality`. `quality.gate` has the limits of the case.
Json quality_json(const cases::Case& input, const RunRecord& record);
Json improve_json(const cases::Case& input, const RunRecord& record);
Json pinned_json(const RunRecord& record);
Json unresolved_json(const RunRecord& record);
Json patches_json(const RunRecord& record);
/// One row for each CAD face; `group`: its group in the case, if any.
Json faces_json(const cases::Case& input, const RunRecord& record);
Json regions_json(const RunRecord& record);
Json stages_json(const std::vector<parallel::StageSummary>& stages);
/// The useful number of ranks, from a report with its stages and the table of tasks; may be null.
Json scaling_json(const Json& report, const std::string& tasks);

}  // namespace aeroloom::report
