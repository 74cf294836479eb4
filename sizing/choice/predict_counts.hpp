/// What a field predicts of the mesh of a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"

namespace aeroloom::sizing {

/// The size of the mesh under a field. Collective, as what follows.
PredictedCounts predict_counts(const SampledModel& sampled, const SizeField& field);
/// The triangles that predict_counts() counts.
double count_triangles(const SampledModel& sampled, const SizeField& field);
/// The tetrahedra that predict_counts() counts.
double count_tetrahedra(const SampledModel& sampled, const SizeField& field);

}  // namespace aeroloom::sizing
