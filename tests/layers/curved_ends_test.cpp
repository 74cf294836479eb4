/// Layers that end on a curved face: their nodes lie on it, up to the edge with a plane.
#include "layers/curved_ends.hpp"

#include "layers/end_planes.hpp"
#include "mesh/exchange/delivery.hpp"
#include "tests/layers/checked_layers.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using checked::build;
using examples::Fluid;
using examples::Shapes;
using geometry::Vec3;
using parallel::Communicator;

constexpr int floor_face = 0, bulge_face = 1, side_face = 2, lid_face = 3;

/// A box whose side x = 0 is the parabolic cylinder x = -bend z^2 instead, on a floor that slopes there.
struct Bulge {
  double bend = 0.2, slope = 0;

  double floor_at(double x) const { return slope * x; }
  Vec3 place(Vec3 p) const {
    const double z = p.z + floor_at(p.x) * (1 - p.z);
    return {p.x - bend * (1 - p.x) * z * z, p.y, z};
  }
  /// The parameter z of the nearest point in the plane y = const, by Newton's method.
  double nearest(Vec3 p) const {
    double z = p.z;
    for (int step = 0; step < 30; ++step) {
      const double off = p.x + bend * z * z;
      const double slope_of = 2 * bend * z * off - (p.z - z), curve = 1 + 2 * bend * (off + 2 * bend * z * z);
      z -= slope_of / curve;
    }
    return z;
  }
};

/// What the CAD is to a run.
class BulgeEnds : public CurvedEnds {
public:
  explicit BulgeEnds(const Bulge& bulge) : _bulge(bulge) {}
  Vec3 normal(std::int32_t face, Vec3 point) const override {
    return face == side_face ? Vec3{0, -1, 0} : normalized(Vec3{-1, 0, -2 * _bulge.bend * point.z});
  }
  std::optional<EndPlace> place(std::span<const std::int32_t> faces, Vec3 point) const override {
    EndPlace place;
    place.across[0] = normal(bulge_face, point);
    if (faces.size() == 2) {
      place.edge = 0;
      place.across[1] = {0, -1, 0};
    } else {
      place.face = bulge_face;
    }
    return place;
  }
  Vec3 onto(const EndPlace& place, Vec3 point) const override {
    const double z = _bulge.nearest(point);
    return {-_bulge.bend * z * z, place.edge == 0 ? 0 : point.y, z};
  }

private:
  Bulge _bulge;
};

mesh::DistributedMesh box_with_bulge(const Communicator& communicator, const Bulge& bulge) {
  Shapes shapes;
  shapes.add_box({0, 0, 0}, {1, 1, 1}, {8, 8, 8}, Fluid::inside);
  shapes.label([](Vec3 middle) {
    return middle.z == 0 ? floor_face : middle.x == 0 ? bulge_face : middle.y == 0 ? side_face : lid_face;
  });
  shapes.move([&](Vec3 p) { return bulge.place(p); });
  mesh::DistributedMesh mesh = shapes.distribute_faces(communicator, 2);
  mesh.patch_types = {mesh::PatchType::wall, mesh::PatchType::inlet, mesh::PatchType::symmetry,
                      mesh::PatchType::wall};
  return mesh;
}

LayerOptions layers_on_floor(const Bulge& bulge) {
  LayerOptions options;
  options.patches.resize(1);
  options.patches[0].first = 1e-3;
  options.ends_on_planes = true;
  options.curved_ends = std::make_shared<BulgeEnds>(bulge);
  return options;
}

/// Takes the faces that layers end on away, so that nobody minds them, and puts what is left of them last.
std::vector<mesh::SharedVertexKey> take_ends_away(const mesh::DistributedMesh&, mesh::DistributedMesh& cap) {
  std::vector<mesh::Piece> kept, ends;
  for (mesh::Piece& piece : cap.pieces) {
    const bool is_end = piece.common_face() != floor_face;
    piece.id -= is_end ? 2 : 0;
    if (is_end) piece.cells.clear(), piece.triangle_face.clear(), piece.triangle_patch.clear();
    if (is_end) piece.id += 2;
    (is_end ? ends : kept).push_back(std::move(piece));
  }
  kept.insert(kept.end(), ends.begin(), ends.end());
  cap.pieces = std::move(kept);
  return {};
}

TEST(CurvedEnds, AreThoseThatAWallMeets) {
  const Communicator world = Communicator::world();
  const Bulge bulge;
  const mesh::DistributedMesh mesh = box_with_bulge(world, bulge);
  LayerOptions options = layers_on_floor(bulge);
  const auto planes = find_end_planes(mesh, options);
  EXPECT_EQ(planes[bulge_face], Vec3{});
  EXPECT_EQ(find_curved_ends(mesh, options, planes, mesh::SharedVertices(mesh))[bulge_face], 1);
  EXPECT_EQ(find_curved_ends(mesh, options, planes, mesh::SharedVertices(mesh))[side_face], 0) << "a plane";
  EXPECT_EQ(find_curved_ends(mesh, options, planes, mesh::SharedVertices(mesh))[floor_face], 0)
      << "it has layers itself";
  options.curved_ends = nullptr;
  EXPECT_EQ(find_curved_ends(mesh, options, planes, mesh::SharedVertices(mesh)),
            std::vector<std::uint8_t>(4, 0));
}

TEST(CurvedEnds, HoldTheNodesOfLayers) {
  const Communicator world = Communicator::world();
  const Bulge bulge;
  const mesh::DistributedMesh mesh = box_with_bulge(world, bulge);
  const Layers layers = build(mesh, layers_on_floor(bulge), take_ends_away);
  std::int64_t on_bulge = 0, least = 1000;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    const mesh::Piece& piece = mesh.pieces[p];
    if (piece.common_face() != floor_face) continue;
    const PieceColumns& columns = layers.columns.pieces[p];
    for (const auto& corners : columns.corner_columns) {
      // Seen from the fluid; the cells are checked from their definition.
      checked::check_cells(piece, columns, {corners[0], corners[2], corners[1]});
    }
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Vec3 from = piece.point(v);
      if (from.x > 0 || from.y == 1) continue;
      ++on_bulge;
      least = std::min<std::int64_t>(least, columns.counts[v]);
      for (std::int32_t k = 1; k <= columns.counts[v]; ++k) {
        const Vec3 at = node(piece, columns, columns.first_column[v], k);
        EXPECT_NEAR(at.x, -bulge.bend * at.z * at.z, 1e-15);
        EXPECT_NEAR(at.z, height(columns, v, k), 0.02 * height(columns, v, k));
        if (from.y == 0) EXPECT_EQ(at.y, 0) << "on the edge with the plane";
      }
    }
  }
  EXPECT_GE(world.sum(on_bulge), 8);
  EXPECT_GE(world.minimum(static_cast<double>(least)), 15) << "as many as elsewhere";
}

TEST(CurvedEnds, AreLeftWhereTheWallMeetsThemTooObliquely) {
  const Communicator world = Communicator::world();
  for (const double slope : {1.0, 2.0}) {  // 45 and 27 degrees between floor and bulge
    const Bulge bulge{0.2, slope};
    const mesh::DistributedMesh mesh = box_with_bulge(world, bulge);
    const Layers layers = build(mesh, layers_on_floor(bulge), take_ends_away);
    std::int64_t columns = 0;
    for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
      for (mesh::LocalIndex v = 0; v < mesh.pieces[p].vertex_count(); ++v) {
        const Vec3 at = mesh.pieces[p].point(v);
        if (at.x == 0 && at.z == 0 && at.y > 0 && at.y < 1) columns += layers.columns.pieces[p].counts[v] > 0;
      }
    }
    EXPECT_EQ(world.sum(columns) > 0, slope == 1);
  }
}

}  // namespace
}  // namespace aeroloom::layers
