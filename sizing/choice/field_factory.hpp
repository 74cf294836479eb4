/// Builds the size fields of one model under different sizes.
#pragma once

#include "sizing/choice/demands.hpp"
#include "sizing/choice/gap_search.hpp"
#include "sizing/choice/sampled_model.hpp"
#include "sizing/features/face_samples.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// A field and what it predicts.
struct Trial {
  SizeField field;
  double tetrahedra;
};

/// What sizes ask for about, by a field whose sizes are some times as large.
struct RoughField {
  SizeField field;  ///< as asked for, but smooth over that many sizes
  PredictedCounts counts;
};

/// A face on which a smallest size wins over curvature.
struct BoundedFace {
  cad::FaceId face;
  double fraction;  ///< of its area
  double degrees;   ///< that an element turns there, at most

  static constexpr auto fields() {
    return std::tuple(&BoundedFace::face, &BoundedFace::fraction, &BoundedFace::degrees);
  }
};

/// Whether samples of faces are kept: those that serve once only are not worth their memory.
enum class Fields : bool { one, several };

/// Samples a model, its gaps and what a case demands of it for one field after another. What is sampled is
/// remembered for sizes to come: answers do not depend on what was asked before.
class FieldFactory {
public:
  /// `layers`: elements across a gap that the fields to come may ask for, at most; `fields`: how many those
  /// will be; `demands`: what all of them ask for besides, whose patches the model has. Collective. Throws
  /// parallel::CollectiveError where the CAD library fails on a face.
  FieldFactory(SampledModel sampled, double layers, Fields fields, SizeDemands demands = {});

  /// For the model with some faces joined: what belongs to all others is taken over. Collective.
  FieldFactory(FieldFactory&& before, const cad::Model& joined);

  const SampledModel& sampled() const { return _sampled; }
  const cad::Model& model() const { return _sampled.model(); }
  const GapSearch& gaps() const { return _gaps; }

  /// What all fields to come ask for along lines, in place of what they did; the same on every rank.
  void demand(std::vector<SizeLine> lines);

  /// Whether sampling the faces cuts them into more parts than that, about, as their facets tell before it is
  /// done. Collective.
  bool has_more_parts(const SizingOptions& options, double most);

  /// The field under these options. Collective. This and what follows throw std::invalid_argument where the
  /// memory of this node cannot hold a point for each triangle.
  SizeField build_field(const SizingOptions& options);
  /// The field under these options with the tetrahedra that it predicts; nothing where it has clearly more
  /// leaves. Collective.
  std::optional<Trial> try_sizes(const SizingOptions& options, std::int64_t most_leaves);
  /// By a field of at most 300,000 leaves, or one whose sizes are 4096 times as large. Collective.
  RoughField build_rough_field(const SizingOptions& options);
  /// About what they would predict, by a field whose sizes are all `coarser` times as large; with one,
  /// exactly. Nothing where that has clearly more leaves. Remembered for sizes that are asked for again.
  /// Collective.
  std::optional<double> estimate_tetrahedra(const SizingOptions& options, double coarser,
                                            std::int64_t most_leaves);

  /// Faces on which the smallest size keeps elements from turning as little, or being as near, as is asked
  /// for; in the order of faces. Collective.
  std::vector<BoundedFace> faces_bounded_by_minimum(const SizingOptions& options);

  /// The sizes at some places where short edges, narrow faces and sharp corners ask for nothing. Collective.
  std::vector<double> sizes_without_features(std::span<const geometry::Vec3> places,
                                             const SizingOptions& options);

private:
  /// What estimate_tetrahedra() has found so far.
  struct Estimate {
    SizingOptions options;
    double coarser;
    std::int64_t leaves;
    double tetrahedra;
  };
  /// A field whose sizes are `coarser` times as large as those under these options.
  std::optional<SizeField> build_coarser(const SizingOptions& options, double coarser,
                                         std::int64_t most_leaves);
  /// Those that are remembered, or `once` where one field is built.
  FaceSamples& samples_of(cad::FaceId face, FaceSamples& once);
  /// Before anything is sampled as finely as that: sizes of which no machine could hold the points are a
  /// mistake. Collective. Throws std::invalid_argument.
  void require_possible(const SizingOptions& options);
  /// Of each face of this rank, by curvature.
  std::vector<std::pair<cad::FaceId, FaceSamples::Overview>> look_over(const SizingOptions& options);
  /// What the faces and edges of this rank ask for.
  std::vector<SizeSource> sample_own(const SizingOptions& options, double coarser);
  /// What the faces, edges and corners of this rank ask for, all sizes `coarser` times as large. Collective,
  /// as what follows.
  std::vector<SizeSource> sample(const SizingOptions& options, double coarser);
  /// What corners ask for, whose sides are as long as the sources of all ranks make them.
  std::vector<SizeSource> sample_corners(std::span<const SizeSource> own, const SizingOptions& options) const;
  /// The sizes under the sources of all ranks, at points that are the same on each.
  std::vector<double> sizes_at(std::span<const geometry::Vec3> points, std::span<const SizeSource> own,
                               const SizingOptions& options) const;

  SampledModel _sampled;
  Demands _demands;
  GapSearch _gaps;
  Fields _fields;
  std::map<cad::FaceId, FaceSamples> _samples;  // of faces of this rank, where several fields are built
  std::vector<Estimate> _estimates;
};

}  // namespace aeroloom::sizing
