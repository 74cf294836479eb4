/// A CAD shape with the labels of its faces, between file and model. Internal to cad/.
#pragma once

#include "cad/builtin/transport.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// What the file says about one face. Empty where it says nothing.
struct FaceLabel {
  std::string name;  ///< of the face itself
  std::string layer;
  std::string colour;  ///< "#rrggbb"
  std::string solid;   ///< name of the solid (part, product) of the face
  bool far_field = false;
  bool symmetry = false;  ///< lies on the symmetry plane of a half model
  bool cap = false;       ///< closes an opening
  bool ignored = false;   ///< left out, as the case asks
  int number = -1;        ///< number of the face in the file, from 0; -1 without a file
};

/// The name that users know: that of the file, or "face_<number>". Empty without either.
inline std::string shown_name(const FaceLabel& label) {
  return label.name.empty() && label.number >= 0 ? "face_" + std::to_string(label.number) : label.name;
}

/// Labels by face, for either orientation. Do not iterate: the order depends on addresses.
using FaceLabels = NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher>;

/// Empty also if the face has no label.
inline std::string shown_name(const FaceLabels& labels, const TopoDS_Shape& face) {
  const FaceLabel* label = labels.Seek(face);
  return label != nullptr ? shown_name(*label) : std::string();
}

/// Copies the label of one face to another, if there is one.
inline void copy_label(FaceLabels& labels, const TopoDS_Shape& from, const TopoDS_Shape& to) {
  if (!labels.IsBound(from)) return;
  const FaceLabel label = labels.Find(from);
  labels.Bind(to, label);
}

/// A face that bounds no solid.
struct LooseFace {
  TopoDS_Face face;
  bool in_solid = false;  ///< the file puts it inside of a solid
  bool in_sheet = false;  ///< of an open shell
};

struct NamedShape {
  TopoDS_Shape shape;
  FaceLabels labels;
  std::vector<LooseFace> loose;  ///< beside `shape`: baffles, if they lie in the fluid (domain/baffles.hpp)
  std::string sheet_fault;       ///< why the open shells among them close to no body; empty without any
  std::string unit_name;         ///< "m", "mm", "in", ...; empty if none is declared
  double unit_in_metres = 1;     ///< lengths of the file are in this unit
  /// Length in the file's unit of the unit of `shape`, `gap` and `precision` (library_unit.hpp).
  double unit = 1;
  std::optional<double> symmetry_position = {};  ///< of the plane that closed an open half
  int symmetry_axis = 1;                         ///< of that plane
  double gap = 0;                                ///< widest gap closed by sewing or as noise
  double precision = 0;                          ///< precision of points that the file states; 0: none
  std::string refused = {};  ///< what the CAD library says of entities that it leaves out; empty: none
  std::vector<std::string> read_otherwise = {};  ///< names that are not UTF-8 in the file, a sentence each
  std::size_t cut_names = 0;  ///< labels with names that were too long (geometry::longest_name)
};

/// The built-in aircraft: one closed solid in metres, with named faces. Throws CadError for impossible
/// dimensions.
NamedShape make_transport(const TransportDimensions& dimensions);

}  // namespace aeroloom::cad
