// From a case to its surface mesh, for benchmarks of the stages behind it.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/load_domain.hpp"
#include "pipeline/size_domain.hpp"
#include "surface/surface_mesher.hpp"

namespace aeroloom::benchmarks {

struct CaseSurface {
  surface::SurfaceMesh surface;
  mesh::Numbering numbering;
};

/// Collective.
inline CaseSurface mesh_surface(const parallel::Communicator& communicator, const pipeline::Case& input) {
  parallel::StageClock clock;
  cad::DomainReport domain;
  const cad::Model model = pipeline::load_domain(communicator, input.domain, clock, domain);
  const pipeline::SizedDomain sized =
      pipeline::size_domain(communicator, model, input.sizing, pipeline::Simplification::of(input), clock);
  CaseSurface result{surface::mesh_surface(communicator, sized.model, sized.field, input.surface, clock), {}};
  result.numbering = mesh::number_mesh(communicator, result.surface.mesh);
  return result;
}

}  // namespace aeroloom::benchmarks
