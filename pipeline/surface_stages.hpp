/// The stages from a domain to its finished surface: sizes, and the surface mesh.
#pragma once

#include "pipeline/case/patch_rules.hpp"
#include "pipeline/checkpoints.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "pipeline/finished_surface.hpp"
#include "pipeline/report/run_record.hpp"
#include "surface/surface_mesher.hpp"

#include <functional>
#include <optional>
#include <string>

namespace aeroloom::pipeline {

/// Sizing and surface mesh, in this order. Each takes its result from a checkpoint of an earlier run, if
/// there is one, else makes and keeps it. Results are copied into the record. Collective.
class SurfaceStages {
public:
  SurfaceStages(const parallel::Communicator& communicator, const cases::Case& input,
                Checkpoints& checkpoints, report::RunRecord& record)
      : _communicator(communicator), _input(input), _checkpoints(checkpoints), _record(record) {}

  /// The sizes, and the model they are for.
  domain::SizedDomain size(const cases::TypedPatches& domain);
  /// The surface. Where it cannot be meshed with joined faces or closed edges, that of the model as it was.
  /// Where sizes fell so much that the target is missed, of sizes that are chosen once more.
  FinishedSurface mesh(const cases::TypedPatches& domain, domain::SizedDomain sized);

private:
  domain::SizedDomain find_or_build_sizes(const cad::Model& domain);
  domain::SizedDomain build_sizes(const cad::Model& domain, const domain::Simplification& simplification);
  void note_sizes(const domain::SizedDomain& sized);
  std::optional<surface::SurfaceMesh> find_surface(const cad::Model& domain, domain::SizedDomain& sized);
  FinishedSurface finish_surface(const cases::TypedPatches& domain, const domain::SizedDomain& sized,
                                 surface::SurfaceMesh surface);
  surface::SurfaceMesh build_surface(const domain::SizedDomain& sized);
  std::optional<surface::SurfaceMesh> attempt_surface(const domain::SizedDomain& sized,
                                                      const std::function<void(const std::string&)>& tell);
  surface::SurfaceMesh build_surface(const cad::Model& domain, domain::SizedDomain& sized);
  bool choose_again(domain::SizedDomain& sized, surface::SurfaceMesh& made);
  surface::SurfaceMesh build_surface_or_advise(const cad::Model& domain, domain::SizedDomain& sized);

  const parallel::Communicator& _communicator;
  const cases::Case& _input;
  Checkpoints& _checkpoints;
  report::RunRecord& _record;
};

}  // namespace aeroloom::pipeline
