/// The size field h(x): the wanted edge length at each point. Curves, surfaces and volume all use it.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/storage/digest.hpp"
#include "sizing/field/corner_sizes.hpp"
#include "sizing/field/octree.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// The sizes that a user asks for. Lengths are in the unit of the model. Away from a small size, each element
/// is at most `growth` times as large as the one before, so |grad h| <= ln(growth).
struct SizingOptions {
  double minimum = 0;           ///< smallest size, > 0
  double maximum = 0;           ///< largest size, >= minimum; the size of the far field
  double curvature_angle = 12;  ///< degrees an element may turn on a curved face or edge
  double growth = 1.3;          ///< ratio of neighbouring element sizes, > 1
  double surface_maximum = 0;   ///< largest size on faces of the body, far field excepted; 0: `maximum`
  /// Least number of elements across a thin part, whose inside is not meshed, or a gap; 0: any. Negative: one
  /// across gaps; in thin parts sizes only keep triangles of both sides apart.
  double proximity = -1;
  double gap_proximity = -1;   ///< the same across gaps alone; negative: `proximity`
  double feature_minimum = 0;  ///< `minimum` of short edges, narrow faces, sharp corners; 0: minimum / 20
  double narrow_minimum = 0;   ///< `minimum` of narrow faces alone; 0: as feature_minimum
  double gap_minimum = 0;      ///< `minimum` of gaps between walls that do not meet; 0: minimum
  /// Length of an element over the width of a narrow face, >= 1; also at short edges and sharp corners. No
  /// element is longer than `minimum` for it.
  double feature_aspect = 1;
  /// Largest distance of triangles from curved faces; sizes for it may lie below `minimum`. 0: any
  double chordal_deviation = 0;
  friend bool operator==(const SizingOptions&, const SizingOptions&) = default;
};

/// The smallest size that short edges, narrow faces and sharp corners may ask for.
inline double smallest_feature_size(const SizingOptions& options) {
  return options.feature_minimum > 0 ? options.feature_minimum : 0.05 * options.minimum;
}

/// The smallest size that narrow faces may ask for.
inline double smallest_narrow_size(const SizingOptions& options) {
  return options.narrow_minimum > 0 ? options.narrow_minimum : smallest_feature_size(options);
}

/// The size that a feature of this length or width asks for. It is at least `smallest`.
inline double feature_size(double extent, double smallest, const SizingOptions& options) {
  return std::max(std::min(options.feature_aspect * extent, std::max(extent, options.minimum)), smallest);
}

/// The size that a narrow region of a face asks for, from its width.
inline double narrow_size(double width, const SizingOptions& options) {
  return feature_size(width, smallest_narrow_size(options), options);
}

/// The least number of elements across a gap between walls.
inline double elements_across_gaps(const SizingOptions& options) {
  if (options.gap_proximity >= 0) return options.gap_proximity;
  return options.proximity >= 0 ? options.proximity : 1;
}

/// The smallest size that gaps may ask for.
inline double smallest_gap_size(const SizingOptions& options) {
  return options.gap_minimum > 0 ? options.gap_minimum : options.minimum;
}

/// A source: a point that asks for a size.
struct SizeSource {
  geometry::Vec3 point;
  double size;
};

/// The size field: a graded octree with sizes at the corners of its leaves. Inside a leaf the size is
/// trilinear; the field is continuous. At a source, h is at most the size asked for, to single precision. It
/// is less only where a source near by asks for less. A source asks for its size in the whole leaf around it,
/// whose edge is at most that size. From there h grows by ln(growth) for each length. It lies between
/// `minimum` and `maximum`. Only short edges, narrow faces, sharp corners, open gaps and the sources of
/// refined() may ask for less than `minimum`. A field does not change, and is the same on every rank. It is
/// cheap to copy, and holds the communicator of the ranks that built it. These hold it once on each node.
class SizeField {
public:
  /// Builds the field over `domain` on this rank alone, which is then its only rank. Sizes below the minimum
  /// are raised to it. A source outside counts at the nearest point of the box. The result depends on the set
  /// of sources, not on their order. Throws std::invalid_argument for impossible options, an empty domain,
  /// and sizes that are not positive.
  static SizeField build(const geometry::Box& domain, std::span<const SizeSource> sources,
                         const SizingOptions& options);

  /// The size at a point; takes well under a microsecond. Outside the domain it is that of the nearest point
  /// of its box.
  double operator()(geometry::Vec3 x) const;
  double minimum() const { return _options.minimum; }
  double maximum() const { return _options.maximum; }
  const SizingOptions& options() const { return _options; }
  const geometry::Box& domain() const { return _domain; }
  std::int64_t leaf_count() const { return static_cast<std::int64_t>(_octree.keys.size()); }
  /// The ranks that built the field; after build() this rank alone.
  const parallel::Communicator& communicator() const { return _octree.communicator; }

  /// One leaf of the octree.
  struct Leaf {
    geometry::Vec3 low;
    double edge;  ///< length
    double size;  ///< h at the centre
  };
  Leaf leaf(std::int64_t i) const;
  /// The cube `levels` levels above that leaf, or the root. Its size is not set.
  Leaf ancestor(std::int64_t i, int levels) const;

  /// The field with further sources, each rank its own. Sizes can only fall, also below the minimum. The
  /// result does not depend on which rank gives a source. Used where surfaces come too close. Collective.
  SizeField refined(std::span<const SizeSource> more) const;
  /// All of the field as bytes, exact to the last bit, for another run.
  parallel::Bytes pack() const;
  /// The field of such bytes, the same on every rank. Held once on each node. Collective. Throws
  /// std::logic_error if the bytes are no field.
  static SizeField unpack(const parallel::Communicator& communicator, std::span<const std::byte> bytes);
  /// Fields with equal digests have equal sizes everywhere.
  parallel::Digest digest() const;
  /// The field with all sizes and lengths `factor` times as large, growth to its power. It shares memory.
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

/// The size field of a model. Sizes follow from curvature, chordal deviation, gaps, narrow faces, sharp
/// corners, the far field, the bounds and the growth. Each rank samples its faces, makes its leaves and finds
/// sizes at its corners; no rank has all sources. Collective. Throws std::invalid_argument for impossible
/// options, CollectiveError where the CAD library fails.
SizeField build_size_field(const parallel::Communicator& communicator, const cad::Model& model,
                           const SizingOptions& options);

/// The elements that a mesh under a field is expected to have. Triangles are the integral of 4 / (sqrt(3)
/// h^2) over the surface. Tetrahedra are that of 11.3 / h^3 over the volume, the mean of the meshes of ten
/// models.
struct PredictedCounts {
  double triangles = 0, tetrahedra = 0;
};

/// The sizes of a field that gives about `target_tetrahedra`, with bounds taken from the model.
/// choose_sizes.hpp returns the field too. Collective.
SizingOptions choose_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                           double target_tetrahedra);

}  // namespace aeroloom::sizing
