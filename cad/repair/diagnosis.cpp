#include "cad/repair/diagnosis.hpp"

#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/faceted_domain.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/read/cad_reader.hpp"
#include "cad/repair/noise_faces.hpp"
#include "cad/repair/sewing.hpp"
#include "cad/tolerances.hpp"

#include <cmath>

#include <BRepAdaptor_Curve.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Findings that are listed; the others of a kind are counted, so that `check` fits a screen or two.
constexpr int shown_of_a_kind = 20;

struct MeasuredEdge {
  double length;
  Vec3 middle;
};

MeasuredEdge measure(const TopoDS_Edge& edge) {
  const BRepAdaptor_Curve curve(edge);
  const gp_Pnt middle = curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
  return {GCPnts_AbscissaPoint::Length(curve), {middle.X(), middle.Y(), middle.Z()}};
}

void find_open_edges(const TopoDS_Shape& shape, Diagnosis& diagnosis) {
  for (const TopoDS_Edge& edge : open_edges(shape)) {
    if (++diagnosis.counts.open_edges > shown_of_a_kind) continue;
    const MeasuredEdge found = measure(edge);
    diagnosis.findings.push_back(
        {fmt::format("an open edge of length {:.6g}", in_file(found.length)), found.middle});
  }
}

void find_short_edges(const TopoDS_Shape& shape, double diagonal, Diagnosis& diagnosis) {
  const TopTools_IndexedMapOfShape edges = map_of(shape, TopAbs_EDGE);
  for (int i = 1; i <= edges.Extent(); ++i) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(i));
    double first, last;
    if (BRep_Tool::Degenerated(edge) || BRep_Tool::Curve(edge, first, last).IsNull()) continue;
    const MeasuredEdge found = measure(edge);
    if (found.length >= tolerances::short_edge * diagonal || ++diagnosis.counts.short_edges > shown_of_a_kind)
      continue;
    diagnosis.findings.push_back(
        {fmt::format("a short edge of length {:.3g}", in_file(found.length)), found.middle});
  }
}

std::string shown_or_numbered(const NamedShape& named, const TopoDS_Shape& face, int index) {
  const std::string shown = shown_name(named.labels, face);
  return shown.empty() ? fmt::format("face_{}", index) : shown;
}

void find_slivers(const NamedShape& named, double diagonal, Diagnosis& diagnosis) {
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) {
    GProp_GProps surface, rim;
    BRepGProp::SurfaceProperties(faces(i), surface, area_precision);
    BRepGProp::LinearProperties(faces(i), rim);
    const double length = 0.5 * rim.Mass();  // of a strip
    double width = length > 0 ? std::abs(surface.Mass()) / length : 0;
    if (width > tolerances::sliver_width * diagonal || width > tolerances::sliver_slenderness * length)
      continue;
    if (++diagnosis.counts.sliver_faces > shown_of_a_kind) continue;
    // Areas of such faces are inexact.
    if (const auto strip = examine_noise(TopoDS::Face(faces(i)), tolerances::sliver_width * diagonal))
      width = strip->widest;
    diagnosis.findings.push_back(
        {fmt::format("a sliver face '{}' {:.3g} wide and {:.3g} long",
                     shown_or_numbered(named, faces(i), i - 1), in_file(width), in_file(length)),
         tight_box(faces(i)).center()});
  }
}

void examine(const NamedShape& named, Diagnosis& diagnosis) {
  const InLibraryUnit at_hand(named.unit);
  diagnosis.unit_name = named.unit_name;
  diagnosis.bounds = tight_box(named.shape);
  diagnosis.counts.solids = map_of(named.shape, TopAbs_SOLID).Extent();
  diagnosis.counts.shells = map_of(named.shape, TopAbs_SHELL).Extent();
  diagnosis.counts.faces = map_of(named.shape, TopAbs_FACE).Extent();
  diagnosis.counts.edges = map_of(named.shape, TopAbs_EDGE).Extent();
  const double diagonal = diagnosis.bounds.diagonal();
  find_open_edges(named.shape, diagnosis);
  find_short_edges(named.shape, diagonal, diagnosis);
  find_slivers(named, diagonal, diagnosis);
  diagnosis.bounds = scaled(diagnosis.bounds, named.unit);
  for (Change& finding : diagnosis.findings) finding = in_file_unit(std::move(finding), named.unit);
}

/// Adds what a part brings to that of the file.
void examine_part(const FacetedBody& part, Diagnosis& diagnosis) {
  Diagnosis own;
  examine_facets(part.file, own);
  for (const Vec3& corner : {own.bounds.low, own.bounds.high}) diagnosis.bounds.add(part.scale * corner);
  diagnosis.counts.shells += own.counts.shells;
  diagnosis.counts.faces += own.counts.faces;
  diagnosis.counts.open_edges += own.counts.open_edges;
  for (Change& finding : own.findings) {
    finding.what = fmt::format("part '{}': {}", part.name, finding.what);
    diagnosis.findings.push_back(std::move(finding));
  }
}

}  // namespace

Diagnosis diagnose(const DomainOptions& options) {
  Diagnosis diagnosis;
  if (!options.transport && is_faceted_file(options.file)) {
    examine_facets(options.file, diagnosis);
  } else {
    diagnosis.format = options.transport ? "built-in" : format_of_cad_file(options.file);
    guarded("examining the geometry", [&] {
      examine(options.transport ? make_transport(*options.transport)
                                : read_cad_file(options.file, options.encoding),
              diagnosis);
    });
  }
  for (const FacetedBody& part : options.parts) examine_part(part, diagnosis);
  try {
    diagnosis.domain = prepare_domain(options);
  } catch (const CadError& error) {
    diagnosis.failure = error.what();
  }
  return diagnosis;
}

}  // namespace aeroloom::cad
