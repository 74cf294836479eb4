/// Failures of the volume stage.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/collective_error.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// A zone that no retry fills. The message names CAD faces, place and sizes, what was tried and
/// what to do; the triangles at fault are for a file to look at. The same on every rank.
class VolumeFailure : public parallel::CollectiveError {
public:
  VolumeFailure(const std::string& message, std::vector<geometry::Vec3> points,
                std::vector<std::array<mesh::LocalIndex, 3>> triangles)
      : CollectiveError(parallel::FailureKind::input, message),
        _points(std::move(points)),
        _triangles(std::move(triangles)) {}
  const std::vector<geometry::Vec3>& points() const { return _points; }
  const std::vector<std::array<mesh::LocalIndex, 3>>& triangles() const { return _triangles; }

private:
  std::vector<geometry::Vec3> _points;
  std::vector<std::array<mesh::LocalIndex, 3>> _triangles;
};

}  // namespace aeroloom::volume
