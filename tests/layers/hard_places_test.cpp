/// Layers where walls meet or come close as they do on aircraft: a strut beside a wall, a cylinder on a plane
/// of symmetry, trailing edges on a fuselage.
#include "tests/layers/checked_layers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>

namespace aeroloom::layers {
namespace {

using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;
using namespace checked;

// --- a strut

/// A wall of coarse triangles, and a strut above it within the height that layers on the wall would have.
Shapes strut_over_a_wall(double x) {
  return Shapes()
      .add_sphere({0, 0, 0}, 15, 8, Fluid::inside)
      .add_box({-2, -2, -1}, {2, 2, 0}, {8, 8, 2}, Fluid::outside)
      .add_box({x - 0.1, -1.5, 0.3}, {x + 0.1, 1.5, 0.5}, {2, 16, 2}, Fluid::outside);
}

TEST(HardPlaces, LayersStayBelowAStrutOverTheirWall) {
  const auto world = Communicator::world();
  for (const double x : {0.0, 0.25}) {  // over vertices of the wall, and between them
    const mesh::DistributedMesh mesh = strut_over_a_wall(x).distribute(world, 5);
    const Layers layers = build(mesh, options_for({0, 1e-3, 1e-3}));
    expect_valid(mesh, layers);
    std::int64_t below = 0;
    for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
      for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
        const Vec3 from = mesh.pieces[p].point(v), to = layers.cap.pieces[p].point(v);
        if (from.z != 0 || std::abs(from.x - x) > 0.3 || std::abs(from.y) > 1.4) continue;
        EXPECT_LT(to.z, 0.25) << from.x << " " << from.y;
        EXPECT_GT(layers.columns.pieces[p].counts[v], 5);
        ++below;
      }
    }
    EXPECT_GE(world.sum(below), 5);
    EXPECT_GT(layers.report.patches[1].limited_area[static_cast<std::size_t>(LayerLimit::gap)], 0);
    EXPECT_EQ(layers.report.patches[2].empty_area, 0) << "the strut has layers itself";
  }
}

// --- sections between two planes

constexpr int body_face = 0, outer_face = 1, floor_face = 2, ceiling_face = 3;
constexpr int around = 40;  // vertices of a section

/// A point of a section by its number, from 0 at the trailing edge, clockwise seen from above.
using Section = std::function<Vec3(int)>;

/// The room around a body of this section that stands between a floor at z = 0 and a ceiling at z = 1.
Shapes around_a_body(const Section& section) {
  const auto place = [section](Vec3 p) {
    const double angle = -2 * M_PI * p.x;
    const Vec3 inner = section(static_cast<int>(std::lround(p.x * around)) % around),
               outer{4 * std::cos(angle), 4 * std::sin(angle), 0};
    const double out = (std::pow(4.0, p.y) - 1) / 3;
    const Vec3 at = p.y == 1 ? outer : inner + out * (outer - inner);
    return Vec3{at.x, at.y, p.z};
  };
  return Shapes().add_ring({around, 8, 8}, place).label([](Vec3 middle) {
    if (middle.z == 0) return floor_face;
    if (middle.z == 1) return ceiling_face;
    return std::hypot(middle.x, middle.y) > 2 ? outer_face : body_face;
  });
}

Vec3 circle(int i) {
  return {std::cos(-2 * M_PI * i / around), std::sin(-2 * M_PI * i / around), 0};
}

/// Half of an aerofoil's thickness at x from -1 to 1, which ends in an angle of 19 degrees.
double half_thickness(double x) {
  return 0.12 * (1 - x) * std::sqrt(1 + x);
}

Vec3 sharp_section(int i) {
  const Vec3 on_circle = circle(i);
  return {on_circle.x, std::copysign(half_thickness(on_circle.x), on_circle.y), 0};
}

/// The same, thickened towards an end that is 0.06 wide, of two edges.
Vec3 blunt_section(int i) {
  if (i == 0) return {1, 0, 0};
  const double angle = -2 * M_PI * (i - 1) / (around - 2), x = std::cos(angle);
  const double side = i < around / 2 ? -1 : 1;
  return {x, side * (half_thickness(x) + 0.015 * (1 + x)), 0};
}

/// Takes the planes away, which come last, so that nobody minds them.
std::vector<mesh::SharedVertexKey> take_planes_away(const mesh::DistributedMesh&,
                                                    mesh::DistributedMesh& cap) {
  for (mesh::Piece& piece : cap.pieces) {
    if (piece.common_face() < floor_face) continue;
    piece.cells.clear(), piece.triangle_face.clear(), piece.triangle_patch.clear();
  }
  return {};
}

TEST(HardPlaces, LayersOfACylinderEndOnPlanesOfSymmetry) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = around_a_body(circle).distribute_faces(world, 2);
  mesh.patch_types = {mesh::PatchType::wall, mesh::PatchType::farfield, mesh::PatchType::symmetry,
                      mesh::PatchType::symmetry};
  LayerOptions options = options_for({1e-3});
  options.ends_on_planes = true;
  const Layers layers = build(mesh, options, take_planes_away);
  const PatchLayers& patch = layers.report.patches[body_face];
  EXPECT_NEAR(patch.full_area / patch.area, 1, 1e-12) << "to the last vertex on the planes";
  std::int64_t on_planes = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    if (piece.common_face() != body_face) continue;
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const auto& [a, b, c] = columns.corner_columns[t];
      check_cells(piece, columns, {a, c, b});
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 from = piece.point(v), to = node(piece, columns, columns.first_column[v], columns.counts[v]);
      EXPECT_NEAR(columns.first[v], 1e-3, 2e-5);
      if (from.z != 0 && from.z != 1) continue;
      EXPECT_EQ(std::bit_cast<std::uint64_t>(to.z), std::bit_cast<std::uint64_t>(from.z));
      ++on_planes;
    }
  }
  EXPECT_GE(world.sum(on_planes), 2 * around);
}

TEST(HardPlaces, FansOfASharpEdgeEndOnPlanesOfSymmetry) {
  const auto world = Communicator::world();
  mesh::DistributedMesh mesh = around_a_body(sharp_section).distribute_faces(world, 2);
  mesh.patch_types = {mesh::PatchType::wall, mesh::PatchType::farfield, mesh::PatchType::symmetry,
                      mesh::PatchType::symmetry};
  for (mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (piece.point(v).x == 1) piece.vertex_dimension[v] = mesh::CadDimension::vertex;
    }
  }
  LayerOptions options = options_for({1e-3});
  options.ends_on_planes = true;
  const Layers layers = build(mesh, options, take_planes_away);
  std::int64_t at_edge = 0, ends = 0, rims = 0;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    const PieceColumns& columns = layers.columns.pieces[p];
    rims += static_cast<std::int64_t>(columns.rims.size());
    if (piece.common_face() != body_face) continue;
    const CapLayout layout = lay_out_cap(piece, columns);
    for (std::size_t f = 0; f < columns.fan_faces.size(); ++f) {
      const FanFace& face = columns.fan_faces[f];
      ASSERT_TRUE(face.is_sector());
      check_fan(piece, columns, face, layers.cap.pieces[p].point(layout.apex_of_face[f]));
      for (int end = 0; end < 2; ++end) {
        const double z = piece.point(columns.vertex_of(face.columns[2 * end])).z;
        const std::int32_t plane = z == 0 ? floor_face : z == 1 ? ceiling_face : -1;
        EXPECT_EQ(face.end_faces[end], plane);
        ends += plane >= 0;
      }
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 from = piece.point(v);
      if (from.x != 1) continue;
      ++at_edge;
      EXPECT_GE(columns.columns_at(v), 6);
      for (std::int32_t c = columns.first_column[v]; c < columns.first_column[v + 1]; ++c) {
        const Vec3 to = node(piece, columns, c, columns.counts[v]);
        EXPECT_NEAR(to.z, from.z, 1e-12) << "at right angles to the edge";
        if (from.z != 0 && from.z != 1) continue;
        EXPECT_EQ(std::bit_cast<std::uint64_t>(to.z), std::bit_cast<std::uint64_t>(from.z));
      }
    }
  }
  EXPECT_GE(world.sum(at_edge), 9);
  EXPECT_GE(world.sum(ends), 2 * 5);
  EXPECT_EQ(world.sum(rims), world.sum(ends));
}

/// Layers on a wing and on the fuselages at both its ends; what is empty is at most so much of the wing.
void expect_layers_on_wing(const Section& section, double empty, double full) {
  const auto world = Communicator::world();
  const mesh::DistributedMesh mesh = around_a_body(section).distribute(world, 6);
  LayerOptions options = options_for({1e-3, 0, 1e-3, 1e-3});
  for (WallLayers& wall : options.patches) wall.count = 10;
  const Layers layers = build(mesh, options);
  expect_valid(mesh, layers);
  const PatchLayers &wing = layers.report.patches[body_face], &fuselage = layers.report.patches[floor_face];
  EXPECT_LE(wing.empty_area, empty * wing.area);
  EXPECT_GE(wing.full_area, full * wing.area);
  EXPECT_GT(fuselage.full_area, 0.2 * fuselage.area) << "where it does not end";
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
      const Vec3 at = mesh.pieces[p].point(v);
      if (at.x != 1 || std::abs(at.y) > 0.1 || layers.columns.pieces[p].counts[v] == 0) continue;
      EXPECT_GE(layers.columns.pieces[p].first[v], 1e-3 * (1 - 1e-9)) << "first heights stay";
    }
  }
}

TEST(HardPlaces, ASharpTrailingEdgeMeetsAFuselage) {
  expect_layers_on_wing(sharp_section, 0, 0.9);
}

TEST(HardPlaces, ABluntTrailingEdgeMeetsAFuselage) {
  expect_layers_on_wing(blunt_section, 0, 0.9);
}

}  // namespace
}  // namespace aeroloom::layers
