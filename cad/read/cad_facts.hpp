/// The content of a CAD file as it is, without any repair.
#pragma once

#include "cad/model/evaluation/face_place.hpp"
#include "geometry/vec.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A name and the number of faces that carry it.
struct NamedFaces {
  std::string name;
  std::int32_t faces = 0;
};

/// Names of a face, and its position.
struct FaceFacts {
  std::string name;  ///< "face_<number>" if the file gives none; rules for patches use this name
  std::string part, layer, colour;
  FacePlace place;
};

/// Counts of a file of triangles. Points with equal coordinates count once.
struct FacetCounts {
  std::int32_t points = 0, triangles = 0, components = 0;
  std::int32_t without_area = 0;       ///< triangles whose corners lie on a line
  std::int32_t open_sides = 0;         ///< sides of one triangle
  std::int32_t junction_sides = 0;     ///< sides of three or more triangles
  std::int32_t misoriented_sides = 0;  ///< sides whose two triangles have opposite orientations
  double area = 0, volume = 0;         ///< of the triangles as they are oriented
};

struct CadFacts {
  std::string format;         ///< "STEP", "IGES" or "BREP"; for triangles "STL" and so on
  std::string unit_name;      ///< unit of length; empty if the file declares none
  double unit_in_metres = 1;  ///< if the file declares a unit
  geometry::Box bounds;       ///< in the file's unit
  std::int32_t solids = 0, shells = 0, faces = 0, edges = 0;
  /// Names of solids (parts, products), faces and layers, and colours ("#rrggbb"). Each name once, ascending.
  std::vector<NamedFaces> parts, face_names, layers, colours;

  std::vector<FaceFacts> face_table;  ///< all faces, in the order of the file
  /// For files of triangles only. These have no solids, shells, faces and edges; `parts` and `face_names`
  /// then count triangles.
  std::optional<FacetCounts> facets = {};
};

/// Reads the file. Not collective. It runs in this process, so a crash in the CAD library ends the process.
/// Throws CadError for files that are damaged, empty or of an unknown format, and std::ios_base::failure if
/// the file cannot be opened.
CadFacts look_at_cad_file(const std::string& file, const std::string& encoding = "");

}  // namespace aeroloom::cad
