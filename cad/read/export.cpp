#include "cad/read/export.hpp"

#include "cad/model/model.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/read/length_unit.hpp"
#include "cad/read/scale_shape.hpp"
#include "cad/repair/heal.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

#include <BRep_Builder.hxx>
#include <STEPConstruct.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS_Compound.hxx>
#include <Transfer_FinderProcess.hxx>
#include <XSControl_TransferWriter.hxx>
#include <XSControl_WorkSession.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

void require_writable(const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  if (!stream) throw std::ios_base::failure(fmt::format("cannot write '{}'", file));
}

void set_name(const Handle(Transfer_FinderProcess) & process, const TopoDS_Shape& shape,
              const std::string& name) {
  if (name.empty()) return;
  const Handle(StepRepr_RepresentationItem) item = STEPConstruct::FindEntity(process, shape);
  if (!item.IsNull()) item->SetName(new TCollection_HAsciiString(name.c_str()));
}

/// STEP has no faces inside of solids: they stand beside them.
TopoDS_Shape with_faces_apart(const NamedShape& named) {
  const TopTools_IndexedMapOfShape inner = faces_inside_solids(named.shape);
  if (inner.IsEmpty() && named.loose.empty()) return named.shape;
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Solid& solid : solids_of(named.shape)) builder.Add(all, without_inner_faces(solid));
  for (const TopoDS_Shape& face : shapes_in(inner)) builder.Add(all, face);
  for (const LooseFace& loose : named.loose) builder.Add(all, loose.face);
  return all;
}

/// The writer drops names; they go into the STEP entities after the transfer.
void write_names(const NamedShape& named, const Handle(Transfer_FinderProcess) & process) {
  for (const TopoDS_Solid& solid : solids_of(named.shape)) {
    std::string solid_name;
    for (TopExp_Explorer faces(solid, TopAbs_FACE); faces.More(); faces.Next()) {
      const FaceLabel* label = named.labels.Seek(faces.Current());
      if (!label) continue;
      set_name(process, faces.Current(), label->name);
      if (solid_name.empty()) solid_name = label->solid;
    }
    set_name(process, solid, solid_name);
  }
  for (TopExp_Explorer faces(named.shape, TopAbs_FACE, TopAbs_SOLID); faces.More(); faces.Next()) {
    if (const FaceLabel* label = named.labels.Seek(faces.Current()))
      set_name(process, faces.Current(), label->name);
  }
}

}  // namespace

void write_step(NamedShape named, const std::string& file) {
  require_writable(file);
  named.shape = with_faces_apart(named);
  named.loose.clear();
  if (named.unit != 1) named = scaled(std::move(named), 1);
  STEPControl_Controller::Init();
  const LengthUnit* unit = find_length_unit(named.unit_name);
  set_cad_library_unit(unit ? *unit : millimetre(), 1);
  STEPControl_Writer writer;
  if (writer.Transfer(named.shape, STEPControl_AsIs) != IFSelect_RetDone) {
    throw CadError("the CAD library cannot turn this shape into STEP");
  }
  write_names(named, writer.WS()->TransferWriter()->FinderProcess());
  if (writer.Write(file.c_str()) != IFSelect_RetDone) {
    throw std::ios_base::failure(fmt::format("cannot write '{}'", file));
  }
  std::error_code unknown;  // a name that the library does not understand becomes another
  if (std::filesystem::file_size(file, unknown) == 0 || unknown)
    throw std::ios_base::failure(fmt::format("cannot write '{}'", file));
}

}  // namespace aeroloom::cad
