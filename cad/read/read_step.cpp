#include "cad/model/model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/read/cad_reader.hpp"
#include "cad/read/length_unit.hpp"
#include "cad/read/scale_shape.hpp"
#include "cad/read/step_text.hpp"
#include "cad/read/xde_document.hpp"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string>
#include <unordered_set>

#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Controller.hxx>
#include <StepBasic_UncertaintyMeasureWithUnit.hxx>
#include <StepGeom_DegenerateToroidalSurface.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepShape_ConnectedFaceSet.hxx>
#include <StepShape_Face.hxx>
#include <StepShape_FaceBound.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_Loop.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_VertexLoop.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopLoc_Location.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The unit the file declares first; nullptr when it declares none that is known.
const LengthUnit* first_declared_unit(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  for (const TCollection_AsciiString& name : lengths) {
    if (const LengthUnit* unit = find_length_unit(name.ToCString())) return unit;
  }
  return nullptr;
}

/// The largest uncertainty of lengths that the file states; 0 where it states none.
double stated_uncertainty(STEPControl_Reader& reader) {
  double largest = 0;
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto measure = Handle(StepBasic_UncertaintyMeasureWithUnit)::DownCast(model->Value(i));
    if (!measure.IsNull()) largest = std::max(largest, measure->ValueComponent());
  }
  return largest;
}

/// Names in the file's faces, shells and solids themselves: the framework keeps only those of products.
EntityNames names_in_step(STEPControl_Reader& reader) {
  EntityNames names;
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(model->Value(i));
    if (item.IsNull() || item->Name().IsNull() || item->Name()->IsEmpty()) continue;
    if (!item->IsKind(STANDARD_TYPE(StepShape_Face)) && !item->IsKind(STANDARD_TYPE(StepShape_SolidModel)) &&
        !item->IsKind(STANDARD_TYPE(StepShape_ConnectedFaceSet))) {
      continue;
    }
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, item);
    if (!shape.IsNull()) names.Bind(shape.Located(TopLoc_Location()), item->Name()->ToCString());
  }
  return names;
}

/// The CAD library takes bytes for UTF-8, and loses what is not: it gets no others.
IFSelect_ReturnStatus parse(STEPCAFControl_Reader& reader, const std::string& file,
                            const std::optional<StepText>& decoded) {
  if (!decoded) return reader.ReadFile(file.c_str());
  std::istringstream stream(decoded->bytes);
  return reader.ChangeReader().ReadStream(file.c_str(), stream);
}

/// What is said of strings that became names. Those with escapes are said, too: nobody knows what they
/// became.
std::vector<std::string> changes_of_names(const NamedShape& named, const StepText& text) {
  std::unordered_set<std::string> names, said;
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) {
    if (const FaceLabel* label = named.labels.Seek(faces(i)))
      names.insert({label->name, label->solid, label->layer});
  }
  std::vector<std::string> changes;
  for (const DecodedString& each : text.decoded) {
    const bool is_name = names.contains(each.text) || each.text.find('\\') != std::string::npos;
    if (is_name && said.insert(each.change).second) changes.push_back(each.change);
  }
  return changes;
}

/// The CAD library drops which part of a torus that crosses itself a face without a border means.
void refuse_inner_tori(STEPControl_Reader& reader, const std::string& file) {
  const Handle(Interface_InterfaceModel) model = reader.WS()->Model();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto face = Handle(StepShape_FaceSurface)::DownCast(model->Value(i));
    if (face.IsNull()) continue;
    const auto torus = Handle(StepGeom_DegenerateToroidalSurface)::DownCast(face->FaceGeometry());
    if (torus.IsNull() || torus->SelectOuter()) continue;
    bool has_border = false;
    for (int k = 1; k <= face->NbBounds(); ++k)
      has_border = has_border || !face->BoundsValue(k)->Bound()->IsKind(STANDARD_TYPE(StepShape_VertexLoop));
    if (has_border) continue;
    throw CadError(fmt::format(
        "'{}': face '{}' of entity {} is the inner part of a torus that crosses itself (radii {:.6g} and "
        "{:.6g}), which the CAD library does not tell from the outer one. Remedy: export it as a surface of "
        "revolution",
        file, face->Name().IsNull() ? "" : face->Name()->ToCString(), model->StringLabel(face)->ToCString(),
        torus->MajorRadius(), torus->MinorRadius()));
  }
}

}  // namespace

NamedShape read_step(const std::string& file, const std::string& encoding, double in_unit) {
  STEPControl_Controller::Init();
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(true);
  const std::optional<StepText> decoded = decode_step(file, encoding);
  if (parse(reader, file, decoded) != IFSelect_RetDone) {
    throw CadError(fmt::format("'{}': a STEP file that cannot be parsed", file));
  }
  refuse_inner_tori(reader.ChangeReader(), file);
  const LengthUnit* declared = first_declared_unit(reader.ChangeReader());
  const LengthUnit& unit = declared ? *declared : millimetre();
  set_cad_library_unit(unit, in_unit);
  reader.ChangeReader().SetSystemLengthUnit(unit.metres * 1000 * in_unit);
  const double precision = precision_in(in_unit, stated_uncertainty(reader.ChangeReader()));
  set_cad_library_precision(in_unit, precision);
  Handle(TDocStd_Document) document = make_document(unit, in_unit);
  if (!reader.Transfer(document)) throw CadError(fmt::format("'{}': a STEP file without shapes", file));
  NamedShape named = collect_parts(document, names_in_step(reader.ChangeReader()));
  if (decoded) named.read_otherwise = changes_of_names(named, *decoded);
  named.unit_name = declared ? declared->name : "";
  named.unit_in_metres = unit.metres;
  named.unit = in_unit;
  named.precision = precision;
  document->Close();
  return named;
}

}  // namespace aeroloom::cad
