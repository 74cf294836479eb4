/// The number of elements that a field predicts for a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"

namespace aeroloom::sizing {

/// Times 1/h^3: what meshes of ten models have on average, with edges of 0.98 h. Regular tetrahedra of edges
/// h would be 6 sqrt(2) = 8.5 if they filled space, those of a body-centred lattice are 9.1.
inline constexpr double tetrahedra_per_volume = 11.3;

/// The tetrahedra of a field if all of its leaves were meshed. Takes no model. Collective.
double count_everywhere(const SizeField& field);

/// Triangles and tetrahedra of the mesh under a field. Collective, as what follows.
PredictedCounts predict_counts(const SampledModel& sampled, const SizeField& field);
/// The triangles of predict_counts() alone.
double count_triangles(const SampledModel& sampled, const SizeField& field);
/// The tetrahedra of predict_counts() alone.
double count_tetrahedra(const SampledModel& sampled, const SizeField& field);

}  // namespace aeroloom::sizing
