/// Makes the fluid domain to mesh from a CAD file or a built-in shape.
#pragma once

#include "cad/builtin/transport.hpp"
#include "cad/model/model.hpp"
#include "cad/repair/change.hpp"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

/// Whether the solids of the file are the fluid, or bodies in a far field.
enum class DomainKind { automatic, fluid, body };

enum class FarFieldShape { sphere, box, hemisphere, cylinder };
enum class Axis { x, y, z };

/// How the symmetry plane of a half model is found. `automatic` takes none, except for the hemisphere. There
/// it is y = 0 if the body is symmetric about it, else the coordinate plane at which the body ends.
enum class Symmetry { automatic, none, x, y, z };

/// The unit of the far field's extent: the largest extent of the body's box (`body`); half of its extent
/// across the flow, or all of it for half models (`semispan`); the model's unit of length (`model`); a length
/// that the user gives, such as a chord (`reference`).
enum class ExtentUnit { body, semispan, model, reference };

/// The far field around a body.
struct FarFieldOptions {
  FarFieldShape shape = FarFieldShape::sphere;
  double extent = 10;  ///< distance from the body's centre to the far field, in units; for box and cylinder,
                       ///< to each side and end
  ExtentUnit unit = ExtentUnit::body;
  double unit_length = 1;  ///< length of the units `model` and `reference`, in the model's unit
  Axis flow = Axis::x;     ///< the axis nearest to the flow direction; the span is measured across it
  Axis axis = Axis::x;     ///< axis of the cylinder
  /// The symmetry plane of the half model, normal to an axis. A body that crosses the plane is cut. The half
  /// on the positive side is kept, of the body and of the far field.
  Symmetry symmetry = Symmetry::automatic;
  std::optional<double> symmetry_position =
      {};  ///< coordinate of the plane on its axis; default: where the body ends, or 0
};

/// What happens to blunt trailing edges, which are strips between two faces that meet at a sharp angle.
/// `sharpen` closes them here. `automatic` keeps them here; the program later closes those that sizes cannot
/// resolve, if that moves little.
enum class TrailingEdges { automatic, keep, sharpen };

struct TrailingEdgeOptions {
  TrailingEdges treatment = TrailingEdges::automatic;
  std::vector<std::string> faces =
      {};            ///< patterns for names of faces or patches, with * and ?; empty: all faces
  double width = 0;  ///< largest width of strips that are closed; 0: 3 % of their length and 10 % of the
                     ///< neighbours' breadth
};

/// What becomes of faces that close planar openings: they join the patch of the wall around them, or are
/// patches `cap_1`, `cap_2`, ...
enum class Caps { join, name };

/// What happens to a baffle: a face inside of the fluid, which has the fluid on both sides.
enum class Baffles { keep, refuse };

/// Faces through which the fluid enters and leaves: name patterns (NamePattern) of faces or patches.
struct OpeningNames {
  std::vector<std::string> inlets, outlets;
};

/// A body of flat triangles beside the CAD geometry, such as a store or an ice shape.
struct FacetedBody {
  std::string name;  ///< name of the part to which its faces belong
  std::string file;  ///< STL, OBJ, OFF, PLY, .poly or .smesh
  double scale = 1;  ///< factor from its coordinates to the unit of the geometry
};

struct DomainOptions {
  std::string file;  ///< STEP, IGES or BREP, recognised by content; or triangles; empty for `transport`
  std::optional<TransportDimensions> transport;  ///< the built-in aircraft
  DomainKind kind = DomainKind::automatic;
  OpeningNames openings = {};                ///< `automatic` takes solids with both for the fluid
  std::optional<FarFieldOptions> far_field;  ///< as the user gives it; without, bodies get the default
  FarFieldOptions default_far_field = {};
  TrailingEdgeOptions trailing_edges = {};
  Baffles baffles = Baffles::keep;
  /// For faceted files. Two triangles belong to different faces if the surface turns by more than this
  /// between them. Degrees.
  double feature_angle = 40;
  /// For faceted files: patterns for names of solids that are voids of those around them, with * and ?.
  std::vector<std::string> voids = {};
  double smallest_size = 0;  ///< of the mesh to come; gaps above a tenth of it are not sewn; 0: not known
  std::vector<FacetedBody> parts = {};  ///< united with bodies that they overlap
  /// Faces of the file that are left out: patterns of names, or numbers; of triangles, names of groups.
  std::vector<std::string> ignore = {};
  Caps caps = Caps::join;
  /// Openings that are closed whatever their width: patterns for names of faces or groups beside them, or
  /// boxes, six numbers in a text, that contain them. `refuse` alone: nothing is closed, however narrow.
  std::vector<std::string> close = {};
  std::string encoding =
      {};  ///< of names in files that are not UTF-8 (geometry::decode_names); empty: latin-1

  static constexpr auto fields() {
    using D = DomainOptions;
    return std::tuple(&D::file, &D::transport, &D::kind, &D::openings, &D::far_field, &D::default_far_field,
                      &D::trailing_edges, &D::baffles, &D::feature_angle, &D::voids, &D::smallest_size,
                      &D::parts, &D::ignore, &D::caps, &D::close, &D::encoding);
  }
};

/// The name of a face, or of a patch, that the file has and the domain has not.
struct RemovedName {
  std::string name;
  std::string reason;  ///< the change that removed its faces, as far as it is known
};

/// What was read and what was changed. For log and report.
struct DomainReport {
  DomainKind kind = DomainKind::automatic;  ///< as decided
  std::string reason;                       ///< reason for the decision, if the program decided
  double reference_length = 0;              ///< of the body, or of the domain without bodies
  Changes changes;                          ///< every repair: what, where, how much
  std::vector<RemovedName> removed = {};    ///< for messages about rules that match nothing
};

struct Domain {
  Model model;
  DomainReport report;
};

/// Reads and repairs the geometry and makes the domain. Closed shells become solids. Faces that bound no
/// solid are baffles where they lie in the fluid, else dropped and listed. Not collective: one rank calls it
/// and broadcasts model.serialise(). It runs in this process, so a crash in the CAD library ends the process.
/// Throws CadError for what cannot be meshed: unreadable files, open shells, a far field that cuts the body,
/// a boolean operation whose volumes do not add up. Throws std::ios_base::failure if the file cannot be
/// opened.
Domain prepare_domain(const DomainOptions& options);

enum class ExportedShape {
  geometry,  ///< as read and repaired, before any far field
  domain     ///< the fluid domain: bodies united, regions joined, the far field around them
};

/// Writes the shape with names as a STEP file. Joined faces and closed trailing edges are written as in the
/// CAD. Not collective. Throws as prepare_domain, and std::ios_base::failure if the file cannot be written.
void export_step(const DomainOptions& options, ExportedShape shape, const std::string& file);

}  // namespace aeroloom::cad
