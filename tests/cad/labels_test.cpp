// What a file says about its faces besides their shape: names, layers and colours, from which patches are
// named.
#include "tests/cad/cad_shapes.hpp"

#include <algorithm>
#include <string>

#include <BRepPrimAPI_MakeBox.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

/// A box of 2 x 1 x 1 whose first face is in a layer and whose second face is coloured, in a document.
Handle(TDocStd_Document) labelled_box() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(2, 1, 1).Shape();
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const TDF_Label part = shapes->AddShape(box, false);
  TopExp_Explorer faces(box, TopAbs_FACE);
  const TDF_Label first = shapes->AddSubShape(part, faces.Current());
  XCAFDoc_DocumentTool::LayerTool(document->Main())->SetLayer(first, "inlet");
  faces.Next();
  const TDF_Label second = shapes->AddSubShape(part, faces.Current());
  const Quantity_Color red(1, 0, 0, Quantity_TOC_RGB);
  XCAFDoc_DocumentTool::ColorTool(document->Main())->SetColor(second, red, XCAFDoc_ColorSurf);
  return document;
}

TEST(Labels, LayersAndColoursOfFacesNamePatches) {
  const real::TemporaryFile file("labelled.step", "");
  STEPCAFControl_Writer writer;
  writer.SetLayerMode(true);
  writer.SetColorMode(true);
  ASSERT_TRUE(writer.Transfer(labelled_box(), STEPControl_AsIs));
  ASSERT_EQ(writer.Write(file.path().c_str()), IFSelect_RetDone);
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.file = file.path();
  const Model model = prepare_domain(options).model;
  for (const std::string patch : {"inlet", "#ff0000"}) {
    const auto faces = shapes::faces_of_patch(model, patch);
    ASSERT_EQ(faces.size(), 1U) << patch;
    EXPECT_NEAR(model.face_area(faces.front()), 1, 1e-6) << patch;
  }
  EXPECT_EQ(model.face_count(), 6);
}

}  // namespace
}  // namespace aeroloom::cad
