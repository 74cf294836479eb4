/// The whole program as one call, for host programs: a case becomes a mesh in memory.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {

/// A finished mesh, as `aeroloom run` writes it.
struct MeshOfCase {
  /// Cells of the volume by piece, those of boundary layers included, with global numbers. Names and types of
  /// patches, names of regions. Each rank has its pieces.
  mesh::NumberedMesh mesh;
  std::string hash;    ///< of the mesh, as in the report; the same for any number of ranks
  std::string missed;  ///< limits of the gates that the mesh misses, a line for each; empty: it meets all
  std::string unit;    ///< of the coordinates, as the CAD declares it; may be empty
  double unit_in_metres = 1;  ///< 1 where none is declared
};

/// A stage failed. Message, stage and code are equal on every rank.
class CaseFailure : public std::runtime_error {
public:
  CaseFailure(std::string stage, int code, const std::string& message)
      : std::runtime_error(message), _stage(std::move(stage)), _code(code) {}
  const std::string& stage() const { return _stage; }
  int code() const { return _code; }  ///< the exit code of `aeroloom run` (docs/usage.md)

private:
  std::string _stage;
  int _code;
};

/// Reads a case file on rank 0, as cases::read_case() does; every rank gets the case. Collective. Throws
/// CollectiveError (input) for an invalid case.
cases::Case read_case(const parallel::Communicator& communicator, const std::string& file,
                      const std::vector<std::string>& overrides = {});

/// Runs all stages of a case with checks between them: geometry, sizes, surface, layers, volume, improvement,
/// inspection, gates. Every rank gives the same case. Of the section `output` nothing holds: no file is
/// written. Collective. Throws CaseFailure. A mesh that misses a limit of a gate is no failure
/// (MeshOfCase::missed).
MeshOfCase run(const cases::Case& input, const parallel::Communicator& communicator);

}  // namespace aeroloom::pipeline
