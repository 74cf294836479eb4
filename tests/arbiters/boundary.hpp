/// The boundary of a mesh: beside the polygons of surface files, and beside the CAD.
#pragma once

#include "cells.hpp"

#include <string>
#include <vector>

namespace layercheck {

struct Polygon {
  std::vector<Point> corners;
  std::string patch;  ///< empty where the file names none
};

/// A surface of the CAD under a patch: numbers are those of a sphere (centre, radius), a cylinder (point of
/// the axis, its direction, radius) or a plane (point, normal).
struct CadSurface {
  std::string kind;
  std::string patch;
  std::vector<double> numbers;
};

/// How many numbers the kind takes; 0: there is no such kind.
int numbers_of(const std::string& kind);

double distance(const CadSurface& surface, const Point& point);

/// Reads a .vtp or .pvtp.
std::vector<Polygon> read_polygons(const std::string& file);

std::vector<Polygon> as_polygons(const Mesh& mesh, const std::vector<CellFace>& faces);

/// The corners as points of the mesh; -2 for what is no point of it. All keys are in increasing order.
std::vector<FaceKey> keys_of(const Mesh& mesh, const std::vector<Polygon>& polygons);

std::vector<FaceKey> keys_of(const std::vector<CellFace>& faces);

/// The volume that polygons enclose, by the divergence theorem; quadrilaterals are bilinear patches.
double enclosed(const std::vector<Polygon>& polygons);

/// Whether the corners of all polygons on patches with CAD surfaces lie on one of these, within 1e-9 of the
/// diagonal of the mesh, and all other quadrilaterals are planar. Says what it finds.
bool on_cad_or_planar(const Mesh& mesh, const std::vector<Polygon>& polygons,
                      const std::vector<CadSurface>& surfaces);

/// Quadrilaterals in front of two triangles of the boundary.
long covered_by_triangles(const std::vector<CellFace>& boundary);

/// Compares with the surface of the same case without layers: volumes agree to 1e-9, and triangles that are
/// no longer there lie in coordinate planes. Not for meshes whose layers end on curved faces.
bool walls_match(const std::string& file, const Mesh& mesh, const std::vector<CellFace>& boundary);

}  // namespace layercheck
