/// The policy of tolerances of cad/. Lengths are shares of a diagonal, since CAD files come in any unit and
/// at any scale: that of the box of all bodies, or of the whole domain where a far field belongs to what is
/// looked at. Only what the CAD library itself fixes is a length in the file's unit. There are three groups,
/// orders of magnitude apart, so that no step tells apart what an earlier one called equal:
///
///     the program's own arithmetic     rounding 1e-12, foot 1e-11, foot_beside 1e-10, coincident 1e-9
///     what CAD programs leave          same_place 1e-6, noise 2e-6 to 1e-5, sewing 1e-7 to 1e-4
///     features, however small          short_edge 1e-5, sliver_width 1e-4, narrowest_opening 1e-3
///
/// A value without a source of its own was chosen, not measured. Steps, samples and iterations are no
/// tolerances: they stand where they are used.
#pragma once

#include "geometry/angle.hpp"

namespace aeroloom::cad::tolerances {

// The program's own arithmetic.

/// Two ways of computing the same length, area, volume or parameter differ by less, relative to its size:
/// double precision after a few thousand roundings. Where the sine of the angle between two derivatives is
/// below it, their cross product has no direction.
inline constexpr double rounding = 1e-12;
/// Of determinants and squared lengths, over the product or the larger one: `rounding` does not do for
/// squares, a sine of 1e-7 still has a direction.
inline constexpr double rounding_of_squares = 1e-14;
/// A step that changes a parameter by less, as a fraction of its range, changes nothing: 45 units in the last
/// place.
inline constexpr double parameter_rounding = 1e-14;

/// A foot of a perpendicular is found when a step would move it by less (of the domain's diagonal): ten times
/// `rounding`.
inline constexpr double foot = 1e-11;
/// A point on a face near a given guess is found when it is as near as this (of the domain's diagonal). More
/// than `foot`, since the distance itself is compared and an edge of a file lies off its face; less than
/// `coincident`.
inline constexpr double foot_beside = 1e-10;
/// A foot that only measures a distance need be no nearer than this fraction of the tolerance that the
/// distance is compared with: three digits of what a message says are right.
inline constexpr double foot_that_measures = 1e-3;

/// Two places are one (of a diagonal): planes that share a position, a surface that is a plane, a point on
/// the skin of a solid. Above what feet err by, below what sewing begins with.
inline constexpr double coincident = 1e-9;
/// A plane is normal to an axis when its normal leaves it by less (radians): over the whole domain the plane
/// then leaves the exact one by no more than `coincident`.
inline constexpr double parallel = coincident;
/// Two parameters are one, or a step along an edge is too short to be looked at (fraction of the range).
inline constexpr double same_parameter = 1e-9;
/// A point is on a loop of a face (in its parameters, whatever their range): what the CAD library's
/// classifier of points is given, which takes no share.
inline constexpr double on_loop = 1e-9;

// Where a derivative vanishes or jumps: a direction is taken a little beside (fraction of the range).

/// From an end of an edge, where a chord stands for the direction, and from a singular point of a surface.
/// Small enough for any curvature, large enough that rounding leaves nine digits of the chord.
inline constexpr double beside_end = 1e-3;
/// Where the normal still vanishes at `beside_end`.
inline constexpr double farther_beside_end = 1e-2;
/// From a knot, for the tangents on its two sides. Less than `beside_end`: tangents are evaluated, they are
/// no chords that rounding could spoil.
inline constexpr double beside_knot = 1e-6;

// What the CAD library fixes, in the file's unit.

/// The library's Precision::Confusion(): two points that are nearer are one to it, and what it makes anew has
/// this tolerance.
inline constexpr double library_length = 1e-7;
/// How far apart doubles may be at the domain's farthest corner, in `library_length`: beyond it points that
/// are one to the library can no longer be told from points that are not.
inline constexpr double bearable_spacings = 10;

// What CAD programs leave.

/// What a file says twice about one place differs by less (of the diagonal of the bodies or of the domain):
/// an edge and its parameter curve on a face, edges and the plane they lie on, sides of bodies that touch.
inline constexpr double same_place = 1e-6;
/// A parameter curve that is interpolated follows the exact one (fraction of the curve's extent in
/// parameters): less than `same_place`, so that it adds little to what the file leaves.
inline constexpr double interpolated = 1e-7;
/// A parameter curve that replaces one of the file must leave this fraction of the distance at most: else the
/// two curves differ in shape, not in pace, and the file's one stays.
inline constexpr double better_pace = 0.1;
/// What faces are sewn with, one after the other (of the diagonal of those that do not close). Three quarters
/// of the real files with gaps close at the first, all but one at the third; the fourth is there for that
/// one, a turbine blade with gaps of 1.1e-4 of its length and a sound model otherwise (docs/cad_repair.md).
inline constexpr double sewing[] = {1e-7, 1e-6, 1e-5, 1e-4};
/// Sewn with more, the log says that gaps were wide: between the third of `sewing` and the fourth.
inline constexpr double cautioned_sewing = 2e-5;
/// What faces are sewn with and what noise is, over the smallest size asked for, at most: gaps and strips
/// that elements would show are the user's to close.
inline constexpr double fraction_of_size = 0.1;
/// Strips and edges that are smaller are what rounding left and no features (of the diagonal of the bodies):
/// twice `same_place`, a side of a strip on either side of it.
inline constexpr double noise = 2e-6;
/// How far the precision that a file states may raise `noise`: to as much as the third step of `sewing`
/// closes.
inline constexpr double most_noise = 1e-5;
/// Noise over the precision that a file states for its points: two sides of a strip, each off by it.
inline constexpr double noise_over_precision = 2;

// Features, however small.

/// An opening may be capped when it leaves its plane by no more (of the diagonal of the sewn faces): as much
/// as the third step of `sewing` moves faces by.
inline constexpr double planar_opening = 1e-5;
/// An opening whose area is smaller than this times the length of its outline (of the same diagonal) is a gap
/// between faces, to be sewn and not to be capped: ten times the last step of `sewing`.
inline constexpr double narrowest_opening = 1e-3;
/// `aeroloom check` names edges that are shorter (of the diagonal). As long as `most_noise`: below it nothing
/// is left where noise was closed.
inline constexpr double short_edge = 1e-5;
/// `aeroloom check` names faces that are narrower (of the diagonal) and narrower than a fraction of their
/// length. Wider than `short_edge`: a narrow face asks for small elements all along, an edge at one place.
inline constexpr double sliver_width = 1e-4, sliver_slenderness = 0.01;
/// A body is symmetric about y = 0 when its two ends are as far away but for less (of its extent along y).
/// More than `same_place`: it only chooses the plane y = 0, where nothing is moved to.
inline constexpr double symmetric = 1e-3;

// Angles that count as tangent, in radians.

/// A border has no kink where it turns by less: a middle curve is drawn through smoothly.
inline constexpr double kink = 5 * geometry::degree;
/// A loop goes on where it turns by less, and a face does in its neighbour; where it turns by more is a
/// corner, at which a strip may end. More than `kink`, which decides of a curve's smoothness and not of a
/// shape.
inline constexpr double smooth = 30 * geometry::degree;

/// Of the bodies' diagonal: points of two bodies that are united are taken as one up to here, where the CAD
/// library fails with its own length. Ascending; the last is the third step of `sewing`. Chosen, not
/// measured.
inline constexpr double uniting[] = {1e-7, 1e-6, 1e-5};

// Areas and volumes, relative. Areas of FacePlace and of the diagnosis are good to `area_precision`
// (model/model_data.hpp).

/// The CAD library's volumes of trimmed spline solids are right to about this (docs/cad_repair.md); a boolean
/// operation gone wrong is off by a body.
inline constexpr double integrated_volume = 2e-3;
/// Far field, bodies and fluid add up to this, of the bodies. Less than `integrated_volume`: no boolean
/// operation lies between them, the faces integrated on both sides are the same.
inline constexpr double sum_of_volumes = 1e-3;
/// Volumes of closed triangles that are united exactly add up to this: what rounding of their coordinates
/// leaves.
inline constexpr double exact_volume = 1e-9;
/// A solid that fills less of the cube over its diagonal is a sheet or a wire: a plate as thin as
/// `coincident`.
inline constexpr double no_volume = 1e-9;
/// How much of a triangulated face may lie folded over in its parameters: above what slivers beside poles and
/// seams take, far below a face that is folded.
inline constexpr double folded = 1e-3;

}  // namespace aeroloom::cad::tolerances
