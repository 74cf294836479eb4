/// The rows on a CAD face: where their vertices lie, and the triangles between.
#pragma once

#include "cad/model/model.hpp"
#include "mesh/data/piece.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/curves/curves.hpp"
#include "surface/rows/edge_rows.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// A vertex of rows on the face.
struct RowVertex {
  geometry::Vec3 point;
  geometry::Vec2 uv;
};

/// Rows on the left of a use of an edge.
struct RowStrip {
  cad::Coedge use;
  std::vector<CurveVertex> chain;   ///< of the edge, in the direction of its parameter
  std::vector<double> parameters;   ///< of those
  std::vector<RowVertex> vertices;  ///< column by column, each from the lowest row to the highest
  std::vector<std::size_t> first;   ///< by vertex of the chain, and one more: of its column
  /// By vertex of the chain: the number of its highest vertex among those of the face, which count strip by
  /// strip; -1: it has no rows.
  std::vector<std::int32_t> tops;

  bool empty() const { return vertices.empty(); }
  std::size_t rows_at(std::size_t i) const { return first[i + 1] - first[i]; }
  /// The vertex of column i above so many rows, at least one.
  const RowVertex& above(std::size_t i, std::size_t rows) const { return vertices[first[i] + rows - 1]; }
  const RowVertex& top(std::size_t i) const { return above(i, rows_at(i)); }
};

/// A corner of a triangle of rows: a column, and the rows below it there.
struct RowPlace {
  std::size_t column, level;
};

/// Calls visit(corners) for the triangles between vertex i of the chain and the next, counter-clockwise.
/// Diagonals alternate.
template <class Visit>
void for_each_row_triangle(const RowStrip& strip, std::size_t i, const Visit& visit) {
  const std::size_t a = strip.use.reversed ? i + 1 : i, b = strip.use.reversed ? i : i + 1;
  const std::size_t of_a = strip.rows_at(a), of_b = strip.rows_at(b);
  const std::size_t both = std::min(of_a, of_b);
  for (std::size_t k = 0; k < both; ++k) {
    const RowPlace low_a{a, k}, low_b{b, k}, high_a{a, k + 1}, high_b{b, k + 1};
    if ((i + k) % 2 == 0) {
      visit(std::array{low_a, low_b, high_b});
      visit(std::array{low_a, high_b, high_a});
    } else {
      visit(std::array{low_a, low_b, high_a});
      visit(std::array{low_b, high_b, high_a});
    }
  }
  if (of_a > both) visit(std::array{RowPlace{a, both}, RowPlace{b, both}, RowPlace{a, both + 1}});
  if (of_b > both) visit(std::array{RowPlace{a, both}, RowPlace{b, both}, RowPlace{b, both + 1}});
}

/// The length of the longer segment of the edge at a vertex of the chain.
double longest_segment(const CurveMesh& curves, const RowStrip& strip, std::size_t i);

/// Where rows cannot be.
struct RowFailure {
  CurveVertex vertex;
  double size;  ///< to be asked for there
};

struct FaceRows {
  cad::FaceId face = cad::no_entity;
  std::vector<RowStrip> strips;  ///< in the order of the face's loops; those without rows are left out
  std::vector<RowFailure> failures;

  bool empty() const { return strips.empty(); }
  const RowStrip* strip_of(const cad::Coedge& use) const;
  /// The key of a top; they are shared with the rest of the face.
  mesh::SharedVertexKey top_key(std::int32_t top) const;
};

/// Rows on a face, as `rows`, by CAD edge, ask for them. Columns go off the edge at right angles, on the
/// surface of the CAD. Where one cannot, or a triangle would be turned over, the failure is listed. Depends
/// on the arguments alone. Not for faceted faces, which have none.
FaceRows find_face_rows(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                        std::span<const EdgeRows> rows);

/// The triangles of rows as a piece without id.
mesh::Piece piece_of_rows(const cad::Model& model, const FaceRows& rows, const CurveMesh& curves);

/// The sizes that make rows fewer where they failed.
std::vector<sizing::SizeSource> remedies_of(const FaceRows& rows, const CurveMesh& curves);

}  // namespace aeroloom::surface
