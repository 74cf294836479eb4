#include "cad/model/model.hpp"
#include "cad/read/cad_reader.hpp"
#include "cad/read/length_unit.hpp"
#include "cad/read/xde_document.hpp"
#include "geometry/name_text.hpp"

#include <algorithm>
#include <string>
#include <unordered_set>
#include <vector>

#include <IGESCAFControl_Reader.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Standard_Failure.hxx>
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
EntityNames names_in_iges(IGESControl_Reader& reader, const std::string& encoding,
                          std::vector<std::string>& read_otherwise) {
  constexpr int manifold_solid = 186, shell = 514;
  std::vector<TopoDS_Shape> shapes;
  std::vector<std::string> texts;
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
    if (shape.IsNull()) continue;
    shapes.push_back(shape.Located(TopLoc_Location()));
    texts.emplace_back(name->ToCString());
  }
  EntityNames names;
  std::unordered_set<std::string> said;
  const std::vector<geometry::DecodedName> decoded = geometry::decode_names(texts, encoding);
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    names.Bind(shapes[i], decoded[i].text);
    if (!decoded[i].change.empty() && said.insert(decoded[i].change).second)
      read_otherwise.push_back(decoded[i].change);
  }
  return names;
}

/// Curves, surfaces and what is made of them; others are names, colours, dimensions, views.
bool is_geometry(int type) {
  return (type >= 100 && type < 200) || (type >= 500 && type < 520);
}

/// What the CAD library says of geometry that it refuses, the first few: "entity 12 (type 126): ...".
std::string refusals_in(IGESControl_Reader& reader) {
  constexpr int most = 3;
  const Handle(IGESData_IGESModel) model = reader.IGESModel();
  std::string text;
  int refused = 0;
  const auto add = [&](int number, const Handle(Interface_Check) & check) {
    if (check.IsNull() || !check->HasFailed()) return;
    const Handle(IGESData_IGESEntity) entity = model->Entity(number);
    const int type = entity.IsNull() ? 0 : entity->TypeNumber();
    if ((type > 0 && !is_geometry(type)) || ++refused > most) return;
    text += fmt::format("; entity {} (type {}): {}", number, type, check->CFail(1));
  };
  for (int i = 1; i <= model->NbEntities(); ++i) add(i, model->Check(i, true));
  if (refused == 0) {
    Interface_CheckIterator checks = reader.WS()->TransferReader()->TransientProcess()->CheckList(true);
    for (checks.Start(); checks.More(); checks.Next())
      if (checks.Number() > 0) add(checks.Number(), checks.Value());
  }
  return refused > most ? fmt::format("{}; and {} more", text, refused - most) : text;
}

/// The document with the shapes of the file. Throws CadError with what the library says.
Handle(TDocStd_Document) transfer_iges(IGESCAFControl_Reader& reader, const std::string& file) {
  Handle(TDocStd_Document) document = make_document(millimetre(), 1);
  std::string why = "without shapes";
  try {
    if (reader.Transfer(document)) return document;
  } catch (const Standard_Failure& failure) {
    const char* const words = failure.GetMessageString();
    why =
        fmt::format("that the CAD library cannot read{}{}", words && *words ? ": " : "", words ? words : "");
  }
  throw CadError(
      fmt::format("'{}': an IGES file {}{}. Remedy: export it again, as STEP where that is possible", file,
                  why, refusals_in(reader)));
}

}  // namespace

NamedShape read_iges(const std::string& file, const std::string& encoding) {
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
  set_cad_library_unit(unit, 1);
  set_cad_library_precision(1, 0);
  const Handle(TDocStd_Document) document = transfer_iges(reader, file);
  std::vector<std::string> read_otherwise;
  NamedShape named = collect_parts(document, names_in_iges(reader, encoding, read_otherwise));
  named.read_otherwise = std::move(read_otherwise);
  named.refused = refusals_in(reader);
  named.unit_name = declared ? declared->name : "";
  named.unit_in_metres = unit.metres;
  named.precision = std::max(0.0, reader.IGESModel()->GlobalSection().Resolution());
  document->Close();
  return named;
}

}  // namespace aeroloom::cad
