/// A model dealt to the ranks for sampling: what does not depend on sizes is done once.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/face_samples.hpp"
#include "sizing/model_sources.hpp"
#include "sizing/proximity.hpp"
#include "sizing/triangle_tree.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// A field and what it predicts.
struct Trial {
  SizeField field;
  PredictedCounts counts;
};

/// Whether samples of faces are kept: those that serve once only are not worth their memory.
enum class Fields : bool { one, several };

/// Faces are dealt to ranks by area, edges one by one; each rank triangulates its faces. Whatever comes out
/// is the same for any number of ranks.
class ModelSampler {
public:
  /// `layers`: elements across a gap that the fields to come may ask for, at most; `fields`: how many those
  /// will be. Collective. Throws parallel::CollectiveError where the CAD library fails on a face.
  ModelSampler(const parallel::Communicator& communicator, const cad::Model& model,
               parallel::StageClock& clock, double layers, Fields fields);

  /// The field under these options. Collective.
  SizeField build_field(const SizingOptions& options) const;
  /// As predict_counts. Collective.
  PredictedCounts predict(const SizeField& field) const;
  /// A field whose sizes are all `coarser` times as large as those under these options, and about what these
  /// would predict: with one, exactly. Nothing where the field has clearly more leaves. Collective.
  std::optional<Trial> try_sizes(const SizingOptions& options, double coarser,
                                 std::int64_t most_leaves) const;

  const cad::Model& model() const { return _model; }
  /// The box of all faces that are not far field; of everything where there are none.
  const geometry::Box& body_box() const { return _body_box; }

private:
  void gather_triangles();
  void measure_gaps(std::vector<Triangle> walls, std::vector<cad::FaceId> faces);
  /// What the faces and edges of this rank ask for.
  std::vector<SizeSource> sample_own(const SizingOptions& options) const;
  /// What all ask for, corners included, sizes multiplied by `factor`. Collective.
  std::vector<SizeSource> sample(const SizingOptions& options, double factor) const;
  std::vector<SizeSource> sample_corners(std::span<const SizeSource> sources,
                                         const SizingOptions& options) const;
  double count_triangles(const SizeField& field) const;
  double count_tetrahedra(const SizeField& field) const;

  parallel::Communicator _communicator;
  cad::Model _model;
  parallel::StageClock& _clock;
  double _layers;
  Fields _fields;
  RootCube _root;
  std::vector<bool> _far_field;
  std::vector<double> _areas;
  std::vector<cad::FaceId> _faces;   // of this rank, ascending
  std::vector<cad::Facets> _facets;  // of those
  mutable std::vector<FaceSamples>
      _samples;                           // of those; they grow with what is asked for, answers do not change
  std::vector<cad::FaceCorner> _corners;  // of those, where may_be_sharp
  std::optional<TriangleTree> _boundary;  // facets of all faces that bound the domain, in the order of faces
  std::vector<Gap> _gaps;                 // seen from the faces of this rank
  geometry::Box _body_box;
};

}  // namespace aeroloom::sizing
