/// Rebuilds a shape with other edges. Internal to cad/repair/.
#pragma once

#include "cad/model/named_shape.hpp"

#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

/// The edges that replace an edge in every wire, in the direction of that edge. Empty if the edge becomes a
/// vertex.
using EdgeChain = std::vector<TopoDS_Edge>;

struct Substitution {
  TopTools_IndexedMapOfShape edges;  ///< edges to replace
  std::vector<EdgeChain> chains;     ///< chains[i] replaces edges(i + 1), taken forward
  TopTools_IndexedMapOfShape removed_faces;
};

/// Rebuilds the shape with the substitution. Two coedges that run along the same new edge and back are
/// removed. Inner loops without edges are removed too. Labels follow. Throws CadError if a face or a shell
/// would vanish that is not to be removed, or if a closed shell would open.
TopoDS_Shape substitute(const TopoDS_Shape& shape, const Substitution& substitution, FaceLabels& labels);

}  // namespace aeroloom::cad
