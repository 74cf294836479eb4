#include "cad/model/evaluation/point_locator.hpp"
#include "improve/improver.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/improve/shaken.hpp"

#include <map>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using examples::examine;
using examples::expect_valid;
using geometry::Vec3;
using mesh::LocalIndex;

/// The sides of the box [-0.5, 0.5]^3 a point is on: -1, 0 or 1 per axis.
using Sides = std::array<int, 3>;

Sides sides_of(Vec3 p) {
  Sides sides{};
  for (int axis = 0; axis < 3; ++axis) sides[axis] = p[axis] < -0.4999 ? -1 : p[axis] > 0.4999 ? 1 : 0;
  return sides;
}

/// The entities of the box by the sides their middles are on.
struct Entities {
  std::map<Sides, std::int32_t> faces, edges, vertices;
};

Entities entities_of(const cad::Model& model) {
  Entities found;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const cad::Facets facets = model.facets(f, 0.1, 0.5);
    Vec3 middle;
    for (const Vec3 p : facets.points) middle += p / static_cast<double>(facets.points.size());
    found.faces[sides_of(middle)] = f;
  }
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const cad::Edge& edge = model.edge(e);
    found.edges[sides_of(model.edge_point(e, 0.5 * (edge.first_parameter + edge.last_parameter)))] = e;
  }
  for (cad::VertexId v = 0; v < model.vertex_count(); ++v) found.vertices[sides_of(model.vertex(v))] = v;
  return found;
}

/// A cube classified on the model, all but its corners moved at random along what they are on.
mesh::examples::WholeMesh shaken_on_cad(const cad::Model& model, int pieces, std::uint32_t seed) {
  const Entities entities = entities_of(model);
  std::mt19937 random(seed);
  mesh::examples::WholeMesh whole = mesh::examples::whole_cube(5, pieces);
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    whole.points[v] -= Vec3{0.5, 0.5, 0.5};
    const Sides sides = sides_of(whole.points[v]);
    const auto& table = whole.dimensions[v] == mesh::CadDimension::face   ? entities.faces
                        : whole.dimensions[v] == mesh::CadDimension::edge ? entities.edges
                                                                          : entities.vertices;
    if (is_on_boundary(whole.dimensions[v])) whole.entities[v] = table.at(sides);
  }
  for (std::size_t t = 0; t < whole.boundary.size(); ++t) {
    Sides side{};
    side[whole.faces[t] / 2] = whole.faces[t] % 2 == 0 ? -1 : 1;
    whole.faces[t] = entities.faces.at(side);
  }
  examples::shake(whole, 0.12, random);
  std::vector<std::vector<int>> cells_of(whole.points.size());
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const int v : whole.cells[c]) cells_of[v].push_back(static_cast<int>(c));
  }
  for (std::size_t v = 0; v < whole.points.size(); ++v) {
    if (whole.dimensions[v] == mesh::CadDimension::region) continue;
    const Vec3 origin = whole.points[v];
    const Sides sides = sides_of(origin);
    for (int axis = 0; axis < 3; ++axis)
      whole.points[v][axis] += sides[axis] == 0 ? 0.08 * (random() / 2147483648.0 - 1) : 0;
    const auto holds = [&](int c) { return examples::is_positive(whole, whole.cells[c]); };
    if (!std::all_of(cells_of[v].begin(), cells_of[v].end(), holds)) whole.points[v] = origin;
  }
  return whole;
}

/// Every vertex is on what it says, and every triangle on its face.
void expect_on_cad(const cad::Model& model, const std::vector<mesh::Piece>& pieces) {
  const Entities entities = entities_of(model);
  for (const mesh::Piece& piece : pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const Sides sides = sides_of(piece.point(v));
      const auto on = std::count_if(sides.begin(), sides.end(), [](int s) { return s != 0; });
      ASSERT_EQ(static_cast<mesh::CadDimension>(3 - on), piece.vertex_dimension[v]);
      if (on == 1) {
        EXPECT_EQ(entities.faces.at(sides), piece.vertex_entity[v]);
      }
      if (on == 2) {
        EXPECT_EQ(entities.edges.at(sides), piece.vertex_entity[v]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (sides[axis] != 0) {
          EXPECT_EQ(std::abs(piece.point(v)[axis]), 0.5);
        }
      }
    }
  }
}

TEST(ImproveOnCadLocal, SlidesAndKeepsTheBox) {
  const auto self = parallel::Communicator::self();
  const cad::Model model = cad::make_primitive_domain(cad::PrimitiveKind::box);
  cad::PointLocator locator(model);
  std::int64_t slid = 0;
  for (std::uint32_t seed = 0; seed < 9; ++seed) {
    const int pieces = 1 + static_cast<int>(seed % 3);
    mesh::DistributedMesh with = mesh::examples::distribute(self, shaken_on_cad(model, pieces, seed), pieces);
    mesh::DistributedMesh without = with;
    expect_valid(with);
    expect_on_cad(model, with.pieces);
    const ImproveOptions options;
    const auto before = examine(with.pieces, options.target_angle);
    slid += improve_mesh(with, options, {&locator, nullptr}).slid;
    const auto after = examine(with.pieces, options.target_angle);
    expect_valid(with);
    expect_on_cad(model, with.pieces);
    EXPECT_GT(after.quality, before.quality);
    EXPECT_EQ(improve_mesh(without, options).slid, 0);
    EXPECT_GE(after.angle, 10) << seed;
  }
  EXPECT_GT(slid, 50);
}

TEST(ImproveOnCad, DependsOnThePiecesAlone) {
  const auto world = parallel::Communicator::world(), self = parallel::Communicator::self();
  const cad::Model model = cad::make_primitive_domain(cad::PrimitiveKind::box);
  const auto improved_hash = [&](const parallel::Communicator& communicator) {
    cad::PointLocator locator(model);
    mesh::DistributedMesh mesh = mesh::examples::distribute(communicator, shaken_on_cad(model, 5, 4), 5);
    improve_mesh(mesh, {}, {&locator, nullptr});
    return mesh::hash_mesh(mesh::number_mesh(mesh));
  };
  EXPECT_EQ(improved_hash(world), improved_hash(self));
}

}  // namespace
}  // namespace aeroloom::improve
