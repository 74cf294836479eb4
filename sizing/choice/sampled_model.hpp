/// A model spread over the ranks as facets, from which sizes are sampled. It does not depend on sizes.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/proximity.hpp"
#include "sizing/features/triangle_tree.hpp"

#include <optional>
#include <vector>

namespace aeroloom::sizing {

/// A face that this rank samples.
struct SampledFace {
  cad::FaceId id;
  cad::Facets facets;
  std::vector<EdgePair> closed_corners = {};  ///< is_closed_corner()
};

/// Faces are assigned to ranks by area, edges one by one. Each rank triangulates its faces; the facets of all
/// faces are known on every rank. They are the same for any number of ranks.
class SampledModel {
public:
  /// Collective. Throws parallel::CollectiveError where the CAD library fails on a face.
  SampledModel(const parallel::Communicator& communicator, const cad::Model& model);

  /// The same model with some of its faces joined: all other faces keep their facets. Collective.
  SampledModel(SampledModel&& before, const cad::Model& joined);

  const cad::Model& model() const { return _model; }
  const parallel::Communicator& communicator() const { return _communicator; }
  const RootCube& root() const { return _root; }

  /// Of the face, as its facets have it.
  double area(cad::FaceId face) const { return _areas[face]; }
  /// As find_far_field() has it.
  bool bounds_far_field(cad::FaceId face) const { return _far_field[face]; }

  /// The faces of this rank, ascending.
  const std::vector<SampledFace>& own_faces() const { return _faces; }
  /// The corners of those faces that may_be_sharp().
  const std::vector<cad::FaceCorner>& own_corners() const { return _corners; }
  /// What the edges of this rank ask for by their curvature and length.
  std::vector<SizeSource> sample_own_edges(const SizingOptions& options) const;

  /// Facets of all faces, by face; not those between regions.
  const Walls& walls() const { return *_walls; }
  /// Facets of all faces that bound the domain.
  const TriangleTree& boundary() const { return _part_on_boundary ? *_part_on_boundary : _walls->tree; }
  /// The box of all faces that are not far field; of everything where there are none.
  const geometry::Box& body_box() const { return _body_box; }

private:
  /// Areas of all faces, each measured by one rank.
  std::vector<double> measure_faces() const;
  void add_face(cad::FaceId id);
  /// Takes the faces of the model before; `number` tells which face has become of each.
  void take_faces(std::vector<SampledFace> before, const std::vector<cad::FaceId>& number);
  void list_corners();
  void gather_triangles();

  parallel::Communicator _communicator;
  cad::Model _model;
  RootCube _root;
  std::vector<bool> _far_field;
  std::vector<double> _areas;
  std::vector<int> _owners;  // ranks, by face
  std::vector<SampledFace> _faces;
  std::vector<cad::FaceCorner> _corners;
  std::optional<TriangleTree> _part_on_boundary;  // facets that bound the domain, where not all do
  std::optional<Walls> _walls;
  geometry::Box _body_box;
};

}  // namespace aeroloom::sizing
