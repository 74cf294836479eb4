/// The content of a CAD file as it stands there: for a look, without any repair.
#pragma once

#include "cad/model/evaluation/face_place.hpp"
#include "geometry/vec.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

/// A name, and how many faces carry it.
struct NamedFaces {
  std::string name;
  std::int32_t faces = 0;

  static constexpr auto fields() { return std::tuple(&NamedFaces::name, &NamedFaces::faces); }
};

/// The names that users may know a face by, and its place.
struct FaceFacts {
  std::string name;  ///< "face_<number>" where the file gives none, as rules for patches know it
  std::string part, layer, colour;
  FacePlace place;

  static constexpr auto fields() {
    return std::tuple(&FaceFacts::name, &FaceFacts::part, &FaceFacts::layer, &FaceFacts::colour,
                      &FaceFacts::place);
  }
};

/// What a file of triangles holds; equal points count as one.
struct FacetCounts {
  std::int32_t points = 0, triangles = 0, components = 0;
  std::int32_t without_area = 0;       ///< triangles whose corners lie on one line
  std::int32_t open_sides = 0;         ///< of one triangle
  std::int32_t junction_sides = 0;     ///< of three or more
  std::int32_t misoriented_sides = 0;  ///< passed twice in one direction
  double area = 0, volume = 0;         ///< of the triangles as they are oriented

  static constexpr auto fields() {
    return std::tuple(&FacetCounts::points, &FacetCounts::triangles, &FacetCounts::components,
                      &FacetCounts::without_area, &FacetCounts::open_sides, &FacetCounts::junction_sides,
                      &FacetCounts::misoriented_sides, &FacetCounts::area, &FacetCounts::volume);
  }
};

struct CadFacts {
  std::string format;         ///< "STEP", "IGES" or "BREP"; of triangles "STL" and so on
  std::string unit_name;      ///< of length; empty where the file declares none
  double unit_in_metres = 1;  ///< where it declares one
  geometry::Box bounds;       ///< in the file's unit
  std::int32_t solids = 0, shells = 0, faces = 0, edges = 0;
  /// By name, each once: of solids (parts, products), of faces, of layers, and colours ("#rrggbb").
  std::vector<NamedFaces> parts, face_names, layers, colours;

  std::vector<FaceFacts> face_table;  ///< all faces, in the order of the file
  /// Of a file of triangles, which has no solids, shells, faces and edges; `parts` and `face_names` then
  /// count triangles.
  std::optional<FacetCounts> facets = {};

  static constexpr auto fields() {
    return std::tuple(&CadFacts::format, &CadFacts::unit_name, &CadFacts::unit_in_metres, &CadFacts::bounds,
                      &CadFacts::solids, &CadFacts::shells, &CadFacts::faces, &CadFacts::edges,
                      &CadFacts::parts, &CadFacts::face_names, &CadFacts::layers, &CadFacts::colours,
                      &CadFacts::face_table, &CadFacts::facets);
  }
};

/// Reads the file, in this process: what crashes in the CAD library ends it. Not collective. Throws CadError
/// for files that are neither STEP, IGES, BREP nor triangles, damaged or empty, std::ios_base::failure where
/// it cannot be opened.
CadFacts look_at_cad_file(const std::string& file);

}  // namespace aeroloom::cad
