/// A shape rebuilt with other edges. Seen by this folder only.
#pragma once

#include "cad/model/named_shape.hpp"

#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

/// The edges that take an edge's place in every wire: in its direction, forward ones or reversed; nothing
/// where the edge became a vertex.
using EdgeChain = std::vector<TopoDS_Edge>;

struct Substitution {
  TopTools_IndexedMapOfShape edges;  ///< those to replace
  std::vector<EdgeChain> chains;     ///< of edges(i + 1), which is taken forward
  TopTools_IndexedMapOfShape removed_faces;
};

/// The shape with the substitution made. A coedge to and fro along one new edge vanishes, and so does a
/// loop of nothing inside a face. Labels follow. Throws CadError where a face or a shell would vanish that is
/// not to be removed, or a closed shell would open.
TopoDS_Shape substitute(const TopoDS_Shape& shape, const Substitution& substitution, FaceLabels& labels);

}  // namespace aeroloom::cad
