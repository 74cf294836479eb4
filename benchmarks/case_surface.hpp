// From a case to its surface mesh, for benchmarks of the stages behind it.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "surface/surface_mesher.hpp"

namespace aeroloom::benchmarks {

/// Collective.
inline surface::SurfaceMesh mesh_surface(const parallel::Communicator& communicator,
                                         const cases::Case& input) {
  cad::DomainReport domain;
  const cad::Model model = domain::load_domain(communicator, input.domain, domain);
  const domain::SizedDomain sized =
      domain::size_domain(communicator, model, input.sizing, domain::Simplification::of(input));
  return surface::mesh_surface(sized.model, sized.field, input.surface);
}

}  // namespace aeroloom::benchmarks
