#include "cad/model/model.hpp"
#include "cad/read/cad_reader.hpp"
#include "cad/read/length_unit.hpp"
#include "cad/read/xde_document.hpp"

#include <algorithm>

#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopLoc_Location.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

const LengthUnit* unit_of_section(const IGESData_GlobalSection& section) {
  constexpr int by_name = 3;
  if (section.UnitFlag() != by_name) return find_length_unit(section.UnitFlag());
  return section.UnitName().IsNull() ? nullptr : find_length_unit(section.UnitName()->ToCString());
}

/// Full names of any entity; the eight letters of the short label only where they name a part, as exporters
/// put the entity's type there for faces.
EntityNames names_in_iges(IGESControl_Reader& reader) {
  constexpr int manifold_solid = 186, shell = 514;
  EntityNames names;
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(IGESData_IGESEntity) entity = model->Entity(i);
    const bool part = entity->TypeNumber() == manifold_solid || entity->TypeNumber() == shell;
    Handle(TCollection_HAsciiString) name;
    if (entity->HasName()) name = entity->NameValue();
    if (name.IsNull() && part && entity->HasShortLabel()) name = entity->ShortLabel();
    if (name.IsNull() || name->IsEmpty()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (!shape.IsNull()) names.Bind(shape.Located(TopLoc_Location()), name->ToCString());
  }
  return names;
}

}  // namespace

NamedShape read_iges(const std::string& file) {
  IGESControl_Controller::Init();
  IGESCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(true);
  if (reader.ReadFile(file.c_str()) != IFSelect_RetDone || reader.IGESModel().IsNull()) {
    throw CadError(fmt::format("'{}': an IGES file that cannot be parsed", file));
  }
  const LengthUnit* declared = unit_of_section(reader.IGESModel()->GlobalSection());
  const LengthUnit& unit = declared ? *declared : millimetre();
  set_cad_library_unit(unit);
  Handle(TDocStd_Document) document = make_document();
  if (!reader.Transfer(document)) throw CadError(fmt::format("'{}': an IGES file without shapes", file));
  NamedShape named = collect_parts(document, names_in_iges(reader));
  named.unit_name = declared ? declared->name : "";
  named.unit_in_metres = unit.metres;
  named.precision = std::max(0.0, reader.IGESModel()->GlobalSection().Resolution());
  document->Close();
  return named;
}

}  // namespace aeroloom::cad
