/// Draws the mesh pieces of this rank on a canvas. Not collective.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "pipeline/report/picture/camera.hpp"
#include "pipeline/report/picture/canvas.hpp"
#include "pipeline/report/picture/edge_neighbours.hpp"
#include "pipeline/report/picture/scene.hpp"

#include <vector>

namespace aeroloom::picture {

struct SurfaceLook {
  std::vector<Colour> patch_colours;  ///< by patch
  double edge_opacity = 0;            ///< of lines along all edges; at 0, shading is smoothed instead
  double outline_width = 1.2;         ///< in pixels, of outlines, sharp edges and patch borders
  /// By piece and triangle, in place of colours by patch.
  const std::vector<std::vector<Colour>>* triangle_colours = nullptr;
};

/// Draws the shown walls from their flow side only. Nearer walls of a duct are therefore invisible. Lines
/// along edges fade where triangles are smaller than three pixels.
void draw_surface(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const EdgeNeighbours& neighbours, const Scene& scene, const SurfaceLook& look);

/// The plane of points p with dot(normal, p) = offset.
struct Plane {
  geometry::Vec3 normal;
  double offset = 0;
};

/// Draws the exact section of tetrahedra by the plane, coloured by smallest dihedral angle. Layer cells have
/// their own colour. A tetrahedron that only touches the plane counts if it lies on the positive side.
void draw_cut(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& volume, Plane plane,
              double edge_opacity);

/// Draws the lines where the plane cuts the shown surface, in front of the section.
void draw_section(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const Scene& scene, Plane plane, double width);

/// Fills the plane inside the box, behind all other drawings.
void draw_backdrop(Canvas& canvas, const Camera& camera, const geometry::Box& box, Colour colour);

}  // namespace aeroloom::picture
