// Makes configs/geometry/duct.step: make_duct FILE. Compile against OpenCASCADE by hand; nothing else needs
// it.
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <GProp_GProps.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

namespace {

gp_Pnt centre_of(const TopoDS_Shape& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  return properties.CentreOfMass();
}

/// A duct along x, 4 m long, with a branch to y = 2.
TopoDS_Shape duct() {
  const TopoDS_Shape main = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), 4, 1, 1).Shape();
  const TopoDS_Shape branch = BRepPrimAPI_MakeBox(gp_Pnt(1.5, 0.5, 0), 1, 1.5, 1).Shape();
  BRepAlgoAPI_Fuse both(main, branch);
  both.SimplifyResult();
  return both.Shape();
}

}  // namespace

/// The inlet at x = 0 is red, the outlet at x = 4 in a layer, the end of the branch blue; no face has a name.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("write.step.unit", "M");
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const auto colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const auto layers = XCAFDoc_DocumentTool::LayerTool(document->Main());
  const TopoDS_Shape shape = duct();
  const TDF_Label part = shapes->AddShape(shape, false);
  const Quantity_Color red(1, 0, 0, Quantity_TOC_RGB), blue(0, 0, 1, Quantity_TOC_RGB);
  for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
    const gp_Pnt at = centre_of(faces.Current());
    const bool inlet = at.X()<0.01, outlet = at.X()> 3.99, end = at.Y() > 1.99;
    if (!inlet && !outlet && !end) continue;
    const TDF_Label face = shapes->AddSubShape(part, faces.Current());
    if (outlet) layers->SetLayer(face, "outlet");
    if (inlet || end) colours->SetColor(face, inlet ? red : blue, XCAFDoc_ColorSurf);
  }
  STEPCAFControl_Writer writer;
  writer.SetLayerMode(true);
  writer.SetColorMode(true);
  writer.Transfer(document, STEPControl_AsIs);
  writer.Write(argv[1]);
  return 0;
}
