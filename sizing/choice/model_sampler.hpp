/// A model distributed over the ranks for sampling: what does not depend on sizes is done once.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/features/face_samples.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/proximity.hpp"
#include "sizing/features/triangle_tree.hpp"
#include "sizing/sources/size_demands.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

class SurfaceDemand;

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

/// The narrowest place of a face between two of its edges that share no vertex.
struct Strip {
  cad::FaceId face;
  double width;
  geometry::Vec3 place;

  static constexpr auto fields() { return std::tuple(&Strip::face, &Strip::width, &Strip::place); }
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

/// A face on which the search for gaps ended early.
struct UnseenGaps {
  cad::FaceId face;
  geometry::Vec3 place;  ///< middle of the largest part that was not looked at
  double size;           ///< of that part: gaps much narrower than this may have been missed there

  static constexpr auto fields() {
    return std::tuple(&UnseenGaps::face, &UnseenGaps::place, &UnseenGaps::size);
  }
};

/// Two faces that lie on one another, or nearly so.
struct CoincidentFaces {
  cad::FaceId first, second;
  double area;           ///< over which they do, about
  geometry::Vec3 place;  ///< on the first one
  double apart;          ///< how far they are from each other there, at most

  static constexpr auto fields() {
    return std::tuple(&CoincidentFaces::first, &CoincidentFaces::second, &CoincidentFaces::area,
                      &CoincidentFaces::place, &CoincidentFaces::apart);
  }
};

/// Whether samples of faces are kept: those that serve once only are not worth their memory.
enum class Fields : bool { one, several };

/// Faces are assigned to ranks by area, edges one by one; each rank triangulates its faces. Whatever comes
/// out is the same for any number of ranks. What samples faces remembers what it found, for sizes to come:
/// answers do not depend on what was asked before.
class ModelSampler {
public:
  /// `layers`: elements across a gap that the fields to come may ask for, at most; `fields`: how many those
  /// will be; `demands`: what all of them ask for besides, whose patches the model has. Collective. Throws
  /// parallel::CollectiveError where the CAD library fails on a face.
  ModelSampler(const parallel::Communicator& communicator, const cad::Model& model, double layers,
               Fields fields, SizeDemands demands = {});

  /// For the model with some faces joined: what belongs to all others is taken over. Collective.
  ModelSampler(ModelSampler&& before, const cad::Model& joined);

  /// What all fields to come ask for along lines, in place of what they did; the same on every rank.
  void demand(std::vector<SizeLine> lines);

  /// Whether sampling the faces cuts them into more parts than that, about, as their facets tell before it is
  /// done. Collective.
  bool has_more_parts(const SizingOptions& options, double most);

  /// The field under these options. Collective. This and what follows throw std::invalid_argument where the
  /// memory of this node cannot hold a point for each triangle.
  SizeField build_field(const SizingOptions& options);
  /// The size of the mesh under a field. Collective.
  PredictedCounts predict(const SizeField& field) const;
  /// The triangles that predict() counts. Collective.
  double count_triangles(const SizeField& field) const;
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

  /// Of the face, as its facets have it.
  double area(cad::FaceId face) const { return _areas[face]; }

  /// One for each face with strips narrower than that, by width: the least distance between two of its edges.
  /// `minimum` tells how far corners are closed. Collective.
  std::vector<Strip> strips_narrower_than(double width, double minimum) const;

  /// Elements along both sides of all strips narrower than the minimum, about, for each of some aspects
  /// (SizingOptions::feature_aspect): lengths over strip_size(). Each counts by what grows around it until
  /// sizes are the minimum: where they grow by k a length from s to m, the integral of 2 pi r / (s + k r)^3
  /// is that to infinity times (1 - s/m)^2. Collective.
  std::vector<double> elements_along_strips(std::span<const double> aspects,
                                            const SizingOptions& options) const;
  /// The sizes at some places where short edges, narrow faces and sharp corners ask for nothing. Collective.
  std::vector<double> sizes_without_features(std::span<const geometry::Vec3> places,
                                             const SizingOptions& options);
  /// The width of the narrowest gap that sizes below the minimum resolve; infinite where there is none, or
  /// none were looked for. The same on every rank.
  double narrowest_gap() const { return _narrowest_gap; }

  /// Faces on which the search for gaps ended early, for the work it would have been; in the order of faces,
  /// the same on every rank.
  const std::vector<UnseenGaps>& unseen_gaps() const { return _unseen_gaps; }

  /// Pairs of faces of the body, none between regions, that are nearer than 2e-5 of the body's extent, or
  /// with a gap of up to 2e-4 that is meshed and would take ten million triangles, over more than a twentieth
  /// of the smaller one's area; not where they run together towards a common edge. The largest areas first.
  /// By facets and projections. For the model before any of its faces were joined. Collective.
  std::vector<CoincidentFaces> find_coincident_faces() const;

  const cad::Model& model() const { return _model; }
  const parallel::Communicator& communicator() const { return _communicator; }
  /// Facets of all faces, by face; not those between regions.
  const Walls& walls() const { return *_walls; }
  /// The box of all faces that are not far field; of everything where there are none.
  const geometry::Box& body_box() const { return _body_box; }

private:
  /// What this rank knows of one of its faces.
  struct OwnFace {
    cad::FaceId id;
    cad::Facets facets;
    FaceSamples samples;
    std::optional<Gaps> gaps = {};  // seen from the face; nothing: not looked for yet
    std::vector<EdgePair> closed_corners = {};
  };
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
  /// Takes the faces sampled of the model before; `number` tells which face has become of each.
  void take_faces(std::vector<OwnFace> before, const std::vector<cad::FaceId>& number);
  void add_face(cad::FaceId id);
  void list_corners();
  void gather_triangles();
  /// Before anything is sampled as finely as that: sizes of which no machine could hold the points are a
  /// mistake. Collective. Throws std::invalid_argument.
  void require_possible(const SizingOptions& options);
  /// Of each face of this rank, by curvature.
  std::vector<std::pair<cad::FaceId, FaceSamples::Overview>> look_over(const SizingOptions& options);
  enum class Notes { tell, were_told };
  void measure_gaps(Notes notes);
  /// What all ranks have found. Collective.
  void gather_gaps();
  /// The options as they hold on a face: a size of its patch binds every other one there.
  SizingOptions options_on(cad::FaceId face, const SizingOptions& options) const;
  /// What regions ask for, this rank's part; collective, as what follows.
  std::vector<SizeSource> sample_regions(double coarser) const;
  /// Walls, wakes and edges that demands name.
  void lay_surfaces();
  /// What the formula and those ask for; each ends early with one more than `most`.
  std::vector<SizeSource> sample_formula(const SizingOptions& options, double coarser, double most) const;
  std::vector<SizeSource> sample_surfaces(const SizingOptions& options, double coarser, double most) const;
  /// All that demands ask for, but on patches.
  std::vector<SizeSource> sample_demands(const SizingOptions& options, double coarser) const;
  /// Whether that is clearly more than so many cells.
  bool demands_more_cells(const SizingOptions& options, double coarser, double most) const;
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
  /// Facets of all faces that bound the domain.
  const TriangleTree& boundary() const { return _part_on_boundary ? *_part_on_boundary : _walls->tree; }
  double count_tetrahedra(const SizeField& field) const;

  parallel::Communicator _communicator;
  cad::Model _model;
  double _layers;
  Fields _fields;
  SizeDemands _demands;
  RootCube _root;
  std::vector<double> _asked_on_faces;  // sizes of their patches; 0: none
  std::vector<bool> _far_field;
  std::vector<double> _areas;
  std::vector<int> _owners;                       // ranks, by face
  std::vector<OwnFace> _faces;                    // ascending
  std::vector<cad::FaceCorner> _corners;          // of those, where may_be_sharp
  std::optional<TriangleTree> _part_on_boundary;  // facets that bound the domain, where not all do
  std::optional<Walls> _walls;                    // facets of all faces
  std::shared_ptr<const std::vector<SurfaceDemand>> _surfaces;
  geometry::Box _body_box;
  std::vector<Estimate> _estimates;
  std::vector<UnseenGaps> _unseen_gaps;
  double _narrowest_gap = std::numeric_limits<double>::infinity();
};

}  // namespace aeroloom::sizing
