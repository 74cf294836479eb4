/// Sweeps over the tetrahedra below their targets, worst first.
#pragma once

#include "improve/operations/bad_element_queue.hpp"
#include "improve/operations/operation.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace aeroloom::improve {

/// Tries the listed operations (operations.hpp) on each tetrahedron in turn, until one succeeds.
class Sweeps {
public:
  /// All must outlive it. With a locator, vertices of the boundary slide on its model.
  Sweeps(TetMesh& mesh, const LocalTarget& local_target, const ChangeLimits& limits,
         Effort effort = Effort::reduced, cad::PointLocator* locator = nullptr);

  /// For a mesh that was improved already, but for these tetrahedra, which took the place of an
  /// over-constrained one. Others rest until something around them changes, and no change brings more
  /// tetrahedra with several faces on the boundary.
  void follow_removal(const std::vector<LocalIndex>& fresh);
  /// At most `most` sweeps; ends earlier when one gains hardly anything.
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
  std::vector<std::unique_ptr<LocalOperation>> _operations;  ///< as listed, each made when it is first tried
};

}  // namespace aeroloom::improve
