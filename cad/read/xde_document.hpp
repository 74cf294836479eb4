/// Reads parts, names, colours and layers from a document of the CAD library's exchange framework (XDE).
/// Internal to cad/.
#pragma once

#include "cad/model/named_shape.hpp"
#include "cad/read/length_unit.hpp"

#include <string>

#include <NCollection_DataMap.hxx>
#include <TDocStd_Document.hxx>
#include <TopTools_ShapeMapHasher.hxx>

namespace aeroloom::cad {

/// Names that the file gives to faces, shells and solids. Keys have no location.
using EntityNames = NCollection_DataMap<TopoDS_Shape, std::string, TopTools_ShapeMapHasher>;

/// An empty document for shapes in `factor` of the unit.
Handle(TDocStd_Document) make_document(const LengthUnit& unit, double factor);

/// All parts of the document at their positions, with labels on their faces. `names` takes precedence over
/// names in the document.
NamedShape collect_parts(const Handle(TDocStd_Document) & document, const EntityNames& names);

/// Whether an exporter made the name up, such as "NONE" or "SOLID".
bool is_placeholder(const std::string& name);

}  // namespace aeroloom::cad
