/// The number of elements that a field predicts for a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"

namespace aeroloom::sizing {

/// Triangles and tetrahedra of the mesh under a field. Collective, as what follows.
PredictedCounts predict_counts(const SampledModel& sampled, const SizeField& field);
/// The triangles of predict_counts() alone.
double count_triangles(const SampledModel& sampled, const SizeField& field);
/// The tetrahedra of predict_counts() alone.
double count_tetrahedra(const SampledModel& sampled, const SizeField& field);

}  // namespace aeroloom::sizing
