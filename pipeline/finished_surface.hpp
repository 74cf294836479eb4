/// A finished surface: its numbers, its sizes, checks and figures.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/run.hpp"
#include "sizing/field/size_field.hpp"

#include <string>

namespace aeroloom::pipeline {

/// The finished surface with its sizes.
struct FinishedSurface : mesh::NumberedMesh {
  sizing::SizeField field;
};

/// Checks the surface and puts its quality and the table of patches on record. Collective. Throws as
/// require_valid().
void inspect_surface(const cad::Model& model, const std::string& what, const mesh::NumberedMesh& surface,
                     report::RunRecord& record);

/// The surface follows a volume whose boundary was improved. Collective.
void adopt_boundary(const cad::Model& model, const mesh::DistributedMesh& volume,
                    const mesh::Numbering& numbering, FinishedSurface& surface, report::RunRecord& record);

}  // namespace aeroloom::pipeline
