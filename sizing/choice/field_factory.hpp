/// Builds the size fields of one model for different sizes.
#pragma once

#include "sizing/choice/gap_search.hpp"
#include "sizing/choice/request_sampler.hpp"
#include "sizing/choice/sampled_model.hpp"
#include "sizing/features/face_samples.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// A field, and the tetrahedra that it predicts.
struct Trial {
  SizeField field;
  double tetrahedra;
};

/// A field with larger sizes, and the counts that it predicts for the sizes asked for.
struct CoarseField {
  SizeField field;  ///< scaled to the sizes asked for, without their details
  PredictedCounts counts;
};

/// A face on which a smallest size wins over curvature.
struct BoundedFace {
  cad::FaceId face;
  double fraction;  ///< of its area
  double degrees;   ///< the most that an element turns there
};

/// How many fields are to be built. Samples of faces are kept only for several.
enum class Fields : bool { one, several };

/// Builds one field after another from a model, its gaps and the requests of a case. Samples of faces and
/// counted tetrahedra are kept for later fields. No result depends on earlier calls.
class FieldFactory {
public:
  /// `gaps`: the most that any of the fields asks of gaps. `requests`: what all fields ask for besides; the
  /// model must have their patches. Collective. Throws parallel::CollectiveError where the CAD library fails
  /// on a face.
  FieldFactory(SampledModel sampled, GapDemand gaps, Fields fields, SizeRequests requests = {});

  /// For the model with some faces joined. Keeps everything of all other faces. Collective.
  FieldFactory(FieldFactory&& before, const cad::Model& joined);

  const SampledModel& sampled() const { return _sampled; }
  const cad::Model& model() const { return _sampled.model(); }
  const GapSearch& gaps() const { return _gaps; }

  /// Replaces the lines that all later fields ask for. Every rank gives the same.
  void request_lines(std::vector<SizeLine> lines);

  /// Whether sampling would cut the faces into more than about `most` parts. The facets alone tell.
  /// Collective.
  bool has_more_parts(const SizingOptions& options, double most);

  /// The field under these options. Collective. This and what follows throw std::invalid_argument where the
  /// memory of this node cannot hold a point for each triangle.
  SizeField build_field(const SizingOptions& options);
  /// Whether some requests come on top of a target: try_sizes() and estimate_tetrahedra() leave them out.
  bool has_more_than_aimed() const { return _requests.add_to_target(); }
  /// The field under these options and the tetrahedra that it predicts. Returns nothing if the field clearly
  /// has more than `most_leaves` leaves. Collective.
  std::optional<Trial> try_sizes(const SizingOptions& options, std::int64_t most_leaves);
  /// A field with larger sizes: of at most 300,000 leaves, or with sizes 4096 times as large. Collective.
  CoarseField build_coarse_field(const SizingOptions& options);
  /// The tetrahedra that try_sizes() would predict, about, by a field whose sizes are `coarsening` times as
  /// large. With 1 the number is exact. Returns nothing if that field clearly has more than `most_leaves`
  /// leaves. Numbers are kept for equal sizes. Collective.
  std::optional<double> estimate_tetrahedra(const SizingOptions& options, double coarsening,
                                            std::int64_t most_leaves);

  /// The faces where the smallest size wins: elements turn more, or leave the surface by more, than asked
  /// for. In the order of faces. Collective.
  std::vector<BoundedFace> faces_bounded_by_minimum(const SizingOptions& options);

  /// The sizes at some places if short edges, narrow faces and sharp corners ask for nothing. Collective.
  std::vector<double> sizes_without_features(std::span<const geometry::Vec3> places,
                                             const SizingOptions& options);

private:
  /// A result of estimate_tetrahedra().
  struct Estimate {
    SizingOptions options;
    double coarsening;
    std::int64_t leaves;
    double tetrahedra;
  };
  /// A field whose sizes are `coarsening` times as large as those of the options.
  std::optional<SizeField> build_coarser(const SizingOptions& options, double coarsening, Requests which,
                                         std::int64_t most_leaves);
  /// The kept samples of a face; `once` where only one field is built.
  FaceSamples& samples_of(cad::FaceId face, FaceSamples& once);
  /// Refuses sizes before sampling, if no machine could hold the points. Collective. Throws
  /// std::invalid_argument.
  void require_possible(const SizingOptions& options);
  /// What sizes do to each face of this rank, by curvature.
  std::vector<std::pair<cad::FaceId, FaceSamples::Overview>> look_over(const SizingOptions& options);
  /// The sources on the faces and edges of this rank.
  std::vector<SizeSource> sample_own(const SizingOptions& options, double coarsening);
  /// The sources on the faces, edges and corners of this rank, and of the requests. All sizes are
  /// `coarsening` times as large. Collective, as what follows.
  std::vector<SizeSource> sample(const SizingOptions& options, double coarsening, Requests which);
  /// The sources behind sharp corners. The sources of all ranks tell the size at each corner.
  std::vector<SizeSource> sample_corners(std::span<const SizeSource> own, const SizingOptions& options) const;
  /// The sizes that the sources of all ranks give at points, which are the same on each rank.
  std::vector<double> sizes_at(std::span<const geometry::Vec3> points, std::span<const SizeSource> own,
                               const SizingOptions& options) const;

  SampledModel _sampled;
  RequestSampler _requests;
  GapSearch _gaps;
  Fields _fields;
  std::map<cad::FaceId, FaceSamples> _samples;  // of faces of this rank, where several fields are built
  std::vector<Estimate> _estimates;
};

}  // namespace aeroloom::sizing
