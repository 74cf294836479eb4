/// All tolerances of cad/. Lengths are fractions of a diagonal, since CAD files come in any unit and scale.
/// It is the diagonal of all bodies, or of the whole domain with its far field. Only lengths of the CAD
/// library itself are in the file's unit. Three groups lie orders of magnitude apart, so that no step
/// separates what an earlier step called equal:
///
///     the program's own arithmetic     rounding 1e-12, foot 1e-11, foot_beside 1e-10, coincident 1e-9
///     what CAD programs leave          same_place 1e-6, noise 2e-6 to 1e-5, sewing 1e-7 to 1e-4
///     features, however small          short_edge 1e-5, sliver_width 1e-4, narrowest_opening 1e-3
///
/// Values without a source were chosen, not measured. Numbers of steps, samples and iterations stand where
/// they are used.
#pragma once

#include "geometry/angle.hpp"

namespace aeroloom::cad::tolerances {

// Arithmetic of the program.

/// Relative difference of two computations of the same length, area, volume or parameter: double precision
/// after some thousand roundings. If the sine of the angle between two derivatives is smaller, their cross
/// product has no direction.
inline constexpr double rounding = 1e-12;
/// The same for determinants and squared lengths. A sine of 1e-7 still has a direction.
inline constexpr double rounding_of_squares = 1e-14;
/// A smaller step of a parameter (as a fraction of its range) changes nothing: 45 units in the last place.
inline constexpr double parameter_rounding = 1e-14;

/// A projection has converged if the next step is shorter (of the domain's diagonal): ten times `rounding`.
inline constexpr double foot = 1e-11;
/// A projection from a good guess has converged if its distance is smaller (of the domain's diagonal). More
/// than `foot`, since edges of a file lie off their faces; less than `coincident`.
inline constexpr double foot_beside = 1e-10;
/// A projection that only measures a distance is accurate to this fraction of the tolerance it is compared
/// with. Messages show three digits.
inline constexpr double foot_that_measures = 1e-3;

/// Two positions are equal (of a diagonal): of planes, of a surface and a plane, of a point and a solid's
/// surface. More than errors of projections, less than the smallest sewing tolerance.
inline constexpr double coincident = 1e-9;
/// A plane is normal to an axis if the angle is smaller (radians). Over the whole domain it then deviates by
/// at most `coincident`.
inline constexpr double parallel = coincident;
/// Two parameters are equal (fraction of the range).
inline constexpr double same_parameter = 1e-9;
/// A point is on a loop of a face, in its parameters. The CAD library's classifier takes an absolute value.
inline constexpr double on_loop = 1e-9;

// Where a derivative vanishes or jumps, directions are taken a little beside (fraction of the range).

/// From the end of an edge, where a chord gives the direction, and from a singular point of a surface. Small
/// for any curvature; large enough for nine digits of the chord.
inline constexpr double beside_end = 1e-3;
/// If the normal still vanishes at `beside_end`.
inline constexpr double farther_beside_end = 1e-2;
/// From a knot, for the tangents on its two sides. Less than `beside_end`, since tangents suffer less from
/// rounding than chords.
inline constexpr double beside_knot = 1e-6;

// Lengths of the CAD library itself, in the file's unit.

/// Precision::Confusion() of the library: points that are nearer are equal to it. New entities get this
/// tolerance.
inline constexpr double library_length = 1e-7;
/// Largest distance between neighbouring doubles at the domain's farthest corner, in `library_length`. Beyond
/// it the library can no longer tell points apart.
inline constexpr double bearable_spacings = 10;
/// Extents of shapes for which the library's length serves, chosen, not measured: it is 6e-6 of the least.
/// Others are made in a unit of their own (library_unit.hpp). Both are powers of two.
inline constexpr double least_extent = 1.0 / 64, most_extent = 1048576;
/// Largest precision of a file that shapes in such a unit are read with.
inline constexpr double most_stated = 1e-4;

// Inaccuracies that CAD programs leave.

/// Two descriptions of one place in a file differ by less (of the diagonal): an edge and its parameter curve,
/// edges and their plane, sides of bodies that touch.
inline constexpr double same_place = 1e-6;
/// Error of an interpolated parameter curve (fraction of its extent). Less than `same_place`.
inline constexpr double interpolated = 1e-7;
/// A replaced parameter curve must reduce the distance to this fraction. Otherwise the two curves differ in
/// shape, not in parametrisation, and the file's curve stays.
inline constexpr double better_pace = 0.1;
/// Sewing tolerances, tried in order (of the diagonal of the open faces). Three quarters of the real files
/// with gaps close at the first, all but one at the third. That one is a turbine blade with gaps of 1.1e-4 of
/// its length (docs/cad_repair.md).
inline constexpr double sewing[] = {1e-7, 1e-6, 1e-5, 1e-4};
/// Above this the log warns that gaps are wide: between the third and the fourth of `sewing`.
inline constexpr double cautioned_sewing = 2e-5;
/// Largest sewing tolerance and largest noise, over the smallest size. Users must close larger gaps and
/// strips, since elements would show them.
inline constexpr double fraction_of_size = 0.1;
/// Narrower strips and shorter edges are noise from rounding (of the diagonal of the bodies): twice
/// `same_place`, once for each side of a strip.
inline constexpr double noise = 2e-6;
/// Largest `noise` after the precision of the file is taken into account: the third of `sewing`.
inline constexpr double most_noise = 1e-5;
/// Noise over the precision that a file states: both sides of a strip are off by it.
inline constexpr double noise_over_precision = 2;

// Half models.

/// What lies nearer to the plane of symmetry is put on it (of the diagonal of the body): the last of
/// `sewing`.
inline constexpr double on_symmetry = 1e-4;
/// A planar face near the plane of symmetry is its body's flat side if the two turn by less (radians).
inline constexpr double flat_side = 5 * geometry::degree;
/// The fluid between the plane of symmetry and a flat side that leaves it by less would have no thickness
/// (radians).
inline constexpr double wedge_at_symmetry = 1 * geometry::degree;
/// A border that leaves the plane of symmetry by more (of the diagonal) is closed by one planar face only.
inline constexpr double widest_ruled = 0.05;
/// Nor is an opening beside the plane whose filling has more than this of the area of the walls.
inline constexpr double widest_filling = 0.5;

// Small features.

/// An opening may be capped if it leaves its plane by at most this (of the diagonal of the sewn faces): the
/// third of `sewing`.
inline constexpr double planar_opening = 1e-5;
/// An opening whose area over the length of its outline is smaller (of the same diagonal) is a gap to sew,
/// not an opening to cap: ten times the last of `sewing`.
inline constexpr double narrowest_opening = 1e-3;
/// Unless it is compact: its area over the square of that length is that of a strip ten times as long as
/// wide.
inline constexpr double slender_opening = 0.02;
/// An opening that is no plane is small if it has less of the area of the walls, and is shorter around (of
/// the diagonal). Chosen, not measured.
inline constexpr double small_opening_area = 0.01, small_opening_length = 0.2;
/// `aeroloom check` lists shorter edges (of the diagonal). Equal to `most_noise`: closed noise leaves nothing
/// shorter.
inline constexpr double short_edge = 1e-5;
/// `aeroloom check` lists faces narrower than this (of the diagonal) and than a fraction of their length.
/// Wider than `short_edge`: a narrow face costs small elements all along, a short edge at one place only.
inline constexpr double sliver_width = 1e-4, sliver_slenderness = 0.01;
/// A body is symmetric about y = 0 if its two ends are equally far away, up to this (of its extent along y).
/// It only selects the plane; nothing moves.
inline constexpr double symmetric = 1e-3;

// Angles below which directions are tangent, in radians.

/// A border has a kink if it turns by more. A middle curve is smooth elsewhere.
inline constexpr double kink = 5 * geometry::degree;
/// A loop has a corner if it turns by more; below, a face continues smoothly in its neighbour. Strips may end
/// at corners.
inline constexpr double smooth = 30 * geometry::degree;

/// Fuzzy values for unions, tried where the default of the CAD library fails (of the bodies' diagonal).
/// Ascending; the last is the third of `sewing`. Chosen, not measured.
inline constexpr double uniting[] = {1e-7, 1e-6, 1e-5};

// Areas and volumes, relative. Areas of FacePlace and of the diagnosis are accurate to `area_precision`
// (model/model_data.hpp).

/// Accuracy of the CAD library's volumes of trimmed spline solids (docs/cad_repair.md). A failed boolean
/// operation is off by a whole body.
inline constexpr double integrated_volume = 2e-3;
/// Far field, bodies and fluid add up to this, relative to the bodies. Less than `integrated_volume`, since
/// no boolean operation is involved and the same faces are integrated.
inline constexpr double sum_of_volumes = 1e-3;
/// Volumes of exactly united triangles add up to this; only rounding of coordinates remains.
inline constexpr double exact_volume = 1e-9;
/// A solid that fills less of the cube over its diagonal is a sheet or a wire.
inline constexpr double no_volume = 1e-9;
/// Largest fraction of a triangulated face that may be folded over in parameters. Slivers at poles and seams
/// take less, a folded face far more.
inline constexpr double folded = 1e-3;

}  // namespace aeroloom::cad::tolerances
