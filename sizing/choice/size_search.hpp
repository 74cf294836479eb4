/// Searches the sizes that give a wanted number of tetrahedra.
#pragma once

#include "sizing/choice/choose_sizes.hpp"

#include <cstdint>
#include <optional>

namespace aeroloom::sizing {

/// All sizes where the size on the body is this and no feature is finer than the minimum, unless that is
/// given. Bounds that are not given follow from that one size. On the body no size is larger than a fifth of
/// its extent. Beyond that, the smallest size and the growth of sizes increase instead.
SizingOptions sizes_for(double body_size, const FieldFactory& factory, const GivenSizes& given);

/// The size on the body that a search starts from where nothing is known.
double first_size(const FieldFactory& factory);

/// A field with more leaves than this gives several times that many tetrahedra.
std::int64_t leaves_for(double tetrahedra);

/// How much larger sizes are than those wanted in fields that only show the way to a target.
double coarsening_for(double target_tetrahedra);

/// The most parts of faces that are sampled for a field of that many leaves.
double most_parts_for(std::int64_t leaves, double coarsening);

/// Fields that are built to meet a target, and full ones where coarse ones found nothing near it: each takes
/// as long as that of the mesh (docs/bounds.md).
inline constexpr int most_rounds = 8, rounds_out_of_reach = 2;

/// Searches the size on the body that gives the target, features included, by fields whose sizes are
/// `coarsening` times as large.
class SizeSearch {
public:
  /// The factory and the given sizes must outlive the search.
  SizeSearch(FieldFactory& factory, double target_tetrahedra, double coarsening,
             const FeatureResolution& features, const GivenSizes& given);

  /// Ends where the logarithm of the count over the target is at most the error. No size on the body is
  /// larger than `coarsest`; 0: any. Collective.
  void run(double first_size, double largest_error, int most_rounds, double coarsest = 0);

  bool is_out_of_reach() const;
  bool is_infeasible() const;
  /// The sizes that came nearest to the target; the coarsest tried where all were far too fine.
  const SizingOptions& options() const { return _options; }
  double body_size() const { return _body_size; }
  /// The elements that were predicted for options(); infinite where there are far too many.
  double tetrahedra() const;
  /// As options(), with the field: of a search by fields that are as fine as asked for. Collective.
  ChosenSizes best(FieldFor purpose);

private:
  /// The logarithm of the count over the target; far_too_many where it was given up. What comes nearest is
  /// kept.
  double judge(double body_size);

  /// The error of a field that was given up.
  static constexpr double far_too_many = 1e300;

  FieldFactory& _factory;
  const GivenSizes& _given;
  double _coarsening;
  FeatureResolution _features;
  double _target;
  std::int64_t _most_leaves;
  double _error = far_too_many, _body_size = 0;
  SizingOptions _options;
  std::optional<Trial> _best;
};

}  // namespace aeroloom::sizing
