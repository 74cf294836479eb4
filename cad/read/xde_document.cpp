#include "cad/read/xde_document.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <BRep_Builder.hxx>
#include <Quantity_Color.hxx>
#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace aeroloom::cad {
namespace {

std::string utf8_of(const TCollection_ExtendedString& text) {
  return TCollection_AsciiString(text).ToCString();
}

std::string name_of_label(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  return utf8_of(name->Get());
}

class PartCollector {
public:
  PartCollector(const Handle(TDocStd_Document) & document, const EntityNames& names)
      : _shapes(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        _colours(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        _layers(XCAFDoc_DocumentTool::LayerTool(document->Main())),
        _names(names) {
    _builder.MakeCompound(_compound);
  }

  NamedShape collect() {
    TDF_LabelSequence roots;
    _shapes->GetFreeShapes(roots);
    for (const TDF_Label& root : roots) visit(root, TopLoc_Location(), FaceLabel{});
    _result.shape = _compound;
    return std::move(_result);
  }

private:
  /// `inherited` is what the assemblies above say.
  void visit(const TDF_Label& label, const TopLoc_Location& place, FaceLabel inherited) {
    add_attributes(label, inherited);
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      TDF_Label part;
      XCAFDoc_ShapeTool::GetReferredShape(label, part);
      return visit(part, place * XCAFDoc_ShapeTool::GetLocation(label), inherited);
    }
    const std::string name = name_of_label(label);
    if (!is_placeholder(name)) inherited.solid = name;
    if (XCAFDoc_ShapeTool::IsAssembly(label)) {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components);
      for (const TDF_Label& component : components) visit(component, place, inherited);
      return;
    }
    add_part(label, place, inherited);
  }

  void add_part(const TDF_Label& label, const TopLoc_Location& place, const FaceLabel& inherited) {
    const TopoDS_Shape part = XCAFDoc_ShapeTool::GetShape(label);
    if (part.IsNull()) return;
    _builder.Add(_compound, part.Moved(place));
    describe_faces(part, place, [&](FaceLabel& face) { face = inherited; });
    describe_by_entities(part, place);
    TDF_LabelSequence details;
    XCAFDoc_ShapeTool::GetSubShapes(label, details);
    for (const TDF_Label& detail : details) describe_detail(detail, place);
  }

  /// Labels below a part speak of one of its solids, shells or faces.
  void describe_detail(const TDF_Label& detail, const TopLoc_Location& place) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(detail);
    if (shape.IsNull() || shape.ShapeType() > TopAbs_FACE) return;
    const bool is_face = shape.ShapeType() == TopAbs_FACE;
    const std::string name = name_of_label(detail);
    describe_faces(shape, place, [&](FaceLabel& face) {
      add_attributes(detail, face);
      if (is_placeholder(name)) return;
      std::string& wanted = is_face ? face.name : face.solid;
      if (is_face ? wanted.empty() : true) wanted = name;
    });
  }

  void describe_by_entities(const TopoDS_Shape& part, const TopLoc_Location& place) {
    for (const TopAbs_ShapeEnum kind : {TopAbs_SHELL, TopAbs_SOLID, TopAbs_FACE}) {
      for (TopExp_Explorer parts(part, kind); parts.More(); parts.Next()) {
        const std::string* name = _names.Seek(parts.Current().Located(TopLoc_Location()));
        if (!name || is_placeholder(*name)) continue;
        describe_faces(parts.Current(), place,
                       [&](FaceLabel& face) { (kind == TopAbs_FACE ? face.name : face.solid) = *name; });
      }
    }
  }

  template <class Describe>
  void describe_faces(const TopoDS_Shape& shape, const TopLoc_Location& place, Describe&& describe) {
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
      const TopoDS_Shape face = faces.Current().Moved(place);
      if (!_result.labels.IsBound(face)) _result.labels.Bind(face, FaceLabel{});
      describe(_result.labels.ChangeFind(face));
    }
  }

  void add_attributes(const TDF_Label& label, FaceLabel& face) const {
    Quantity_Color colour;
    if (_colours->GetColor(label, XCAFDoc_ColorSurf, colour) ||
        _colours->GetColor(label, XCAFDoc_ColorGen, colour)) {
      TCollection_AsciiString hex = Quantity_Color::ColorToHex(colour, true);
      hex.LowerCase();
      face.colour = hex.ToCString();
    }
    Handle(TColStd_HSequenceOfExtendedString) layers = new TColStd_HSequenceOfExtendedString;
    if (_layers->GetLayers(label, layers) && layers->Length() > 0) {
      face.layer = utf8_of(layers->Value(1));
    }
  }

  Handle(XCAFDoc_ShapeTool) _shapes;
  Handle(XCAFDoc_ColorTool) _colours;
  Handle(XCAFDoc_LayerTool) _layers;
  const EntityNames& _names;
  BRep_Builder _builder;
  TopoDS_Compound _compound;
  NamedShape _result;
};

}  // namespace

Handle(TDocStd_Document) make_document(const LengthUnit& unit, double factor) {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  if (factor != 1) XCAFDoc_DocumentTool::SetLengthUnit(document, unit.metres * factor);
  return document;
}

NamedShape collect_parts(const Handle(TDocStd_Document) & document, const EntityNames& names) {
  return PartCollector(document, names).collect();
}

bool is_placeholder(const std::string& name) {
  static const char* const made_up[] = {"NONE",     "UNNAMED",   "SOLID", "SHELL",        "FACE",
                                        "COMPOUND", "COMPSOLID", "SHAPE", "CLOSED SHELL", "OPEN SHELL"};
  const bool blank = std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isspace(c); });
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return std::toupper(c); });
  return blank || name.starts_with("Open CASCADE") || name.starts_with("=>[") ||
         std::find(std::begin(made_up), std::end(made_up), upper) != std::end(made_up);
}

}  // namespace aeroloom::cad
