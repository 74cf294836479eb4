/// What the stages of a run say when they end: all of it is worded here. What a stage says while it works
/// (retries, searches) stands in its driver.
#pragma once

#include "cad/model/model.hpp"
#include "pipeline/run.hpp"

#include <string>

namespace aeroloom::pipeline {

// Each logs what its stage has put into the record. On every rank; rank 0 prints.

void log_geometry(const cad::Model& model, const RunRecord& record);
void log_sizing(const RunRecord& record);
/// Strips that are not resolved, sizes that lose the shape of the body. By one rank.
void warn_of_sizes(const RunRecord& record);
/// Formats that know one unit alone, where the model has another. By one rank.
void warn_of_units(const RunRecord& record, const OutputOptions& output);
void log_surface(const RunRecord& record);
void log_needles(const RunRecord& record);
/// Joined faces could not be meshed: it is done again without.
void log_surface_again(const std::string& reason);
void log_decompose(const RunRecord& record);
/// Where more tetrahedra are to be made than sizes have led to expect.
void warn_of_count(const RunRecord& record);
void log_volume(const RunRecord& record);
void log_improve(const RunRecord& record);
/// Nothing where nothing is pinned.
void log_pinned(const RunRecord& record);

}  // namespace aeroloom::pipeline
