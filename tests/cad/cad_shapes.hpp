/// Shapes of the CAD library as files and domains, for tests that make their own geometry.
#pragma once

#include "cad/domain/domain.hpp"
#include "cad/model/model_data.hpp"
#include "tests/cad/real_files.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad::shapes {

inline std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (TopExp_Explorer each(shape, TopAbs_FACE); each.More(); each.Next())
    faces.push_back(TopoDS::Face(each.Current()));
  return faces;
}

/// The faces of a shape, none of which shares an edge with another.
inline std::vector<TopoDS_Face> loose_faces(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> faces;
  for (const TopoDS_Face& face : faces_of(shape))
    faces.push_back(TopoDS::Face(BRepBuilderAPI_Copy(face).Shape()));
  return faces;
}

template <class Shape>
TopoDS_Compound compound_of(const std::vector<Shape>& parts) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const Shape& part : parts) builder.Add(compound, part);
  return compound;
}

inline Vec3 center_of(const TopoDS_Face& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const gp_Pnt center = properties.CentreOfMass();
  return {center.X(), center.Y(), center.Z()};
}

/// The faces but those whose centre of mass is at one of the places.
inline std::vector<TopoDS_Face> without(std::vector<TopoDS_Face> faces, const std::vector<Vec3>& places) {
  const std::size_t count = faces.size();
  std::erase_if(faces, [&](const TopoDS_Face& face) {
    return std::any_of(places.begin(), places.end(),
                       [&](Vec3 place) { return distance(place, center_of(face)) < 1e-6; });
  });
  EXPECT_EQ(faces.size() + places.size(), count) << "no face is where one was to be left out";
  return faces;
}

/// By the CAD library, to its last digits on elementary surfaces.
inline double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

/// The domain of a shape that was written to a file.
inline Domain prepare(const TopoDS_Shape& shape, DomainOptions options = {}) {
  const real::TemporaryFile file("shape.brep", "");
  BRepTools::Write(shape, file.path().c_str());
  options.file = file.path();
  return prepare_domain(options);
}

/// The shape itself as the region.
inline Domain prepare_fluid(const TopoDS_Shape& shape) {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  return prepare(shape, options);
}

/// The message of the CadError that preparing the shape ends with; empty, and a failure, where it does not.
inline std::string refusal(const TopoDS_Shape& shape, const DomainOptions& options = {}) {
  try {
    prepare(shape, options);
  } catch (const CadError& error) {
    return error.what();
  }
  ADD_FAILURE() << "the shape was not refused";
  return {};
}

/// The changes that speak of something.
inline Changes changes_about(const Changes& changes, const std::string& words) {
  Changes found;
  std::copy_if(changes.begin(), changes.end(), std::back_inserter(found),
               [&](const Change& change) { return change.what.find(words) != std::string::npos; });
  return found;
}

inline std::vector<FaceId> faces_of_patch(const Model& model, const std::string& patch) {
  std::vector<FaceId> faces;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (model.patches()[model.face(f).patch] == patch) faces.push_back(f);
  }
  return faces;
}

}  // namespace aeroloom::cad::shapes
