/// What rows along edges came to.
#pragma once

#include "cad/model/model.hpp"
#include "surface/curves/curves.hpp"
#include "surface/surface_options.hpp"
#include "surface/surface_report.hpp"

#include <span>
#include <vector>

namespace aeroloom::surface {

/// By edge, where `rows` ask for them. None along seams and edges of faceted faces alone. The same on every
/// rank.
std::vector<RowsMade> list_rows(const cad::Model& model, const CurveMesh& curves,
                                std::span<const EdgeRows> rows);

}  // namespace aeroloom::surface
