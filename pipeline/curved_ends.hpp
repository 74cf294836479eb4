/// The CAD behind curved faces that boundary layers end on.
#pragma once

#include "cad/model/model.hpp"
#include "layers/curved_ends.hpp"

#include <memory>

namespace aeroloom::pipeline {

/// Keeps the model.
std::shared_ptr<const layers::CurvedEnds> curved_ends_of(const cad::Model& model);

}  // namespace aeroloom::pipeline
