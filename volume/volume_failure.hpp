/// The failure of the volume stage.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "parallel/communication/collective_error.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// Thrown if a zone cannot be filled. The message names CAD faces, the place, sizes, retries and a remedy.
/// The triangles at fault can be written to a file. The same on every rank.
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
