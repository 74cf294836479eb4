#include "cad/builtin/transport.hpp"

#include "cad/builtin/transport_components.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/repair/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepLib.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>
#include <fmt/format.h>
#include <gp_Ax2.hxx>

namespace aeroloom::cad {
namespace {

/// In the aircraft's unit, metres: sides of its components are the same curves, off by rounding alone.
constexpr double sewing_tolerance = 1e-6;
/// How deep a root section lies inside the fuselage, at least, in fuselage diameters: no boolean operation
/// has to cut faces that touch.
constexpr double least_depth = 0.005;
/// Where roots may lie, in fuselage radii off the plane of symmetry, the first that is inside enough: the
/// farther off, the shorter what is cut away.
constexpr double root_stations[] = {0.35, 0.2, 0.1};
/// Beyond these bounds (degrees, over chord) components would cross themselves or each other.
constexpr double most_sweep = 75, most_dihedral = 60, most_incidence = 30, most_thickness = 0.4,
                 most_camber = 0.1;

void require_dimension(bool holds, const std::string& dimension, const char* rule, double value) {
  if (!holds) throw CadError(fmt::format("transport: {} must {}, but it is {}", dimension, rule, value));
}

void check_surface(const std::string& name, const LiftingSurface& s) {
  require_dimension(s.root_chord > 0, name + ".root_chord", "be positive", s.root_chord);
  require_dimension(s.taper > 0 && s.taper <= 1, name + ".taper", "lie in (0, 1]", s.taper);
  require_dimension(s.half_span > 0, name + ".half_span", "be positive", s.half_span);
  require_dimension(std::abs(s.sweep) < most_sweep, name + ".sweep", "lie within 75 degrees", s.sweep);
  require_dimension(std::abs(s.dihedral) < most_dihedral, name + ".dihedral", "lie within 60 degrees",
                    s.dihedral);
  require_dimension(s.thickness > 0 && s.thickness <= most_thickness, name + ".thickness", "lie in (0, 0.4]",
                    s.thickness);
  require_dimension(std::abs(s.camber) <= most_camber, name + ".camber", "lie within 0.1", s.camber);
  require_dimension(std::abs(s.root_incidence) < most_incidence, name + ".root_incidence",
                    "lie within 30 degrees", s.root_incidence);
  require_dimension(std::abs(s.tip_incidence) < most_incidence, name + ".tip_incidence",
                    "lie within 30 degrees", s.tip_incidence);
  require_dimension(s.trailing_edge >= 0 && s.trailing_edge < s.thickness, name + ".trailing_edge",
                    "be at least 0 and below the thickness", s.trailing_edge);
}

void check_dimensions(const TransportDimensions& d) {
  require_dimension(d.fuselage_diameter > 0, "fuselage_diameter", "be positive", d.fuselage_diameter);
  require_dimension(d.nose_length >= 0.5 * d.fuselage_diameter, "nose_length",
                    "be at least half the fuselage_diameter", d.nose_length);
  require_dimension(d.tail_length >= d.fuselage_diameter, "tail_length", "be at least the fuselage_diameter",
                    d.tail_length);
  require_dimension(d.fuselage_length >= d.nose_length + d.tail_length + d.fuselage_diameter,
                    "fuselage_length", "leave a cabin of a fuselage_diameter between nose and tail",
                    d.fuselage_length);
  require_dimension(std::abs(d.tail_upsweep) <= 0.5 * d.fuselage_diameter, "tail_upsweep",
                    "lie within half the fuselage_diameter", d.tail_upsweep);
  check_surface("wing", d.wing);
  check_surface("horizontal_tail", d.horizontal_tail);
  check_surface("vertical_tail", d.vertical_tail);
  const LiftingSurface& fin = d.vertical_tail;
  for (const auto& [name, value] :
       {std::pair("dihedral", fin.dihedral), std::pair("camber", fin.camber),
        std::pair("root_incidence", fin.root_incidence), std::pair("tip_incidence", fin.tip_incidence)}) {
    require_dimension(value == 0, fmt::format("vertical_tail.{}", name), "be 0, the aircraft being symmetric",
                      value);
  }
}

double least_section_depth(const Fuselage& fuselage, const Lifting& lifting, double station) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3 p : lifting.section(station)) least = std::min(least, fuselage.depth(p));
  return least;
}

/// A station whose whole section lies inside the fuselage and off the plane of symmetry, where the other half
/// begins.
double find_inner_station(const std::string& name, const Fuselage& fuselage, const Lifting& lifting,
                          const std::vector<double>& candidates, const TransportDimensions& d) {
  for (const double station : candidates) {
    if (least_section_depth(fuselage, lifting, station) > least_depth * d.fuselage_diameter) return station;
  }
  throw CadError(
      fmt::format("transport: {0}.x, {0}.z and {0}.root_chord must put the root inside the fuselage", name));
}

void check_tip_outside(const std::string& name, const Fuselage& fuselage, const Lifting& lifting,
                       double half_span) {
  for (const Vec3 p : lifting.section(half_span)) {
    require_dimension(fuselage.depth(p) < 0, name + ".half_span", "put the tip outside the fuselage",
                      half_span);
  }
}

Component mirror(const Component& component, const std::string& from, const std::string& to) {
  gp_Trsf reflection;
  reflection.SetMirror(gp_Ax2(gp::Origin(), gp::DY()));
  BRepBuilderAPI_Transform transform(component.solid, reflection, Standard_True);
  Component result{transform.Shape(), {}};
  for (const NamedFace& face : component.faces) {
    std::string name = face.name;
    name.replace(name.find(from), from.size(), to);
    result.faces.push_back({TopoDS::Face(transform.ModifiedShape(face.face)), name});
  }
  return result;
}

std::vector<Component> make_components(const TransportDimensions& d) {
  const Fuselage fuselage(d);
  const double radius = 0.5 * d.fuselage_diameter;
  std::vector<double> beside;
  for (const double station : root_stations) beside.push_back(station * radius);
  std::vector<Component> components{fuselage.make_component()};
  const auto add_halves = [&](const std::string& name, const LiftingSurface& surface) {
    const Lifting lifting(surface, SpreadTo::right);
    const double inner = find_inner_station(name, fuselage, lifting, beside, d);
    check_tip_outside(name, fuselage, lifting, surface.half_span);
    components.push_back(lifting.make_component(name + "_right", inner));
    components.push_back(mirror(components.back(), "_right", "_left"));
  };
  add_halves("wing", d.wing);
  add_halves("horizontal_tail", d.horizontal_tail);
  const Lifting fin(d.vertical_tail, SpreadTo::up);
  const double inner = find_inner_station("vertical_tail", fuselage, fin, {0.0}, d);
  check_tip_outside("vertical_tail", fuselage, fin, d.vertical_tail.half_span);
  components.push_back(fin.make_component("vertical_tail", inner));
  return components;
}

/// Checks what a boolean operation that reports success may still have got wrong.
void check_union(const TopoDS_Shape& shape, const std::vector<Component>& components) {
  Volumes volumes;
  double sum = 0;
  for (const Component& component : components) sum += volumes.of(component.solid);
  const double total = volumes.of(shape), fuselage = volumes.of(components.front().solid);
  if (!(total > fuselage && total < sum) || !BRepCheck_Analyzer(shape).IsValid()) {
    throw CadError(
        fmt::format("transport: the dimensions do not unite to one valid body (fuselage {:.6g} m^3, sum of "
                    "parts {:.6g} m^3, union {:.6g} m^3)",
                    in_file(fuselage, 3), in_file(sum, 3), in_file(total, 3)));
  }
}

NamedShape unite_all(const std::vector<Component>& components) {
  TopTools_ListOfShape arguments, tools;
  arguments.Append(components.front().solid);
  for (std::size_t i = 1; i < components.size(); ++i) tools.Append(components[i].solid);
  BRepAlgoAPI_Fuse fuse;
  fuse.SetArguments(arguments);
  fuse.SetTools(tools);
  fuse.Build();
  TopExp_Explorer solids(fuse.Shape(), TopAbs_SOLID);
  if (fuse.HasErrors() || !solids.More()) throw CadError("transport: the parts cannot be united");
  NamedShape result;
  result.shape = solids.Current();
  solids.Next();
  if (solids.More()) throw CadError("transport: the parts do not form one body");
  check_union(result.shape, components);
  for (const Component& component : components) {
    for (const NamedFace& face : component.faces) {
      const FaceLabel label{face.name, "", "", "transport", false};
      const TopTools_ListOfShape& modified = fuse.Modified(face.face);
      for (const TopoDS_Shape& piece : modified) result.labels.Bind(piece, label);
      if (modified.IsEmpty() && !fuse.IsDeleted(face.face)) result.labels.Bind(face.face, label);
    }
  }
  result.unit_name.assign(1, 'm');
  result.unit_in_metres = 1;
  return result;
}

}  // namespace

TopoDS_Face whole_face(const Handle(Geom_Surface) & surface) {
  return BRepBuilderAPI_MakeFace(surface, sewing_tolerance);
}

Component sew_component(const std::vector<NamedFace>& faces) {
  BRepBuilderAPI_Sewing sewing(sewing_tolerance);
  for (const NamedFace& face : faces) sewing.Add(face.face);
  sewing.Perform();
  if (sewing.SewedShape().IsNull() || sewing.SewedShape().ShapeType() != TopAbs_SHELL ||
      sewing.NbFreeEdges() > 0) {
    throw CadError(fmt::format("transport: the faces of {} do not close", faces.front().name));
  }
  TopoDS_Solid solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape()));
  BRepLib::OrientClosedSolid(solid);
  Component component{solid, {}};
  for (const NamedFace& face : faces) {
    component.faces.push_back({TopoDS::Face(sewing.ModifiedSubShape(face.face)), face.name});
  }
  return component;
}

NamedShape make_transport(const TransportDimensions& dimensions) {
  check_dimensions(dimensions);
  return guarded("building the transport aircraft", [&] { return unite_all(make_components(dimensions)); });
}

}  // namespace aeroloom::cad
