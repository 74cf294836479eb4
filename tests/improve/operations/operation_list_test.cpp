#include "improve/operations/operations.hpp"
#include "improve/pieces/sweeps.hpp"
#include "tests/cad/primitives.hpp"
#include "tests/improve/fans.hpp"
#include "tests/improve/pieces.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

/// A row of the table: name, first sweep, fraction, whether costly.
using Row = std::tuple<std::string, int, double, bool>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '|');) {
    const auto first = cell.find_first_not_of(' ');
    cells.push_back(first == std::string::npos ? ""
                                               : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
  }
  return cells;
}

/// The rows below the line of the page that begins with this header.
std::vector<Row> rows_of_page(const std::string& header) {
  std::ifstream page(source_tree() / "docs" / "improvement.md");
  std::vector<Row> rows;
  bool inside = false;
  for (std::string line; std::getline(page, line);) {
    if (line.find(header) != std::string::npos) {
      inside = true;
      std::getline(page, line);  // the rule below the header
    } else if (inside && line.find('|') == std::string::npos) {
      break;
    } else if (inside) {
      const std::vector<std::string> cells = cells_of(line);
      rows.emplace_back(cells.at(1), std::stoi(cells.at(3)), std::stod(cells.at(4)), cells.at(5) == "yes");
    }
  }
  return rows;
}

TEST(OperationList, IsTheTableOfThePage) {
  std::vector<Row> rows;
  for (const ListedOperation& each : operations())
    rows.emplace_back(each.name, each.from_sweep, each.below, each.is_costly);
  EXPECT_EQ(rows, rows_of_page("| operation | what it does | from sweep |"));
}

TEST(OperationList, GivesTheLevelsOfSweeps) {
  EXPECT_EQ(level_of_sweep(1), 1);
  EXPECT_EQ(level_of_sweep(2), 1) << "adds nothing to the first";
  EXPECT_EQ(level_of_sweep(3), 3);
  EXPECT_EQ(level_of_sweep(4), 4);
  EXPECT_EQ(level_of_sweep(12), 4);
  EXPECT_EQ(last_level(), 4);
  EXPECT_EQ(last_level_in_narrow_regions(), 3) << "what comes later is costly";
}

LocalIndex worst_tet(const TetMesh& mesh) {
  LocalIndex worst = -1;
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.is_alive(t) && (worst < 0 || mesh.quality(t) < mesh.quality(worst))) worst = t;
  }
  return worst;
}

/// A mesh with operations on it: what Sweeps holds.
struct Workshop {
  explicit Workshop(mesh::Piece from, double target, cad::PointLocator* locator = nullptr)
      : piece(std::move(from)),
        volume(examples::volume(piece)),
        measure(target),
        mesh(piece, measure),
        local_target(measure),
        queue(mesh, local_target, last_level_in_narrow_regions()),
        context(mesh, local_target, limits, Effort::reduced, locator, queue) {}

  mesh::Piece piece;
  double volume;  ///< before
  mesh::TetQuality measure;
  TetMesh mesh;
  LocalTarget local_target;
  ChangeLimits limits;
  BadElementQueue queue;
  OperationContext context;
};

const ListedOperation& listed(std::string_view name) {
  for (const ListedOperation& each : operations()) {
    if (each.name == name) return each;
  }
  throw std::logic_error("no operation " + std::string(name));
}

/// Whether the operation improves the worst tetrahedron of a mesh. The mesh is as good as that says.
bool improves_worst(Workshop& at, std::string_view name) {
  const LocalIndex worst = worst_tet(at.mesh);
  const double before = at.mesh.quality(worst);
  EXPECT_LT(before, at.measure.target());
  const bool improved = listed(name).make(at.context)->improve(at.context, worst);
  const double after = at.mesh.quality(worst_tet(at.mesh));
  EXPECT_EQ(after > before, improved) << name;
  const OperationCounts& counts = at.context.counts;
  EXPECT_EQ(counts.replaced + counts.smoothed + counts.slid > 0, improved) << name;
  at.mesh.finish();
  EXPECT_NEAR(examples::volume(at.piece), at.volume, 0.05 * at.volume) << name;
  return improved;
}

/// A regular octahedron with a vertex in its middle and another close to that.
mesh::Piece octahedron_with_two_inside() {
  mesh::Piece piece = examples::make_octahedron({0, 0, 0});
  const LocalIndex added = piece.vertex_count();
  piece.coordinates.insert(piece.coordinates.end(), {0.05, 0.05, 0.05});
  piece.vertex_dimension.push_back(mesh::CadDimension::region);
  piece.vertex_entity.push_back(0);
  const std::array<LocalIndex, 4> first{piece.cell(0)[0], piece.cell(0)[1], piece.cell(0)[2],
                                        piece.cell(0)[3]};
  for (int k = 0; k < 4; ++k) {
    std::array<LocalIndex, 4> fresh = first;
    fresh[k] = added;
    if (k == 0) {
      std::copy(fresh.begin(), fresh.end(), piece.cells.begin());
    } else {
      piece.cells.insert(piece.cells.end(), fresh.begin(), fresh.end());
    }
  }
  return piece;
}

TEST(OperationList, EachImprovesAMeshMadeForIt) {
  std::set<std::string_view> improved;
  const auto expect_improves = [&](std::string_view name, mesh::Piece piece, double target) {
    Workshop at(std::move(piece), target);
    EXPECT_TRUE(improves_worst(at, name)) << name;
    improved.insert(name);
  };
  expect_improves("swap", examples::make_spindle(5), 15);
  expect_improves("swap", examples::make_flat_lid(0.02), 15);
  expect_improves("smoothing", examples::make_octahedron({0.6, 0.3, 0.05}), 28);
  expect_improves("contraction", octahedron_with_two_inside(), 28);
  expect_improves("vertex reinsertion", examples::make_octahedron({0.6, 0.3, 0.05}), 28);
  expect_improves("vertex insertion", examples::make_octahedron_with_sliver(), 15);
  expect_improves("polyhedron search", examples::make_spindle(5, 0.9), 28);

  const cad::Model model = make_primitive_domain(cad::PrimitiveKind::box);
  cad::PointLocator locator(model);
  const cad::Facets facets = model.facets(0, 0.05, 0.5);
  geometry::Vec2 middle;
  for (const geometry::Vec2 uv : facets.uv) middle += uv / static_cast<double>(facets.uv.size());
  mesh::Piece fan = examples::make_fan(model, 0, middle, {0.1, 0.1}, 0.05);
  std::fill(fan.vertex_dimension.begin() + 1, fan.vertex_dimension.end(), mesh::CadDimension::vertex);
  Workshop at(std::move(fan), 28, &locator);
  EXPECT_TRUE(improves_worst(at, "sliding"));
  improved.insert("sliding");

  for (const ListedOperation& each : operations()) EXPECT_TRUE(improved.contains(each.name)) << each.name;
}

// Without a model nothing slides; a mesh that is good as it can be stays.
TEST(OperationList, EachLeavesWhatItCannotImprove) {
  for (const ListedOperation& each : operations()) {
    mesh::Piece alone =
        examples::make_piece({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 0.1}}, {0, 1, 2, 3});
    examples::close_boundary(alone);
    Workshop at(std::move(alone), 28);
    const std::array<Vec3, 4> points = at.mesh.points(0);
    EXPECT_FALSE(each.make(at.context)->improve(at.context, 0)) << each.name;
    EXPECT_EQ(at.mesh.slot_count(), 1) << each.name;
    EXPECT_EQ(at.mesh.vertex_count(), 4) << each.name;
    EXPECT_EQ(at.mesh.points(0), points) << each.name;
    EXPECT_EQ(at.context.counts.replaced + at.context.counts.smoothed + at.context.counts.slid, 0);
  }
}

TEST(Sweeps, TryAnOperationFromItsSweepOn) {
  const auto vertices_after = [](int sweeps) {
    Workshop at(examples::make_prism_with_flat_tet(), 15);
    Sweeps on(at.mesh, at.local_target, at.limits);
    on.run(sweeps);
    EXPECT_EQ(on.counts().replaced, sweeps < 4 ? 0 : 1);
    at.mesh.finish();
    return at.piece.vertex_count();
  };
  EXPECT_EQ(vertices_after(3), 6);
  EXPECT_EQ(vertices_after(4), 7) << "vertex insertion";
}

// A vertex is smoothed rather than reinserted: the operation that stands first.
TEST(Sweeps, TryOperationsInTheirOrder) {
  Workshop at(examples::make_octahedron({0.6, 0.3, 0.05}), 28);
  Sweeps on(at.mesh, at.local_target, at.limits);
  on.run(12);
  EXPECT_GT(on.counts().smoothed, 0);
  EXPECT_EQ(on.counts().replaced, 0);
  EXPECT_GE(at.mesh.quality(worst_tet(at.mesh)), at.measure.target());
}

}  // namespace
}  // namespace aeroloom::improve
