#include "cad/repair/volumes.hpp"

#include <BRepGProp_Domain.hxx>
#include <BRepGProp_Face.hxx>
#include <BRepGProp_Vinert.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>

namespace aeroloom::cad {
namespace {

/// A third of the flux of the position, seen from the reference point, through the face turned forward.
double flux(const TopoDS_Face& face, const gp_Pnt& reference) {
  BRepGProp_Face integrand;
  integrand.Load(TopoDS::Face(face.Oriented(TopAbs_FORWARD)));
  BRepGProp_Vinert integral;
  integral.SetLocation(reference);
  if (TopoDS_Iterator(face).More()) {
    BRepGProp_Domain domain(TopoDS::Face(face.Oriented(TopAbs_FORWARD)));
    integral.Perform(integrand, domain);
  } else {
    integral.Perform(integrand);
  }
  return integral.Mass();
}

}  // namespace

double Volumes::of(const TopoDS_Shape& shape) {
  double volume = 0;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face& face = TopoDS::Face(faces.Current());
    if (face.Orientation() != TopAbs_FORWARD && face.Orientation() != TopAbs_REVERSED) continue;
    if (_fluxes.IsEmpty()) {
      const TopExp_Explorer vertices(face, TopAbs_VERTEX);
      if (vertices.More()) _reference = BRep_Tool::Pnt(TopoDS::Vertex(vertices.Current()));
    }
    if (!_fluxes.IsBound(face)) _fluxes.Bind(face, flux(face, _reference));
    volume += (face.Orientation() == TopAbs_FORWARD ? 1 : -1) * _fluxes.Find(face);
  }
  return volume;
}

}  // namespace aeroloom::cad
