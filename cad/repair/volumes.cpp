#include "cad/repair/volumes.hpp"

#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/model.hpp"
#include "cad/model/shape_map.hpp"

#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>

namespace aeroloom::cad {
namespace {

/// Of the face oriented forward.
double flux(const TopoDS_Face& face, const gp_Pnt& reference) {
  const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
  if (surface.IsNull()) throw CadError("a face has no surface (a bare triangulation)");
  return integrate_face(face, SurfaceEvaluator(surface), {reference.X(), reference.Y(), reference.Z()}).flux;
}

}  // namespace

double Volumes::of(const TopoDS_Shape& shape) {
  double volume = 0;
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    const TopoDS_Face& face = TopoDS::Face(faces.Current());
    if (!bounds_material(face)) continue;
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
