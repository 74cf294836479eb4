// Faces whose border has edges with the face on both sides, as where two bodies touch along a line.
#include "mesh/checks/validity.hpp"
#include "surface/surface_mesher.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/references.hpp"
#include "tests/surface/face_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <gp_Ax2.hxx>
#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using parallel::Communicator;

/// A cylinder of radius 1 and a block below it, which touch along a line of length 1 on the cylinder's seam.
cad::Model touching_bodies() {
  const TopoDS_Shape rod =
      BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0), gp_Dir(0, 0, -1)), 1, 3).Shape();
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(gp_Pnt(-0.5, 1, -2), gp_Pnt(0.5, 2, -1)).Shape();
  cad::DomainOptions options;
  options.kind = cad::DomainKind::body;
  return cad::shapes::prepare(cad::shapes::compound_of<TopoDS_Shape>({rod, block}), options).model;
}

SurfaceMesh mesh_of(const cad::Model& model, std::int64_t piece_triangles,
                    const Communicator& communicator = Communicator::world()) {
  SurfaceOptions options;
  options.piece_triangles = piece_triangles;
  const sizing::SizeField field =
      sizing::build_size_field(communicator, model, {.minimum = 0.06, .maximum = 6, .surface_maximum = 0.06});
  return mesh_surface(model, field, options);
}

/// How many triangles have each edge along the line, by the place of its middle.
std::map<std::int64_t, int> triangles_at_line(const SurfaceMesh& surface) {
  std::vector<std::int64_t> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      for (int i = 0; i < 3; ++i) {
        const geometry::Vec3 a = piece.point(v[i]), b = piece.point(v[(i + 1) % 3]);
        const bool on_line = std::abs(a.x) < 1e-9 && std::abs(b.x) < 1e-9 && std::abs(a.z + 1) < 1e-9 &&
                             std::abs(b.z + 1) < 1e-9;
        if (on_line && std::min(a.y, b.y) >= 1 - 1e-9 && std::max(a.y, b.y) <= 2 + 1e-9)
          mine.push_back(std::llround(0.5e9 * (a.y + b.y)));
      }
    }
  }
  std::map<std::int64_t, int> counts;
  for (const std::int64_t place : surface.communicator.all_gather_items<std::int64_t>(mine)) ++counts[place];
  return counts;
}

// The cylinder keeps the line as a border in one piece and in many.
TEST(Slits, StayWhereAFaceIsDivided) {
  const cad::Model model = touching_bodies();
  for (const int piece_triangles : {100'000, 200}) {
    const SurfaceMesh surface = mesh_of(model, piece_triangles);
    EXPECT_TRUE(mesh::check_surface_mesh(surface).valid());
    EXPECT_EQ(surface.report.divided_faces > 0, piece_triangles < 100'000);
    const std::map<std::int64_t, int> counts = triangles_at_line(surface);
    EXPECT_NEAR(static_cast<double>(counts.size()), 1 / 0.06, 2);
    for (const auto& [place, count] : counts) EXPECT_EQ(count, 4) << place;
  }
}

TEST(Slits, AreTheSameOnAnyNumberOfRanks) {
  const cad::Model model = touching_bodies();
  references::expect_as_on_one_rank([&](const Communicator& communicator) {
    return mesh::hash_mesh(mesh::number_mesh(mesh_of(model, 200, communicator)));
  });
}

}  // namespace
}  // namespace aeroloom::surface
