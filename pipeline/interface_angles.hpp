/// The angles that interfaces make with each other and with the boundary, between fine triangles.
#pragma once

#include "parallel/communicator.hpp"
#include "pipeline/piece_boundary.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::pipeline {

/// A fine edge where an interface ends: at the boundary, or at other interfaces. One row per piece around it.
struct InterfaceCorner {
  mesh::GlobalIndex low, high;  ///< vertex numbers of the edge
  std::int32_t part;
  std::int32_t on_surface;  ///< 1: the edge is a trace on the surface
  double angle;             ///< degrees inside the piece
  geometry::Vec3 middle;
};

/// The corners of one piece. Edges where it touches itself are left out.
std::vector<InterfaceCorner> find_interface_corners(const PieceBoundary& boundary, const VolumePlan& plan,
                                                    const MergedParts& parts, std::int32_t part);

/// A wish to move a vertex of an interface so that an angle opens.
struct VertexWish {
  mesh::GlobalIndex number;
  std::int32_t part, unused = 0;
  geometry::Vec3 displacement;
};

/// Where an angle of the piece is below `wanted` degrees: the vertices of the interface triangles there that
/// are off the surface, turned around the edge until it is as wanted.
std::vector<VertexWish> wish_wider_angles(const PieceBoundary& boundary, const VolumePlan& plan,
                                          const MergedParts& parts, std::int32_t part, double wanted);

/// An edge with a small angle.
struct SharpInterface {
  geometry::Vec3 point;
  double angle;        ///< the smallest around the edge, degrees
  double whole_angle;  ///< of all pieces around the edge together
};

struct InterfaceAngles {
  static constexpr double threshold = 35;  ///< degrees
  std::int64_t edges = 0, below = 0;       ///< edges; those with an angle below the threshold
  std::int64_t forced = 0;  ///< of those: the surface's own angle there is too small for a good cut
  double smallest = 180;
  std::array<std::int64_t, 18> histogram{};  ///< smallest angle around each edge, by 10 degrees
  std::vector<SharpInterface> sharpest;      ///< the sharpest below the threshold, at most 20
};

/// Collective; the same on every rank.
InterfaceAngles summarise_interfaces(const parallel::Communicator& communicator,
                                     const std::vector<InterfaceCorner>& corners);

}  // namespace aeroloom::pipeline
