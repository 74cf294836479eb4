/// A mesh on a canvas: what this rank holds of it. None of this is collective.
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
  double edge_opacity = 0;     ///< of lines along the edges of all triangles; without, shades are smoothed
  double outline_width = 1.2;  ///< pixels, of outlines, sharp edges and borders of patches
};

/// Draws what the scene shows, as who stands in the flow sees it: walls from their flow side only. Walls
/// of a duct so are seen from inside, through those in front. Lines along edges fade where triangles get
/// smaller than three pixels.
void draw_surface(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const EdgeNeighbours& neighbours, const Scene& scene, const SurfaceLook& look);

/// A plane of points p with dot(normal, p) = offset.
struct Plane {
  geometry::Vec3 normal;
  double offset = 0;
};

/// Draws the tetrahedra that the plane cuts, exactly where it cuts them, in the colours of their smallest
/// dihedral angle; cells of boundary layers in a colour of their own. What only touches the plane counts if
/// it lies on the positive side of it.
void draw_cut(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& volume, Plane plane,
              double edge_opacity);

/// Draws the lines in which the plane cuts what is shown of the surface, in front of everything in the plane.
void draw_section(Canvas& canvas, const Camera& camera, const mesh::DistributedMesh& surface,
                  const Scene& scene, Plane plane, double width);

/// Fills the part of the plane in a box behind everything that is drawn.
void draw_backdrop(Canvas& canvas, const Camera& camera, const geometry::Box& box, Colour colour);

}  // namespace aeroloom::picture
