#include "sizing/sources/size_requests.hpp"
#include "tests/pipeline/case/case_fixture.hpp"

namespace aeroloom::cases {
namespace {

TEST_F(CaseTest, GeometryAloneGivesThePreset) {
  const Case input = read("geometry: {file: wing.step}\n");
  EXPECT_EQ(input.domain.file, "wing.step");
  EXPECT_FALSE(input.domain.transport);
  EXPECT_FALSE(input.domain.far_field);
  EXPECT_EQ(input.domain.kind, cad::DomainKind::automatic);
  EXPECT_FALSE(input.sizing.minimum || input.sizing.maximum || input.sizing.surface_maximum);
  EXPECT_FALSE(input.sizing.curvature_angle || input.sizing.growth);
  EXPECT_EQ(input.surface.piece_triangles, 10'000);
  EXPECT_FALSE(input.volume.piece_tets);
  EXPECT_EQ(input.surface.decomposition, surface::SurfaceDecomposition::pieces);
  EXPECT_TRUE(input.improve.enabled);
  EXPECT_EQ(input.output.directory, "out");
}

const char* const every_key = R"(
geometry:
  builtin: transport
  dimensions:
    fuselage_length: 40
    fuselage_diameter: 4.5
    nose_length: 7
    tail_length: 13
    tail_upsweep: 0.5
    wing: {root_chord: 7, taper: 0.3, half_span: 18, sweep: 25, dihedral: 5, thickness: 0.13, camber: 0.02,
           root_incidence: 1, tip_incidence: -2, x: 13, z: -1, trailing_edge: 0.003}
    horizontal_tail: {half_span: 7}
    vertical_tail: {sweep: 40.5}
  domain: body
  narrow_faces: keep
  trailing_edges: sharpen
  sharpen_faces: ['wing*', fin_te]
  sharpen_width: 0.02
farfield: {shape: box, extent: 12.5}
sizing: {minimum: 0.01, maximum: 1.5, surface_maximum: 0.5, curvature_angle: 15, growth: 1.2, target_tetrahedra: 2e6,
         feature_minimum: 0.002, chordal_deviation: 1e-4}
surface: {piece_triangles: 1000, decomposition: faces}
volume: {piece_tets: 3e5, lattice_clearance: 0.5, perturbation: 0.008, halo: 2}
improve: {enabled: false, target_angle: 18, sweeps: 3}
output: {directory: out/a, log: verbose}
)";

TEST_F(CaseTest, ReadsEveryKeyOfTheGeometry) {
  const Case input = read(every_key);
  ASSERT_TRUE(input.domain.transport);
  const cad::TransportDimensions& d = *input.domain.transport;
  EXPECT_EQ(d.fuselage_length, 40);
  EXPECT_EQ(d.fuselage_diameter, 4.5);
  EXPECT_EQ(d.nose_length, 7);
  EXPECT_EQ(d.tail_length, 13);
  EXPECT_EQ(d.tail_upsweep, 0.5);
  EXPECT_EQ(d.wing.root_chord, 7);
  EXPECT_EQ(d.wing.taper, 0.3);
  EXPECT_EQ(d.wing.half_span, 18);
  EXPECT_EQ(d.wing.sweep, 25);
  EXPECT_EQ(d.wing.dihedral, 5);
  EXPECT_EQ(d.wing.thickness, 0.13);
  EXPECT_EQ(d.wing.camber, 0.02);
  EXPECT_EQ(d.wing.root_incidence, 1);
  EXPECT_EQ(d.wing.tip_incidence, -2);
  EXPECT_EQ(d.wing.x, 13);
  EXPECT_EQ(d.wing.z, -1);
  EXPECT_EQ(d.wing.trailing_edge, 0.003);
  EXPECT_EQ(d.horizontal_tail.half_span, 7);
  EXPECT_EQ(d.horizontal_tail.root_chord, cad::TransportDimensions{}.horizontal_tail.root_chord);
  EXPECT_EQ(d.vertical_tail.sweep, 40.5);
  EXPECT_EQ(input.domain.kind, cad::DomainKind::body);
  ASSERT_TRUE(input.domain.far_field);
  EXPECT_EQ(input.domain.far_field->shape, cad::FarFieldShape::box);
  EXPECT_EQ(input.domain.far_field->extent, 12.5);
  EXPECT_EQ(input.narrow_faces, NarrowFaces::keep);
  const cad::TrailingEdgeOptions& trailing = input.domain.trailing_edges;
  EXPECT_EQ(trailing.treatment, cad::TrailingEdges::sharpen);
  EXPECT_EQ(trailing.faces, (std::vector<std::string>{"wing*", "fin_te"}));
  EXPECT_EQ(trailing.width, 0.02);
  EXPECT_EQ(resolved_yaml(read(resolved_yaml(input))), resolved_yaml(input));
}

TEST_F(CaseTest, SharpeningIsAskedForAsAWhole) {
  const auto faces = [&](const std::string& value) {
    return read(transport, {"geometry.trailing_edges=sharpen", "geometry.sharpen_faces=" + value})
        .domain.trailing_edges.faces;
  };
  EXPECT_EQ(faces("[a*, b]"), (std::vector<std::string>{"a*", "b"}));
  EXPECT_EQ(faces("wing*"), std::vector<std::string>{"wing*"});
  EXPECT_EQ(
      error_of(transport, {"geometry.trailing_edges=sharpen", "geometry.sharpen_faces=[]"}),
      "--set geometry.sharpen_faces=[]: 'geometry.sharpen_faces': expected a list of texts, got a list");
  EXPECT_EQ(
      error_of(transport, {"geometry.sharpen_width=0.1"}),
      "--set geometry.sharpen_width=0.1: 'geometry.sharpen_width' needs 'geometry.trailing_edges: sharpen'");
  EXPECT_NE(error_of(transport, {"geometry.trailing_edges=close"}).find("keep, sharpen"), std::string::npos);
}

TEST_F(CaseTest, ReadsEveryKeyOfTheStages) {
  const Case input = read(every_key);
  EXPECT_EQ(input.sizing.minimum, 0.01);
  EXPECT_EQ(input.sizing.maximum, 1.5);
  EXPECT_EQ(input.sizing.surface_maximum, 0.5);
  EXPECT_EQ(input.sizing.curvature_angle, 15);
  EXPECT_EQ(input.sizing.growth, 1.2);
  EXPECT_EQ(input.sizing.target_tetrahedra, 2e6);
  EXPECT_EQ(input.sizing.feature_minimum, 0.002);
  EXPECT_EQ(input.sizing.chordal_deviation, 1e-4);
  EXPECT_EQ(input.surface.piece_triangles, 1000);
  EXPECT_EQ(input.surface.decomposition, surface::SurfaceDecomposition::faces);
  EXPECT_EQ(input.volume.piece_tets, 300'000);
  EXPECT_EQ(input.volume.lattice_clearance, 0.5);
  EXPECT_EQ(input.volume.perturbation, 0.008);
  EXPECT_EQ(input.volume.halo, 2);
  EXPECT_FALSE(input.improve.enabled);
  EXPECT_EQ(input.improve.target_angle, 18);
  EXPECT_EQ(input.improve.sweeps, 3);
  EXPECT_EQ(input.output.directory, "out/a");
  EXPECT_EQ(input.output.log, parallel::LogLevel::verbose);
}

TEST_F(CaseTest, ResolvedCaseReadsBackTheSame) {
  for (const std::string& yaml :
       {std::string("geometry: {file: 'a b: #c.step', domain: fluid}\n"),
        std::string(
            "geometry: {builtin: transport, dimensions: {wing: {sweep: 0.1}}}\nfarfield: {extent: 3}\n"
            "sizing: {minimum: 1e-7, growth: 1.1}\nimprove: {enabled: false}\nvolume: {perturbation: "
            "0.004}\n")}) {
    const std::string resolved = resolved_yaml(read(yaml));
    EXPECT_EQ(resolved_yaml(read(resolved)), resolved);
    EXPECT_EQ(resolved_yaml(case_of_resolved(resolved)), resolved);
    EXPECT_NE(resolved.find("halo: 1.2"), std::string::npos) << resolved;
    EXPECT_EQ(resolved.find("piece_tets"), std::string::npos) << resolved;
  }
  const std::string resolved = resolved_yaml(read(transport + "sizing: {minimum: 0.1}\n"));
  EXPECT_NE(resolved.find("minimum: 0.1\n"), std::string::npos) << resolved;
  EXPECT_EQ(resolved.find("maximum"), std::string::npos) << resolved;
  EXPECT_NE(resolved.find("half_span: 17\n"), std::string::npos) << resolved;
}

TEST_F(CaseTest, UnknownKeysNameTheNearest) {
  EXPECT_EQ(error_of(transport + "sizng: {minimum: 1}\n"),
            "case.yaml:2:1: unknown key 'sizng'; did you mean 'sizing'?");
  EXPECT_EQ(error_of(transport + "sizing:\n  growht: 1.2\n"),
            "case.yaml:3:3: unknown key 'growht' in 'sizing'; did you mean 'growth'?");
  EXPECT_EQ(error_of(transport + "sizing: {min: 1}\n"),
            "case.yaml:2:10: unknown key 'min' in 'sizing'; did you mean 'minimum'?");
  EXPECT_EQ(
      error_of("geometry: {builtin: transport, dimensions: {wing: {chord_root: 1, swep: 1}}}\n"),
      "case.yaml:1:52: unknown key 'chord_root' in 'geometry.dimensions.wing'; valid keys: root_chord, "
      "taper, "
      "half_span, sweep, dihedral, thickness, camber, root_incidence, tip_incidence, x, z, trailing_edge");
}

TEST_F(CaseTest, UnknownKeysOfAnotherSectionNameIt) {
  EXPECT_EQ(error_of(transport + "minimum: 1\n"),
            "case.yaml:2:1: unknown key 'minimum'; did you mean 'sizing.minimum'?");
  EXPECT_EQ(error_of(transport + "surface: {piece_tets: 5}\n"),
            "case.yaml:2:11: unknown key 'piece_tets' in 'surface'; did you mean 'volume.piece_tets'?");
}

TEST_F(CaseTest, UnknownKeysWithNothingNearListTheValidOnes) {
  EXPECT_EQ(error_of(transport + "output: {quux: 1}\n"),
            "case.yaml:2:10: unknown key 'quux' in 'output'; valid keys: directory, formats, parts, tasks, "
            "compression, checkpoints, pictures, log");
}

TEST_F(CaseTest, KeysLikeNoneListThoseOfTheSection) {
  EXPECT_EQ(error_of(transport + "volume: {interface_angel: 45}\n"),
            "case.yaml:2:10: unknown key 'interface_angel' in 'volume'; valid keys: piece_tets, "
            "lattice_clearance, perturbation, halo");
}

TEST_F(CaseTest, WrongTypes) {
  EXPECT_EQ(error_of(transport + "sizing: {minimum: abc}\n"),
            "case.yaml:2:19: 'sizing.minimum': expected a number, got 'abc'");
  EXPECT_EQ(error_of(transport + "sizing: {minimum: 10 mm}\n"),
            "case.yaml:2:19: 'sizing.minimum': expected a number, got '10 mm'");
  EXPECT_EQ(error_of(transport + "sizing: {minimum: .inf}\n"),
            "case.yaml:2:19: 'sizing.minimum': expected a number, got '.inf'");
  EXPECT_EQ(error_of(transport + "sizing: {minimum: nan}\n"),
            "case.yaml:2:19: 'sizing.minimum': expected a number, got 'nan'");
  EXPECT_EQ(error_of(transport + "sizing: {minimum: [1, 2]}\n"),
            "case.yaml:2:19: 'sizing.minimum': expected a number, got a list");
  EXPECT_EQ(error_of(transport + "sizing:\n  minimum:\n"),
            "case.yaml:3:3: 'sizing.minimum': expected a number, got nothing");
  EXPECT_EQ(error_of(transport + "sizing: 5\n"), "case.yaml:2:9: expected keys below 'sizing', got '5'");
  EXPECT_EQ(error_of(transport + "improve: {enabled: maybe}\n"),
            "case.yaml:2:20: 'improve.enabled': expected true or false, got 'maybe'");
  EXPECT_EQ(error_of(transport + "improve: {sweeps: 2.5}\n"),
            "case.yaml:2:19: 'improve.sweeps': expected a whole number, got '2.5'");
  EXPECT_EQ(
      error_of(transport + "farfield: {shape: cube}\n"),
      "case.yaml:2:19: 'farfield.shape': expected one of sphere, box, hemisphere, cylinder, got 'cube'");
  EXPECT_EQ(error_of(transport + "output: {directory: ''}\n"),
            "case.yaml:2:21: 'output.directory': expected a text, got ''");
  EXPECT_EQ(error_of("- a\n- b\n"), "case.yaml:1:1: expected keys, got a list");
  EXPECT_EQ(error_of("geometry: {? [a] : b}\n"), "case.yaml:1:14: expected a key, got a list");
}

TEST_F(CaseTest, ValuesOutOfRangeNameTheRange) {
  EXPECT_EQ(error_of(transport + "sizing: {minimum: 0}\n"),
            "case.yaml:2:19: 'sizing.minimum' is 0, but must be above 0 (length unit of the geometry)");
  EXPECT_EQ(error_of(transport + "sizing: {growth: 1}\n"),
            "case.yaml:2:18: 'sizing.growth' is 1, but must be at least 1.01 and at most 3");
  EXPECT_EQ(error_of(transport + "sizing: {curvature_angle: 120}\n"),
            "case.yaml:2:27: 'sizing.curvature_angle' is 120, but must be at least 0.1 and at most 90 "
            "degrees per element");
  EXPECT_EQ(error_of(transport + "farfield: {extent: -1}\n"),
            "case.yaml:2:20: 'farfield.extent' is -1, but must be above 0");
  EXPECT_EQ(
      error_of(transport + "volume: {piece_tets: 1e300}\n"),
      "case.yaml:2:22: 'volume.piece_tets' is 1e300, but must be at least 100 and at most 1e9 elements");
  EXPECT_EQ(
      error_of(transport + "volume: {perturbation: 0.1}\n"),
      "case.yaml:2:24: 'volume.perturbation' is 0.1, but must be at least 0 and at most 0.01 mean edges of "
      "the lattice");
  EXPECT_EQ(
      error_of(transport + "volume: {halo: 0}\n"),
      "case.yaml:2:16: 'volume.halo' is 0, but must be at least 0.5 and at most 5 largest sizes nearby");
  EXPECT_EQ(error_of("geometry: {builtin: transport, dimensions: {wing: {taper: 1.5}}}\n"),
            "case.yaml:1:59: 'geometry.dimensions.wing.taper' is 1.5, but must be above 0 and at most 1");
  EXPECT_EQ(error_of(transport + "sizing: {growth: 3, curvature_angle: 0.1}\n"), "no error");
}

TEST_F(CaseTest, SizesMustBeInOrder) {
  EXPECT_EQ(error_of(transport + "sizing:\n  minimum: 2\n  maximum: 1\n"),
            "case.yaml:4:3: 'sizing.maximum' is 1, but must be at least 'sizing.minimum', which is 2 "
            "(case.yaml:3:3)");
  EXPECT_EQ(error_of(transport + "sizing: {maximum: 1}\n", {"sizing.minimum=2"}),
            "case.yaml:2:10: 'sizing.maximum' is 1, but must be at least 'sizing.minimum', which is 2 "
            "(--set sizing.minimum=2)");
  EXPECT_EQ(error_of(transport + "sizing: {minimum: 1, maximum: 1}\n"), "no error");
}

TEST_F(CaseTest, DuplicateKeys) {
  EXPECT_EQ(error_of(transport + "sizing:\n  minimum: 1\n  minimum: 2\n"),
            "case.yaml:4:3: key 'sizing.minimum' is given twice");
  EXPECT_EQ(error_of(transport + transport), "case.yaml:2:1: key 'geometry' is given twice");
}

TEST_F(CaseTest, NeedsExactlyOneGeometry) {
  const std::string none = "case.yaml: the case has no geometry; give 'geometry.file' or 'geometry.builtin'";
  EXPECT_EQ(error_of(""), none);
  EXPECT_EQ(error_of("geometry:\n"), none);
  EXPECT_EQ(error_of("sizing: {minimum: 1}\n"), none);
  EXPECT_EQ(error_of("geometry:\n  file: a.step\n  builtin: transport\n"),
            "case.yaml:3:3: 'geometry.file' and 'geometry.builtin' exclude each other");
  EXPECT_EQ(error_of("geometry: {file: a.step, dimensions: {nose_length: 1}}\n"),
            "case.yaml:1:26: 'geometry.dimensions' belongs to 'geometry.builtin', not to a file");
}

TEST_F(CaseTest, AFluidHasNoFarField) {
  EXPECT_EQ(error_of("geometry: {file: a.step, domain: fluid}\nfarfield: {extent: 5}\n"),
            "case.yaml:2:1: 'farfield' surrounds bodies, but 'geometry.domain' is fluid");
  EXPECT_EQ(error_of("geometry: {builtin: transport, domain: fluid}\n"),
            "case.yaml:1:32: the built-in geometry is a body, 'geometry.domain' cannot be fluid");
}

TEST_F(CaseTest, EmptySectionsAreAsIfTheyWereNotThere) {
  const std::string file = "geometry:\n  file: a.step\n  dimensions:\n    wing:\n  domain: fluid\n";
  EXPECT_EQ(error_of(file + "farfield:\npatches:\nsizing:\nimprove:\n  gate:\n"), "no error");
  EXPECT_EQ(resolved_yaml(read(file + "farfield:\n")), resolved_yaml(read(file)));
  EXPECT_NE(error_of(file + "farfield: {}\n"), "no error");
  EXPECT_TRUE(read("geometry: {file: a.step}\nfarfield: {}\n").domain.far_field);
}

TEST_F(CaseTest, SyntaxErrorsHaveTheirPlace) {
  EXPECT_EQ(error_of("geometry: {file: a.step\nsizing: [").rfind("case.yaml:2:", 0), 0u)
      << error_of("geometry: {file: a.step\nsizing: [");
  EXPECT_NE(error_of("geometry:\n\tfile: a\n").find("not valid YAML"), std::string::npos);
  EXPECT_EQ(error_of(transport + "---\n" + transport), "case.yaml: several YAML documents, one is expected");
}

TEST_F(CaseTest, UnreadableFiles) {
  EXPECT_THROW(read_case((folder / "absent.yaml").string(), {}), CaseError);
  EXPECT_THROW(read_case(folder.string(), {}), CaseError);
}

TEST_F(CaseTest, OverridesReplaceAndAdd) {
  const Case input =
      read(transport + "sizing: {minimum: 0.5, growth: 1.4}\n",
           {"sizing.minimum=0.25", "sizing.minimum=0.125", "output.directory=a=b", "improve.enabled=false",
            "geometry.dimensions.wing.sweep=10", "farfield={shape: box, extent: 4}"});
  EXPECT_EQ(input.sizing.minimum, 0.125);
  EXPECT_EQ(input.sizing.growth, 1.4);
  EXPECT_EQ(input.output.directory, "a=b");
  EXPECT_FALSE(input.improve.enabled);
  EXPECT_EQ(input.domain.transport->wing.sweep, 10);
  EXPECT_EQ(input.domain.far_field->extent, 4);
}

TEST_F(CaseTest, OverrideErrorsQuoteTheOverride) {
  const auto error = [&](const std::string& assignment) { return error_of(transport, {assignment}); };
  EXPECT_EQ(
      error("sizing.minimum=0"),
      "--set sizing.minimum=0: 'sizing.minimum' is 0, but must be above 0 (length unit of the geometry)");
  EXPECT_EQ(error("sizng.minimum=1"), "--set sizng.minimum=1: unknown key 'sizng'; did you mean 'sizing'?");
  EXPECT_EQ(error("sizing.minimum"), "--set sizing.minimum: expected section.key=value");
  EXPECT_EQ(error("=1"), "--set =1: expected section.key=value");
  EXPECT_EQ(error("sizing..minimum=1"),
            "--set sizing..minimum=1: expected section.key=value, found an empty name");
  EXPECT_EQ(error("sizing.=1"), "--set sizing.=1: expected section.key=value, found an empty name");
  EXPECT_EQ(error("sizing.minimum="),
            "--set sizing.minimum=: 'sizing.minimum': expected a number, got nothing");
  EXPECT_EQ(error("sizing.minimum.x=1"),
            "--set sizing.minimum.x=1: 'sizing.minimum': expected a number, got a map of keys");
  EXPECT_EQ(error("sizing=1"), "--set sizing=1: expected keys below 'sizing', got '1'");
  EXPECT_EQ(error("sizing.minimum=[").rfind("--set sizing.minimum=[: not valid YAML", 0), 0u);
  EXPECT_EQ(error("geometry.file=a.step"),
            "case.yaml:1:12: 'geometry.file' and 'geometry.builtin' exclude each other");
}

TEST_F(CaseTest, FilesAreSoughtBesideTheCaseToo) {
  write("", "sub/wing.step");
  const std::string file = write("geometry: {file: wing.step}\n", "sub/case.yaml");
  EXPECT_EQ(read_case(file, {}).domain.file, (folder / "sub/wing.step").string());
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  write("", "wing.step");
  const std::string found = read_case("sub/case.yaml", {}).domain.file;
  fs::current_path(before);
  EXPECT_EQ(found, "sub/wing.step");  // not another one that happens to be called the same
  EXPECT_EQ(read_case(file, {"geometry.file=absent.step"}).domain.file, "absent.step");
  const std::string absolute = (folder / "sub/wing.step").string();
  EXPECT_EQ(read_case(file, {"geometry.file=" + absolute}).domain.file, absolute);
}

TEST_F(CaseTest, PathsMayNameEnvironmentVariables) {
  ::setenv("AEROLOOM_TEST_FOLDER", folder.c_str(), 1);
  write("", "wing.step");
  const Case input = read(
      "geometry: {file: '${AEROLOOM_TEST_FOLDER}/wing.step'}\noutput: {directory: "
      "'a/${AEROLOOM_TEST_FOLDER}'}\n");
  EXPECT_EQ(input.domain.file, (folder / "wing.step").string());
  EXPECT_EQ(input.output.directory, "a/" + folder.string());
  ::unsetenv("AEROLOOM_TEST_FOLDER");
  const std::string unset =
      "'geometry.file' names the environment variable 'AEROLOOM_TEST_FOLDER', which is not set. Remedy: "
      "export "
      "AEROLOOM_TEST_FOLDER=..., or a path without it";
  EXPECT_NE(error_of("geometry: {file: '${AEROLOOM_TEST_FOLDER}/wing.step'}\n").find(unset),
            std::string::npos);
  EXPECT_NE(error_of("geometry: {file: '${A/wing.step'}\n").find("each '${' has its '}'"), std::string::npos);
  EXPECT_NE(error_of("geometry: {file: 'a${}b'}\n").find("the environment variable ''"), std::string::npos);
}

TEST_F(CaseTest, SourcesComeBack) {
  const Case input = read(
      "geometry: {file: a.step}\nsizing:\n  sources:\n"
      "    wake: {shape: cone, from: [1, 2, 3], to: [4, 5.5, -6], radius: 1, end_radius: 2, size: 0.1}\n"
      "    spot: {shape: point, center: [0, 1, 0], size: 0.2}\n"
      "patches: {wing: {size: 0.05}}\n");
  ASSERT_EQ(input.sizing.sources.size(), 2u);
  EXPECT_EQ(input.sizing.sources[0].name, "wake");
  const auto& wake = std::get<sizing::ConeShape>(input.sizing.sources[0].shape);
  EXPECT_EQ(wake.to.y, 5.5);
  EXPECT_EQ(wake.end_radius, 2);
  ASSERT_EQ(input.sizing.patch_sizes.size(), 1u);
  EXPECT_EQ(input.sizing.patch_sizes[0].patch, "wing");
  const Case again = case_of_resolved(resolved_yaml(input));
  ASSERT_EQ(again.sizing.sources.size(), 2u);
  EXPECT_EQ(again.sizing.sources[1].name, "spot");
  EXPECT_EQ(again.sizing.sources[1].size, 0.2);
  EXPECT_EQ(std::get<sizing::ConeShape>(again.sizing.sources[0].shape).to.z, -6);
  EXPECT_EQ(again.sizing.patch_sizes[0].size, 0.05);
}

TEST_F(CaseTest, SourcesHaveWhatTheirShapeNeeds) {
  const auto refused = [&](const std::string& source) {
    return error_of("geometry: {file: a.step}\nsizing: {sources: {a: " + source + "}}\n");
  };
  EXPECT_NE(refused("{shape: sphere, center: [0, 0, 0], size: 1}")
                .find("'sizing.sources.a' is a sphere: it needs 'radius'"),
            std::string::npos);
  EXPECT_NE(refused("{shape: point, center: [0, 0, 0], to: [1, 1, 1], size: 1}").find("it has no 'to'"),
            std::string::npos);
  EXPECT_NE(refused("{center: [0, 0, 0], size: 1}").find("'sizing.sources.a' needs 'shape'"),
            std::string::npos);
  EXPECT_NE(refused("{shape: point, center: [0, 0, 0]}").find("it needs 'size'"), std::string::npos);
  EXPECT_NE(refused("{shape: point, center: [0, 0], size: 1}").find("three numbers"), std::string::npos);
  EXPECT_NE(refused("{shape: point, centre: [0, 0, 0], size: 1}").find("center"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::cases
