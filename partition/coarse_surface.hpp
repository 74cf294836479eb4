/// The coarse boundary of the background volume, from the rims of the cells of the fine surface.
///
/// Where the rims of three cells or more meet is a corner; between corners a rim is a *path* along fine
/// edges, and becomes one or several straight *chords*. The chords around a cell are a polygon, filled with
/// triangles from a fine vertex inside of it, or without one. So each chord stands for a path of fine edges:
/// where an interface of the volume decomposition follows a chord, its fine trace follows the path, and
/// conforms with the fine surface by construction.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/piece.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// A fine edge on the rim of a cell, in the direction of the cell's triangle.
struct RimEdge {
  mesh::GlobalIndex from, to;  ///< vertices of the fine surface
  std::int32_t cell, unused = 0;
};
struct FineVertex {
  mesh::GlobalIndex number;
  geometry::Vec3 point;
  std::int32_t dimension, entity;  ///< classification, as in mesh::Piece
};
struct Cell {
  std::int32_t id, face;   ///< global number; CAD face
  mesh::GlobalIndex apex;  ///< vertex inside the cell, near its middle; -1: it has none
  geometry::Vec3 apex_point;
  geometry::Vec3 area;  ///< sum of the triangles' area vectors
};

/// A straight edge of the coarse surface that stands for fine edges.
struct Chord {
  std::int32_t from, to;           ///< coarse vertices
  std::vector<std::int32_t> path;  ///< rim vertices from `from` to `to`, these included
};

struct CoarseSurface {
  std::vector<FineVertex> rim;                         ///< vertices on rims, by number
  std::vector<FineVertex> vertices;                    ///< coarse ones: corners, then apexes
  std::vector<std::int8_t> is_apex;                    ///< per coarse vertex
  std::vector<Chord> chords;                           ///< at most one between two vertices
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< oriented like the fine ones
  std::vector<std::int32_t> cell_of;                   ///< per triangle
  std::vector<std::int32_t> unfit;                     ///< cells whose polygon does not do: to be cut
};

/// Cells by id, ids from 0. The order of the edges and vertices does not matter; vertices may come
/// repeatedly.
CoarseSurface build_coarse_surface(std::vector<RimEdge> edges, std::vector<FineVertex> vertices,
                                   const std::vector<Cell>& cells);

}  // namespace aeroloom::partition
