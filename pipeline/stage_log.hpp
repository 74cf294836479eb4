/// The wording of all that the stages of a run say when they end. What a stage says while it works
/// (retries, searches) stands in its driver.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/run.hpp"

#include <string>

namespace aeroloom::pipeline {

// Each logs what its stage has put into the record. On every rank; rank 0 prints.

void log_geometry(const cad::Model& model, const report::RunRecord& record);
void log_sizing(const report::RunRecord& record);
/// Strips that are not resolved, sizes that lose the shape of the body. By one rank.
void warn_of_sizes(const report::RunRecord& record);
/// Formats that know one unit alone, where the model has another. By one rank.
void warn_of_units(const report::RunRecord& record, const cases::OutputOptions& output);
void log_surface(const report::RunRecord& record);
void log_needles(const report::RunRecord& record);
/// Joined faces could not be meshed: it is done again without.
void log_surface_again(const std::string& reason);
void log_layers(const report::RunRecord& record);
void log_decompose(const report::RunRecord& record);
/// Where more tetrahedra are to be made than sizes have led to expect.
void warn_of_count(const report::RunRecord& record);
void log_volume(const report::RunRecord& record);
void log_improve(const report::RunRecord& record);
/// Nothing where nothing is pinned.
void log_pinned(const report::RunRecord& record);

}  // namespace aeroloom::pipeline
