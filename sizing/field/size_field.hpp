/// The size field h(x): one function for curves, surfaces and volume.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/storage/digest.hpp"
#include "sizing/field/corner_sizes.hpp"
#include "sizing/field/octree.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// Sizes that the user asks for. Lengths in the model's unit. Going away from where a size is asked for, each
/// element is at most `growth` times as large as the one before, so |grad h| <= ln(growth).
struct SizingOptions {
  double minimum = 0;           ///< smallest size, > 0
  double maximum = 0;           ///< largest size, >= minimum; the size of the far field
  double curvature_angle = 12;  ///< degrees an element may turn on a curved face or edge
  double growth =
      1.3;  ///< ratio of neighbouring element sizes, > 1; h changes by at most ln(growth) per length
  double surface_maximum =
      0;                 ///< largest size on faces of the body (far field excepted); 0: `maximum` alone rules
  double proximity = 1;  ///< elements wanted across a thin part of a body and across a gap, at least; 0: any
  double gap_proximity = -1;  ///< the same, across gaps alone; negative: `proximity`
  double feature_minimum =
      0;                      ///< as `minimum`, for short edges, narrow faces, sharp corners; 0: minimum / 20
  double strip_minimum = 0;   ///< as `feature_minimum`, for narrow faces alone; 0: as that
  double gap_minimum = 0;     ///< as `minimum`, for gaps between walls, where they do not meet; 0: minimum
  double feature_aspect = 1;  ///< length of an element along a narrow face, over the width there; likewise at
                              ///< short edges and sharp corners; >= 1, but nowhere beyond the minimum
  double chordal_deviation =
      0;  ///< distance of triangles on curved faces from the surface, at most; binds the minimum too; 0: any

  static constexpr auto fields() {
    return std::tuple(&SizingOptions::minimum, &SizingOptions::maximum, &SizingOptions::curvature_angle,
                      &SizingOptions::growth, &SizingOptions::surface_maximum, &SizingOptions::proximity,
                      &SizingOptions::gap_proximity, &SizingOptions::feature_minimum,
                      &SizingOptions::strip_minimum, &SizingOptions::gap_minimum,
                      &SizingOptions::feature_aspect, &SizingOptions::chordal_deviation);
  }
  friend bool operator==(const SizingOptions&, const SizingOptions&) = default;
};

/// Short edges, narrow faces and sharp corners may ask for sizes down to this.
inline double smallest_feature_size(const SizingOptions& options) {
  return options.feature_minimum > 0 ? options.feature_minimum : 0.05 * options.minimum;
}

/// Narrow faces may ask for sizes down to this.
inline double smallest_strip_size(const SizingOptions& options) {
  return options.strip_minimum > 0 ? options.strip_minimum : smallest_feature_size(options);
}

/// The size that a feature as long or wide as `extent` asks for, which may ask for sizes down to `smallest`.
inline double feature_size(double extent, double smallest, const SizingOptions& options) {
  return std::max(std::min(options.feature_aspect * extent, std::max(extent, options.minimum)), smallest);
}

/// The size that a narrow face asks for where it is so wide.
inline double strip_size(double width, const SizingOptions& options) {
  return feature_size(width, smallest_strip_size(options), options);
}

/// Elements wanted across a gap between walls, at least.
inline double elements_across_gaps(const SizingOptions& options) {
  return options.gap_proximity >= 0 ? options.gap_proximity : options.proximity;
}

/// Gaps may ask for sizes down to this.
inline double smallest_gap_size(const SizingOptions& options) {
  return options.gap_minimum > 0 ? options.gap_minimum : options.minimum;
}

/// A point that asks for a size.
struct SizeSource {
  geometry::Vec3 point;
  double size;

  static constexpr auto fields() { return std::tuple(&SizeSource::point, &SizeSource::size); }
};

/// A graded octree with sizes at the corners of its leaves, trilinear inside, continuous. At a source h is at
/// most the size asked for there (to single precision) and less only where a neighbour asks for less: a
/// source asks for its size in the whole leaf around it, whose edge is at most that size. From there h grows
/// by ln(growth) per length. minimum <= h <= maximum, except that `minimum` does not bind against short
/// edges, narrow faces, sharp corners, open gaps and what refined() asks for. Immutable and identical on
/// every rank, held once per node where ranks built it together; cheap to copy. It holds the communicator of
/// the ranks that built it.
class SizeField {
public:
  /// Builds the field over `domain` from sources, their sizes raised to the minimum; sources outside count at
  /// the nearest point of the box. Serial: the field is of this rank alone, and so is what refined() makes of
  /// it. The result depends on the set of sources, not on their order.
  /// Throws std::invalid_argument for impossible options, an empty domain, and sizes that are not positive.
  static SizeField build(const geometry::Box& domain, std::span<const SizeSource> sources,
                         const SizingOptions& options);

  /// The size at a point, well under a microsecond. Outside the domain: that of the nearest point of its box.
  double operator()(geometry::Vec3 x) const;
  double minimum() const { return _options.minimum; }
  double maximum() const { return _options.maximum; }
  const SizingOptions& options() const { return _options; }
  const geometry::Box& domain() const { return _domain; }
  std::int64_t leaf_count() const { return static_cast<std::int64_t>(_octree.keys.size()); }
  /// Of the ranks that built the field: this one alone after build().
  const parallel::Communicator& communicator() const { return _octree.communicator; }

  /// One leaf of the octree.
  struct Leaf {
    geometry::Vec3 low;
    double edge;  ///< length
    double size;  ///< h at the centre
  };
  Leaf leaf(std::int64_t i) const;
  /// The cube so many levels above that leaf, or the root; without a size.
  Leaf ancestor(std::int64_t i, int levels) const;

  /// The field with further sources, each rank its own: sizes can only fall, below the minimum too. The same
  /// however ranks share them. Used where surfaces come too close. Collective.
  SizeField refined(std::span<const SizeSource> more) const;
  /// Bit for bit, for another run.
  parallel::Bytes pack() const;
  /// Held once per node. Every rank gives the same bytes. Collective; throws std::logic_error for bytes that
  /// are no field.
  static SizeField unpack(const parallel::Communicator& communicator, std::span<const std::byte> bytes);
  /// Fields with the same digest have the same sizes everywhere.
  parallel::Digest digest() const;
  /// The field with all sizes and bounds `factor` times as large, in the memory of this one.
  SizeField scaled(double factor) const;

private:
  friend class FieldBuilder;
  template <class Field>
  static auto fields_of(Field& field);
  /// The size at an offset from the low corner of the root cube.
  double interpolate(double dx, double dy, double dz) const;

  SizingOptions _options;
  geometry::Box _domain;  // as asked for
  geometry::Vec3 _low;    // corner of the root cube
  double _root_edge = 1;  // of the root cube
  double _factor = 1;     // of the sizes
  Octree _octree;
  CornerSizes _corner_sizes;  // times the factor
};

/// The field of a model: curvature and chordal deviation of faces and edges, proximity, narrow strips, sharp
/// corners, far field, bounds, growth. Faces are sampled, leaves made and sizes at their corners found by the
/// ranks in parallel; no rank has the sources of all. Collective. Throws std::invalid_argument for impossible
/// options, CollectiveError where the CAD library fails.
SizeField build_size_field(const parallel::Communicator& communicator, const cad::Model& model,
                           const SizingOptions& options);

/// Predicted size of the mesh under a field: integrals of 4/(sqrt(3) h^2) over the surface, and of 11.3/h^3,
/// what meshes of ten models have on average, over the volume.
struct PredictedCounts {
  double triangles = 0, tetrahedra = 0;

  static constexpr auto fields() {
    return std::tuple(&PredictedCounts::triangles, &PredictedCounts::tetrahedra);
  }
};

/// Sizes for the impatient: those of a field that gives about `target_tetrahedra`, with bounds taken from the
/// model (choose_sizes.hpp has the field with them). Collective.
SizingOptions choose_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                           double target_tetrahedra);

}  // namespace aeroloom::sizing
