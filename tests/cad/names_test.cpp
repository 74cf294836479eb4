// Names in files, in any encoding, and names of patches that the program makes: none is lost, none takes
// another's faces.
#include "cad/domain/patch_names.hpp"
#include "tests/cad/cad_shapes.hpp"
#include "tests/cad/faceted_shapes.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRep_Builder.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

using shapes::changes_about;

TopoDS_Shape box_at(double x) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, 0, 0), 1, 1, 1).Shape();
}

/// Puts names, one after the other, into the entities of a kind.
void put_names(std::string& step, const std::string& kind, const std::vector<std::string>& names) {
  std::size_t at = 0;
  for (const std::string& name : names) {
    at = step.find(kind + "('", at);
    ASSERT_NE(at, std::string::npos) << kind;
    at += kind.size() + 2;
    step.replace(at, step.find('\'', at) - at, name);
    at += name.size();
  }
}

/// A STEP file whose faces, solids or products have these names, in these bytes.
std::string step_of(const TopoDS_Shape& shape, const std::string& kind,
                    const std::vector<std::string>& names) {
  const real::TemporaryFile file("names.step", "");
  STEPControl_Writer writer;
  writer.Transfer(shape, STEPControl_AsIs);
  writer.Write(file.path().c_str());
  std::ifstream stream(file.path(), std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  put_names(text, kind, names);
  return text;
}

Domain read_text(const std::string& text, DomainOptions options, const std::string& name = "text.step") {
  const real::TemporaryFile file(name, text);
  options.file = file.path();
  return prepare_domain(options);
}

DomainOptions fluid(const std::string& encoding = "") {
  DomainOptions options;
  options.kind = DomainKind::fluid;
  options.encoding = encoding;
  return options;
}

std::set<std::string> patches_of(const Model& model) {
  return {model.patches().begin(), model.patches().end()};
}

TEST(Names, OfBytesInStepFilesAreLatin1) {
  const Domain domain =
      read_text(step_of(box_at(0), "ADVANCED_FACE",
                        {"T\xFCr", "Ausla\xDF", "Ausla\xEA", "wall \xE9", "wall \xE8", "plain"}),
                fluid());
  EXPECT_EQ(patches_of(domain.model), (std::set<std::string>{"T\xC3\xBCr", "Ausla\xC3\x9F", "Ausla\xC3\xAA",
                                                             "wall \xC3\xA9", "wall \xC3\xA8", "plain"}));
  EXPECT_EQ(changes_about(domain.report.changes, "is no UTF-8: read as latin-1").size(), 5U);
  EXPECT_EQ(changes_about(domain.report.changes, "name 'T\\xFCr' is no UTF-8").size(), 1U);
}

TEST(Names, OfBytesInStepFilesAreInTheEncodingOfTheCase) {
  // "wing", "model" that is UTF-8 by chance, a letter with the byte of a backslash.
  const std::string step =
      step_of(box_at(0), "ADVANCED_FACE", {"\xBB\xFA\xD2\xED", "\xC4\xA3", "\x81\x5C", "a", "b", "c"});
  EXPECT_EQ(
      patches_of(read_text(step, fluid("GB18030")).model),
      (std::set<std::string>{"\xE6\x9C\xBA\xE7\xBF\xBC", "\xE6\xA8\xA1", "\xE4\xB9\x97", "a", "b", "c"}));
  EXPECT_EQ(patches_of(read_text(step, fluid()).model).size(), 6U);
}

TEST(Names, EscapesOfStepHold) {
  const Domain domain = read_text(step_of(box_at(0), "ADVANCED_FACE",
                                          {"a\\X2\\00FC\\X0\\b", "c\\X\\FCd", "e\\S\\|f", "g\xC3\xBCh",
                                           "i\xFC\\X2\\673A\\X0\\j", "k''\xFC"}),
                                  fluid());
  EXPECT_EQ(patches_of(domain.model),
            (std::set<std::string>{"a\xC3\xBC"
                                   "b",
                                   "c\xC3\xBC"
                                   "d",
                                   "e\xC3\xBC"
                                   "f",
                                   "g\xC3\xBCh", "i\xC3\xBC\xE6\x9C\xBAj", "k'\xC3\xBC"}));
}

TEST(Names, OfProductsAreWholeToo) {
  for (const std::string name : {"Fl\xFCgel", "Fl\\X2\\00FC\\X0\\gel", "Fl\xC3\xBCgel"}) {
    std::string step = step_of(box_at(0), "PRODUCT", {"1"});  // its identifier
    const std::size_t begin = step.find('\'', step.find("PRODUCT('1',") + 12) + 1;
    step.replace(begin, step.find('\'', begin) - begin, name);
    const Domain domain = read_text(step, {});
    EXPECT_EQ(patches_of(domain.model).count("Fl\xC3\xBCgel"), 1U) << name;
  }
}

TEST(Names, OfTrianglesAreDecoded) {
  const std::string stl = faceted::ascii_stl(faceted::box_soup({0, 0, 0}, {1, 1, 1}), "T\xFCr") +
                          faceted::ascii_stl(faceted::box_soup({3, 0, 0}, {4, 1, 1}), "T\xEAr");
  const Domain domain = read_text(stl, {}, "names.stl");
  EXPECT_EQ(patches_of(domain.model), (std::set<std::string>{"farfield", "T\xC3\xBCr", "T\xC3\xAAr"}));
  EXPECT_EQ(changes_about(domain.report.changes, "is no UTF-8").size(), 2U);
}

TEST(Names, OfPartsThatAreTakenAreOthers) {
  FacetSoup store = faceted::box_soup({3, 0, 0}, {4, 1, 1});
  const real::TemporaryFile file("store.stl", faceted::ascii_stl(store));
  for (const std::string name : {"farfield", "body"}) {
    DomainOptions options;
    options.parts = {{name, file.path(), 1}};
    const Domain domain = shapes::prepare(box_at(0), options);
    const std::vector<FaceId> faces = shapes::faces_of_patch(domain.model, name + "_2");
    ASSERT_EQ(faces.size(), 6U) << name;
    for (const FaceId face : faces) EXPECT_EQ(domain.model.face(face).part, name);
    for (const FaceId face : shapes::faces_of_patch(domain.model, "farfield"))
      EXPECT_TRUE(domain.model.is_far_field(face));
    const Changes said = changes_about(domain.report.changes, "is called '" + name + "_2'");
    ASSERT_EQ(said.size(), 1U);
    EXPECT_TRUE(said[0].is_warning);
  }
}

TEST(Names, OfFacesThatTheProgramTakesAreOthers) {
  const std::vector<std::string> names{"farfield", "body"};
  const Domain domain = read_text(step_of(box_at(0), "ADVANCED_FACE", names), {});
  EXPECT_EQ(shapes::faces_of_patch(domain.model, "farfield_2").size(), 1U);
  EXPECT_EQ(shapes::faces_of_patch(domain.model, "body").size(), 1U);
}

TEST(Names, OfInterfacesAreThoseOfTheRegions) {
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, box_at(0));
  builder.Add(both, box_at(1));
  const Domain domain = read_text(step_of(both, "MANIFOLD_SOLID_BREP", {"left", "right"}), fluid());
  EXPECT_EQ(patches_of(domain.model).count("interface_left_right"), 1U);
}

TEST(Names, OfInterfacesAreAllDifferent) {
  InterfaceNames names({"a_b", "c", "a", "b_c", "", "region_5", "a"});
  EXPECT_EQ(names(0, 1), "interface_a_b_c");
  EXPECT_EQ(names(3, 2), "interface_a_b_c_2");
  EXPECT_EQ(names(2, 3), "interface_a_b_c_2");
  EXPECT_EQ(names(4, 5), "interface_4_5");
  EXPECT_EQ(names(1, 2), "interface_c_a");
  EXPECT_EQ(names(1, 6), "interface_c_a_2");
}

/// A box and, beside it, a shell of one face, which are faces 0 to 6.
TopoDS_Shape box_and_stray_face() {
  TopoDS_Compound compound;
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  builder.MakeShell(shell);
  builder.Add(shell, shapes::faces_of(box_at(3)).front());
  builder.Add(compound, box_at(0));
  builder.Add(compound, shell);
  return compound;
}

TEST(Names, OfStrayFacesAreInTheMessageAndMayBeIgnored) {
  const std::string message = shapes::refusal(box_and_stray_face());
  EXPECT_NE(message.find("a single face 'face_6'"), std::string::npos) << message;
  EXPECT_NE(message.find("DomainOptions::ignore: ['face_6']"), std::string::npos) << message;
  for (const std::string text : {"face_6", "6", "*_6"}) {
    DomainOptions options;
    options.ignore = {text};
    const Domain domain = shapes::prepare(box_and_stray_face(), options);
    EXPECT_EQ(shapes::faces_of_patch(domain.model, "body").size(), 6U) << text;
    EXPECT_EQ(changes_about(domain.report.changes, "face 'face_6' is left out").size(), 1U);
  }
  DomainOptions wrong;
  wrong.ignore = {"sheet"};
  EXPECT_NE(shapes::refusal(box_at(0), wrong).find("no face of the file is called 'sheet'"),
            std::string::npos);
}

TEST(Names, OfGroupsOfTrianglesMayBeIgnored) {
  FacetSoup sheet = faceted::box_soup({3, 0, 0}, {4, 1, 1});
  sheet.triangles.resize(2);
  const std::string stl = faceted::ascii_stl(faceted::box_soup({0, 0, 0}, {1, 1, 1}), "cube") +
                          faceted::ascii_stl(sheet, "sheet");
  EXPECT_THROW(read_text(stl, {}, "sheet.stl"), CadError);
  DomainOptions options;
  options.ignore = {"sheet"};
  EXPECT_EQ(shapes::faces_of_patch(read_text(stl, options, "sheet.stl").model, "cube").size(), 6U);
}

TEST(Names, ThatNoFaceHasAnyMoreAreKnown) {
  const Domain domain =
      read_text(step_of(box_and_stray_face(), "ADVANCED_FACE", {"a", "b", "c", "d", "e", "f", "stray"}), [] {
        DomainOptions options;
        options.ignore = {"stray"};
        return options;
      }());
  ASSERT_EQ(domain.report.removed.size(), 1U);
  EXPECT_EQ(domain.report.removed[0].name, "stray");
  EXPECT_NE(domain.report.removed[0].reason.find("left out"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cad
