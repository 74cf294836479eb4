/// Sweeps over the tetrahedra below their targets, worst first.
#pragma once

#include "improve/operations/bad_element_queue.hpp"
#include "improve/operations/operation.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace aeroloom::improve {

/// Tries the operations in the order of their list (operations.hpp) on each tetrahedron, until one succeeds.
class Sweeps {
public:
  /// All arguments must outlive the object. With a locator, boundary vertices slide on its CAD model.
  Sweeps(TetMesh& mesh, const LocalTarget& local_target, const ChangeLimits& limits,
         Effort effort = Effort::reduced, cad::PointLocator* locator = nullptr);

  /// Prepares for a mesh in which only the tetrahedra `fresh` are new: they replaced an over-constrained one.
  /// Others are skipped until something around them changes. No change may add over-constrained tetrahedra.
  void follow_removal(const std::vector<LocalIndex>& fresh);
  /// Does at most `most` sweeps; fewer if a sweep gains hardly anything.
  void run(int most);
  const OperationCounts& counts() const { return _context.counts; }

private:
  struct Gains {
    std::int64_t tasks, gains;
  };
  Gains sweep(int level);
  bool improve(LocalIndex t, int level);

  const TetMesh& _mesh;
  BadElementQueue _queue;
  OperationContext _context;
  std::vector<std::unique_ptr<LocalOperation>> _operations;  ///< as listed, each made at its first use
};

}  // namespace aeroloom::improve
