/// From a file or a built-in shape to the fluid domain to mesh.
#pragma once

#include "cad/builtin/transport.hpp"
#include "cad/model/model.hpp"
#include "cad/repair/change.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

/// Whether the file's solids are the fluid, or bodies in a far field.
enum class DomainKind { automatic, fluid, body };

enum class FarFieldShape { sphere, box, hemisphere, cylinder };
enum class Axis { x, y, z };

/// How a half model's plane of symmetry is found. `automatic`: none, except for the hemisphere, where it is
/// the plane y = 0 the body is symmetric about, or else the coordinate plane it ends at.
enum class Symmetry { automatic, none, x, y, z };

/// The length in which the extent of a far field is given: the largest extent of the body's box; half of what
/// that extends across the flow, of half models from the plane of symmetry on; the model's unit; a length
/// that the user refers to, such as a chord.
enum class ExtentUnit { body, semispan, model, reference };

/// The far field around a body.
struct FarFieldOptions {
  FarFieldShape shape = FarFieldShape::sphere;
  double extent = 10;  ///< distance from the body's centre to the far field, in units; for box and cylinder:
                       ///< from the centre to each side and end
  ExtentUnit unit = ExtentUnit::body;
  double unit_length = 1;  ///< of the units `model` and `reference`, in the model's unit
  Axis flow = Axis::x;     ///< the axis nearest to the flow, along which there is no span
  Axis axis = Axis::x;     ///< of the cylinder
  /// The half model's plane, normal to an axis. The body is cut there if it does not end there, and its part
  /// on the positive side is kept; the far field is cut to the same half.
  Symmetry symmetry = Symmetry::automatic;
  std::optional<double> symmetry_position =
      {};  ///< of the plane on its axis; default: where the body ends, or 0

  static constexpr auto fields() {
    return std::tuple(&FarFieldOptions::shape, &FarFieldOptions::extent, &FarFieldOptions::unit,
                      &FarFieldOptions::unit_length, &FarFieldOptions::flow, &FarFieldOptions::axis,
                      &FarFieldOptions::symmetry, &FarFieldOptions::symmetry_position);
  }
};

/// The treatment of blunt trailing edges: strips between two faces that meet at a sharp angle. `sharpen`:
/// they are closed here; `automatic`: they are kept here, and those closed later that sizes cannot resolve,
/// where that moves little.
enum class TrailingEdges { automatic, keep, sharpen };

struct TrailingEdgeOptions {
  TrailingEdges treatment = TrailingEdges::automatic;
  std::vector<std::string> faces =
      {};  ///< patterns of faces' or patches' names, with * and ?; none: any face
  double width =
      0;  ///< of strips that are closed, at most; 0: 3 % of their length, 10 % of the neighbours' breadth

  static constexpr auto fields() {
    return std::tuple(&TrailingEdgeOptions::treatment, &TrailingEdgeOptions::faces,
                      &TrailingEdgeOptions::width);
  }
};

/// A body of flat triangles beside the geometry of DomainOptions, such as a store or an ice shape.
struct FacetedBody {
  std::string name;  ///< of the part that its faces belong to
  std::string file;  ///< STL, OBJ, OFF, PLY, .poly or .smesh
  double scale = 1;  ///< what its coordinates are multiplied by, to be in the unit of the geometry

  static constexpr auto fields() {
    return std::tuple(&FacetedBody::name, &FacetedBody::file, &FacetedBody::scale);
  }
};

struct DomainOptions {
  std::string file;  ///< STEP, IGES or BREP, by content and extension; empty for `transport`
  std::optional<TransportDimensions> transport;  ///< the built-in aircraft
  DomainKind kind = DomainKind::automatic;
  std::optional<FarFieldOptions> far_field;  ///< given by the user; bodies get the default where it is absent
  FarFieldOptions default_far_field = {};
  TrailingEdgeOptions trailing_edges = {};
  /// Of faceted files: sides at which triangles turn by more, in degrees, become curves between faces.
  double feature_angle = 40;
  double smallest_size = 0;  ///< of the mesh to come; gaps above a tenth of it are not sewn; 0: not known
  std::vector<FacetedBody> parts = {};  ///< united with what they overlap

  static constexpr auto fields() {
    return std::tuple(&DomainOptions::file, &DomainOptions::transport, &DomainOptions::kind,
                      &DomainOptions::far_field, &DomainOptions::default_far_field,
                      &DomainOptions::trailing_edges, &DomainOptions::feature_angle,
                      &DomainOptions::smallest_size, &DomainOptions::parts);
  }
};

/// The file that was read and the changes made to it, for log and report.
struct DomainReport {
  DomainKind kind = DomainKind::automatic;  ///< as decided
  std::string reason;                       ///< why, when it was decided here
  double reference_length = 0;              ///< of the body (or the domain)
  Changes changes;                          ///< every repair: what, where, how much

  static constexpr auto fields() {
    return std::tuple(&DomainReport::kind, &DomainReport::reason, &DomainReport::reference_length,
                      &DomainReport::changes);
  }
};

struct Domain {
  Model model;
  DomainReport report;
};

/// Reads, heals and builds the domain, in this process: what crashes in the CAD library ends it. Not
/// collective: one rank calls it and broadcasts model.serialise(). Closed shells become solids; faces that
/// belong to no solid are dropped and listed. Throws CadError for what cannot be meshed: unreadable files,
/// open shells, a far field that cuts the body, a boolean operation whose volume does not add up;
/// std::ios_base::failure when the file cannot be opened.
Domain prepare_domain(const DomainOptions& options);

enum class ExportedShape {
  geometry,  ///< as read and healed, before any far field
  domain     ///< what is meshed: bodies united, regions joined, the far field around them
};

/// Writes the model's shape with names as STEP; joined faces and closed trailing edges are as in the CAD. Not
/// collective. Throws as prepare_domain; std::ios_base::failure when the file cannot be written.
void export_step(const DomainOptions& options, ExportedShape shape, const std::string& file);

}  // namespace aeroloom::cad
