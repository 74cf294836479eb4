/// A model, divided among the ranks to sample sizes on it. It does not depend on sizes.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/features/far_field.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/proximity.hpp"
#include "sizing/features/triangle_tree.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {

/// A face that this rank samples.
struct SampledFace {
  cad::FaceId id;
  cad::Facets facets;
  std::vector<EdgePair> closed_corners = {};  ///< is_closed_corner()
};

/// A model whose faces are assigned to ranks by area, and whose edges are assigned in turn. Each rank
/// triangulates its own faces. Every rank holds the facets of all faces. These are the same for any number of
/// ranks.
class SampledModel {
public:
  /// `roles`: by face, or none. Collective. Throws parallel::CollectiveError where the CAD library fails on a
  /// face.
  SampledModel(const parallel::Communicator& communicator, const cad::Model& model,
               const std::vector<FaceRole>& roles = {});

  /// For the same model with some faces joined. All other faces keep their facets. Collective.
  SampledModel(SampledModel&& before, const cad::Model& joined);

  const cad::Model& model() const { return _model; }
  const parallel::Communicator& communicator() const { return _communicator; }
  const RootCube& root() const { return _root; }

  /// The area of a face.
  double area(cad::FaceId face) const { return _areas[face]; }
  /// Whether a face bounds the far field, by find_far_field().
  bool bounds_far_field(cad::FaceId face) const { return _far_field.faces[face]; }
  /// Why faces are far field, or none is.
  const std::string& far_field_decision() const { return _far_field.decision; }

  /// The faces of this rank, ascending.
  const std::vector<SampledFace>& own_faces() const { return _faces; }
  /// The corners of those faces for which may_be_sharp() is true.
  const std::vector<cad::FaceCorner>& own_corners() const { return _corners; }
  /// The sources along the edges of this rank (edge_sources()).
  std::vector<SizeSource> sample_own_edges(const SizingOptions& options) const;

  /// The facets of all faces, in the order of faces. Faces between regions have none.
  const ModelFacets& facets() const { return *_facets; }
  /// The facets of all faces that bound the domain.
  const TriangleTree& boundary() const { return _part_on_boundary ? *_part_on_boundary : _facets->tree; }
  /// The box of all faces that are not far field. If all are, the box of the model.
  const geometry::Box& body_box() const { return _body_box; }

private:
  /// The areas of all faces; each rank measures a part of them.
  std::vector<double> measure_faces() const;
  void add_face(cad::FaceId id);
  /// Takes over the faces of the model before. `number`: the new number of each face.
  void take_faces(std::vector<SampledFace> before, const std::vector<cad::FaceId>& number);
  void list_corners();
  void gather_triangles();

  parallel::Communicator _communicator;
  cad::Model _model;
  RootCube _root;
  FarFieldFaces _far_field;
  std::vector<double> _areas;
  std::vector<int> _owners;  // ranks, by face
  std::vector<SampledFace> _faces;
  std::vector<cad::FaceCorner> _corners;
  std::optional<TriangleTree> _part_on_boundary;  // set if some facets do not bound the domain
  std::optional<ModelFacets> _facets;
  geometry::Box _body_box;
};

}  // namespace aeroloom::sizing
