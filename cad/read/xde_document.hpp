/// Parts, names, colours and layers of a file's shapes, as the exchange framework keeps them. Seen by this
/// folder only.
#pragma once

#include "cad/model/named_shape.hpp"

#include <string>

#include <NCollection_DataMap.hxx>
#include <TDocStd_Document.hxx>
#include <TopTools_ShapeMapHasher.hxx>

namespace aeroloom::cad {

/// Names that the file gives to faces, shells and solids themselves; keys have no location.
using EntityNames = NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher>;

Handle(TDocStd_Document) make_document();

/// All parts of the document in place, with labels on their faces. `names` of the file's own entities go
/// first.
NamedShape collect_parts(const Handle(TDocStd_Document) & document, const EntityNames& names);

/// Whether a name was made up by an exporter and says nothing.
bool is_placeholder(const std::string& name);

}  // namespace aeroloom::cad
