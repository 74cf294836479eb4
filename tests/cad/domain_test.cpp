#include "cad/domain/domain.hpp"

#include "tests/cad/model_checks.hpp"
#include "tests/cad/real_files.hpp"

#include <algorithm>
#include <ios>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::cad {
namespace {

struct RealFile {
  const char* file;
  const char* name;
  DomainKind kind;
  const char* unit;
  double reference;  ///< length, in the unit
  int faces;         ///< far field included
};

const RealFile files[] = {
    {"aircraft/gmsh_dlr_f6.brep", "dlr_f6", DomainKind::fluid, "", 1500, 129},
    {"aircraft/gmsh_wing_fuselage.step", "wing_fuselage", DomainKind::body, "m", 0.8, 15},
    {"aircraft/tigl_D150_wing.igs", "d150_wing", DomainKind::body, "mm", 16963.479, 9},
    {"aircraft/pyrefine_cev_capsule.igs", "capsule", DomainKind::body, "cm", 2.000815, 6},
    {"aircraft/gmsh_submarine.stp", "submarine", DomainKind::fluid, "mm", 6122.7264, 12},
    {"aircraft/su2_oneram6.igs", "onera_m6", DomainKind::fluid, "m", 22, 7},
};

Domain prepare(const std::string& file, DomainKind kind = DomainKind::automatic) {
  DomainOptions options;
  options.file = real::file(file);
  options.kind = kind;
  return prepare_domain(options);
}

/// The same for all tests.
const Domain& prepared_once(const std::string& name) {
  static std::map<std::string, Domain> domains;
  const auto found = domains.find(name);
  return found != domains.end() ? found->second : domains.emplace(name, prepare(name)).first->second;
}

class RealFiles : public testing::TestWithParam<RealFile> {
protected:
  void SetUp() override {
    if (!real::has(GetParam().file)) GTEST_SKIP() << "no real geometry here";
  }
};

TEST_P(RealFiles, AreReadDecidedAndSound) {
  const Domain& domain = prepared_once(GetParam().file);
  const Model& model = domain.model;
  EXPECT_EQ(domain.report.kind, GetParam().kind) << domain.report.reason;
  EXPECT_FALSE(domain.report.reason.empty());
  EXPECT_EQ(model.unit_name(), GetParam().unit);
  EXPECT_NEAR(domain.report.reference_length, GetParam().reference, 1e-6 * GetParam().reference);
  EXPECT_EQ(model.face_count(), GetParam().faces);
  EXPECT_EQ(model.region_count(), 1);
  const double diagonal = model.body_bounds().diagonal();
  checks::expect_watertight(model);
  checks::expect_closed_loops(model, 1e-5 * diagonal);
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const double size = model.is_far_field(f) ? model.bounds().diagonal() : diagonal;
    checks::expect_sound_facets(model, f, 1e-3 * size, 0.3, 1e-5 * size);
  }
  EXPECT_GT(checks::facets_volume(model, 1e-3 * diagonal, 0.3), 0);
}

TEST_P(RealFiles, GiveTheSameModelTwice) {
  const Domain &first = prepared_once(GetParam().file), second = prepare(GetParam().file);
  EXPECT_EQ(first.model.serialise(), second.model.serialise());
  const Model rebuilt = Model::from_bytes(first.model.serialise());
  for (FaceId f = 0; f < rebuilt.face_count(); f += 7) {
    const Facets a = first.model.facets(f, rebuilt.bounds().diagonal(), 0.5);
    const Facets b = rebuilt.facets(f, rebuilt.bounds().diagonal(), 0.5);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.triangles, b.triangles);
  }
}

INSTANTIATE_TEST_SUITE_P(, RealFiles, testing::ValuesIn(files),
                         [](const auto& info) { return std::string(info.param.name); });

std::string error_of(const std::string& path) {
  DomainOptions options;
  options.file = path;
  try {
    prepare_domain(options);
  } catch (const CadError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(Domain, RefusesMissingFiles) {
  DomainOptions options;
  options.file = "/nowhere/wing.step";
  EXPECT_THROW(prepare_domain(options), std::ios_base::failure);
}

TEST(Domain, RefusesFilesThatAreNoCad) {
  EXPECT_NE(error_of(real::TemporaryFile("empty.step", "").path()), "no error");
  const real::TemporaryFile blank("blank.igs", "  \n\n"),
      text("text.step", "solid wing\nfacet normal 0 0 1\n");
  const real::TemporaryFile prefixed("prefixed.step", "sISO-10303-21;\nHEADER;\nEND-ISO-10303-21;\n");
  EXPECT_NE(error_of(blank.path()).find("empty"), std::string::npos);
  EXPECT_NE(error_of(text.path()).find("neither STEP, IGES nor BREP"), std::string::npos);
  EXPECT_NE(error_of(prefixed.path()).find("must begin with"), std::string::npos);
}

TEST(Domain, RefusesDamagedFiles) {
  const real::TemporaryFile step("cut.step",
                                 "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=CARTESIAN_POINT('',(0.");
  const real::TemporaryFile hollow(
      "hollow.step",
      "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),"
      "'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\n"
      "END-ISO-10303-21;\n");
  const real::TemporaryFile brep("cut.brep",
                                 "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\n"
                                 "Locations 0\nCurve2ds 12\n1 0 0 1");
  EXPECT_NE(error_of(step.path()).find("ends too early"), std::string::npos);
  EXPECT_NE(error_of(hollow.path()), "no error");
  EXPECT_NE(error_of(brep.path()), "no error");
}

TEST(Domain, RefusesTruncatedRealFiles) {
  for (const char* name : {"aircraft/gmsh_wing_fuselage.step", "aircraft/tigl_D150_wing.igs",
                           "aircraft/gmsh_submarine.stp", "aircraft/gmsh_dlr_f6.brep"}) {
    if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
    const std::string whole = real::read(name);
    const std::string extension = std::filesystem::path(name).extension().string();
    for (const double share : {0.02, 0.5, 0.97}) {
      const real::TemporaryFile cut("cut" + extension,
                                    whole.substr(0, static_cast<std::size_t>(share * whole.size())));
      EXPECT_NE(error_of(cut.path()), "no error") << name << " at " << share;
    }
  }
}

TEST(Domain, RefusesOpenShells) {
  for (const char* name : {"aircraft/dealii_DTMB5415_bulbous_bow.igs", "parts/gmsh_cube_filet.stp"}) {
    if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
    EXPECT_NE(error_of(real::file(name)).find("open edges"), std::string::npos);
  }
}

TEST(Domain, RefusesFarFieldsThatCutTheBody) {
  if (!real::has("aircraft/pyrefine_cev_capsule.igs")) GTEST_SKIP() << "no real geometry here";
  for (const FarFieldShape shape : {FarFieldShape::sphere, FarFieldShape::box}) {
    DomainOptions options;
    options.file = real::file("aircraft/pyrefine_cev_capsule.igs");
    options.far_field = FarFieldOptions{shape, 0.4};
    EXPECT_THROW(prepare_domain(options), CadError);
    options.far_field->extent = 3;
    const Domain domain = prepare_domain(options);
    EXPECT_EQ(domain.report.kind, DomainKind::body);
    const double reference = domain.report.reference_length;
    EXPECT_NEAR(domain.model.bounds().size().y, 6 * reference, 1e-9 * reference);
    const auto& patches = domain.model.patches();
    EXPECT_EQ(std::count(patches.begin(), patches.end(), "farfield"), 1);
  }
}

TEST(Domain, TheFluidIsTheFarFieldWithoutTheBody) {
  for (const char* name : {"aircraft/pyrefine_cev_capsule.igs", "aircraft/tigl_D150_wing.igs"}) {
    if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
    const Model body = prepare(name, DomainKind::fluid).model;
    DomainOptions options;
    options.file = real::file(name);
    options.kind = DomainKind::body;
    options.far_field = FarFieldOptions{FarFieldShape::box, 2};
    const Domain around = prepare_domain(options);
    const double deflection = 1e-3 * body.bounds().diagonal();
    const double inside = checks::facets_volume(body, deflection, 0.3);
    const double outside = checks::facets_volume(around.model, deflection, 0.3);
    const double whole = std::pow(4 * around.report.reference_length, 3);
    EXPECT_GT(inside, 0);
    EXPECT_NEAR(inside + outside, whole, 1e-9 * whole) << name;
  }
}

TEST(Domain, SeparateShellsOfOneSolidBecomeSolids) {
  const char* name = "aircraft/tigl_D150_fused_aircraft_mirrored.brep";
  if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
  const Domain domain = prepare(name);
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  EXPECT_EQ(domain.model.face_count(), 273);
  checks::expect_watertight(domain.model);
  const auto& changes = domain.report.changes;
  EXPECT_TRUE(std::any_of(changes.begin(), changes.end(), [](const Change& change) {
    return change.what.find("2 separate bodies") != std::string::npos;
  }));
}

TEST(Domain, LooseFacesAreSewn) {
  const char* name = "aircraft/dealii_wing.igs";
  if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
  const Domain domain = prepare(name);
  EXPECT_EQ(domain.model.face_count(), 5);
  checks::expect_watertight(domain.model);
}

TEST(Domain, RegionsShareTheirCommonFaces) {
  const char* name = "parts/gmsh_ellipses.brep";
  if (!real::has(name)) GTEST_SKIP() << "no real geometry here";
  const Domain domain = prepare(name, DomainKind::fluid);
  const Model& model = domain.model;
  EXPECT_EQ(model.region_count(), 15);
  std::vector<double> volumes(model.region_count(), 0);
  int shared = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    const Facets facets = model.facets(f, 1e-3 * model.bounds().diagonal(), 0.2);
    const Face& face = model.face(f);
    for (const auto& t : facets.triangles) {
      const double part = dot(facets.points[t[0]], cross(facets.points[t[1]], facets.points[t[2]])) / 6;
      volumes[face.front] += part;
      if (face.back != no_entity) volumes[face.back] -= part;
    }
    shared += face.back != no_entity;
  }
  EXPECT_GT(shared, 0);
  for (const double volume : volumes) EXPECT_GT(volume, 0);
}

TEST(Domain, TouchingBodiesLeaveNoDoubleFace) {
  if (!real::has("aircraft/gmsh_wing_fuselage.step")) GTEST_SKIP() << "no real geometry here";
  const Domain domain = prepare("aircraft/gmsh_wing_fuselage.step");
  for (FaceId f = 0; f < domain.model.face_count(); ++f) {
    double away = 0;
    for (const Vec3 p : domain.model.facets(f, 0.01, 0.5).points) away = std::max(away, std::abs(p.y));
    EXPECT_GT(away, 1e-6) << "face " << f << " lies in the plane between the halves";
  }
}

TEST(Domain, IgnoresLooseCopiesOfASolidsFaces) {
  if (!real::has("parts/gmsh_full_sphere.brep")) GTEST_SKIP() << "no real geometry here";
  const Domain domain = prepare("parts/gmsh_full_sphere.brep", DomainKind::fluid);
  EXPECT_EQ(domain.model.face_count(), 2);
  checks::expect_watertight(domain.model);
}

/// The built-in aircraft.
DomainOptions aircraft() {
  DomainOptions options;
  options.transport = TransportDimensions{};
  return options;
}

/// The same for all tests.
const Domain& prepared_aircraft() {
  static const Domain domain = prepare_domain(aircraft());
  return domain;
}

TEST(Domain, AnAircraftFliesInAFarField) {
  const Domain& domain = prepared_aircraft();
  EXPECT_EQ(domain.report.kind, DomainKind::body);
  EXPECT_NEAR(domain.report.reference_length, 37.6, 0.1);
  checks::expect_watertight(domain.model);
}

TEST(Domain, IsExportedWithItsFarField) {
  const DomainOptions options = aircraft();
  const Domain& direct = prepared_aircraft();
  const real::TemporaryFile step("domain.step", "");
  export_step(options, ExportedShape::domain, step.path());
  DomainOptions again;
  again.file = step.path();
  again.kind = DomainKind::fluid;
  const Domain read = prepare_domain(again);
  EXPECT_EQ(read.model.face_count(), direct.model.face_count());
  EXPECT_NEAR(read.model.bounds().diagonal(), direct.model.bounds().diagonal(),
              1e-6 * direct.model.bounds().diagonal());
}

TEST(Domain, AStepFileBringsBackTheNamesItWasGiven) {
  const DomainOptions options = aircraft();
  const Domain& direct = prepared_aircraft();
  const real::TemporaryFile step("transport.step", "");
  export_step(options, ExportedShape::geometry, step.path());
  DomainOptions again;
  again.file = step.path();
  const Domain read = prepare_domain(again);
  EXPECT_EQ(read.report.kind, DomainKind::body);
  EXPECT_EQ(read.model.unit_name(), "m");
  EXPECT_EQ(read.model.face_count(), direct.model.face_count());
  EXPECT_NEAR(read.report.reference_length, direct.report.reference_length, 1e-6);
  auto names = [](const Domain& domain) {
    std::vector<std::string> sorted = domain.model.patches();
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  EXPECT_EQ(names(read), names(direct));
  EXPECT_GT(names(read).size(), 3u);
}

}  // namespace
}  // namespace aeroloom::cad
