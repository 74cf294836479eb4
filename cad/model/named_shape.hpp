/// A shape of the CAD library on its way to a model, with what its file says about faces. Seen by this folder
/// only.
#pragma once

#include "cad/builtin/transport.hpp"

#include <string>

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Shape.hxx>

namespace aeroloom::cad {

/// Names of one face as the file gives them; empty strings where it gives none.
struct FaceLabel {
  std::string name;  ///< of the face itself
  std::string layer;
  std::string colour;  ///< "#rrggbb"
  std::string solid;   ///< name of the solid (part, product) the face belongs to
  bool far_field = false;
  bool symmetry = false;  ///< on the plane of symmetry of a half model
  int number = -1;        ///< of the face in its file, from 0; -1 where it is not from one
};

/// The name by which users know the face: "face_<number>" where its file gives none; empty where it has
/// neither.
inline std::string shown_name(const FaceLabel& label) {
  return label.name.empty() && label.number >= 0 ? "face_" + std::to_string(label.number) : label.name;
}

/// Labels by face; the orientation of the face does not matter. Look up only: iteration follows addresses.
using FaceLabels = NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher>;

/// Empty where the face has no label either.
inline std::string shown_name(const FaceLabels& labels, const TopoDS_Shape& face) {
  const FaceLabel* label = labels.Seek(face);
  return label != nullptr ? shown_name(*label) : std::string();
}

/// Gives a face the label of another one, if that has a label.
inline void copy_label(FaceLabels& labels, const TopoDS_Shape& from, const TopoDS_Shape& to) {
  if (!labels.IsBound(from)) return;
  const FaceLabel label = labels.Find(from);
  labels.Bind(to, label);
}

struct NamedShape {
  TopoDS_Shape shape;
  FaceLabels labels;
  std::string unit_name;      ///< "m", "mm", "in", ...; empty when the source declares none
  double unit_in_metres = 1;  ///< lengths of `shape` are in this unit
  double gap = 0;             ///< the widest one that was closed: by sewing, or as noise
  double precision = 0;       ///< what the file says points are exact to; 0: nothing
};

/// The built-in aircraft: one closed solid in metres with named faces. Throws CadError for dimensions that
/// make none.
NamedShape make_transport(const TransportDimensions& dimensions);

}  // namespace aeroloom::cad
