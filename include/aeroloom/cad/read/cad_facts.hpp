/// The content of a CAD file as it stands there: for a look, without any repair.
#pragma once

#include "aeroloom/cad/model/evaluation/face_place.hpp"
#include "aeroloom/geometry/vec.hpp"

#include <cstdint>
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

struct CadFacts {
  std::string format;         ///< "STEP", "IGES" or "BREP"
  std::string unit_name;      ///< of length; empty where the file declares none
  double unit_in_metres = 1;  ///< where it declares one
  geometry::Box bounds;       ///< in the file's unit
  std::int32_t solids = 0, shells = 0, faces = 0, edges = 0;
  /// By name, each once: of solids (parts, products), of faces, of layers, and colours ("#rrggbb").
  std::vector<NamedFaces> parts, face_names, layers, colours;

  std::vector<FaceFacts> face_table;  ///< all faces, in the order of the file

  static constexpr auto fields() {
    return std::tuple(&CadFacts::format, &CadFacts::unit_name, &CadFacts::unit_in_metres, &CadFacts::bounds,
                      &CadFacts::solids, &CadFacts::shells, &CadFacts::faces, &CadFacts::edges,
                      &CadFacts::parts, &CadFacts::face_names, &CadFacts::layers, &CadFacts::colours,
                      &CadFacts::face_table);
  }
};

/// Reads the file, in this process: what crashes in the CAD library ends it. Not collective. Throws CadError
/// for files that are neither STEP, IGES nor BREP, damaged or empty, std::ios_base::failure where it cannot
/// be opened.
CadFacts look_at_cad_file(const std::string& file);

}  // namespace aeroloom::cad
