#include "cad/domain/domain.hpp"
#include "model_checks.hpp"

#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

using namespace aeroloom::cad;

namespace {

/// The aircraft itself as a region.
Model make_aircraft(const TransportDimensions& dimensions) {
  DomainOptions options;
  options.transport = dimensions;
  options.kind = DomainKind::fluid;
  return prepare_domain(options).model;
}

const Model& default_aircraft() {
  static const Model model = make_aircraft({});
  return model;
}

std::map<std::string, double> areas_by_name(const Model& model) {
  std::map<std::string, double> areas;
  for (FaceId f = 0; f < model.face_count(); ++f) areas[model.face(f).name] += model.face_area(f);
  return areas;
}

double edge_length(const Model& model, EdgeId id) {
  const Edge& edge = model.edge(id);
  double length = 0;
  Vec3 last = model.edge_point(id, edge.first_parameter);
  for (int i = 1; i <= 50; ++i) {
    const double t = edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / 50;
    const Vec3 next = model.edge_point(id, t);
    length += distance(last, next);
    last = next;
  }
  return length;
}

double shortest_edge(const Model& model) {
  double shortest = 1e300;
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    if (!model.edge(e).degenerate) shortest = std::min(shortest, edge_length(model, e));
  }
  return shortest;
}

void expect_sound(const Model& model) {
  EXPECT_EQ(model.region_count(), 1);
  checks::expect_watertight(model);
  checks::expect_closed_loops(model, 1e-4);
  for (FaceId f = 0; f < model.face_count(); ++f) checks::expect_sound_facets(model, f, 0.05, 0.4, 1e-3);
}

/// What building these dimensions complains about; empty when it does not.
std::string complaint(const TransportDimensions& dimensions) {
  try {
    make_aircraft(dimensions);
  } catch (const CadError& error) {
    return error.what();
  }
  return "";
}

void expect_complaint(const TransportDimensions& dimensions, const std::string& dimension) {
  EXPECT_NE(complaint(dimensions).find(dimension), std::string::npos) << complaint(dimensions);
}

}  // namespace

TEST(Transport, IsOneSoundBody) {
  expect_sound(default_aircraft());
}

TEST(Transport, HasTheDimensionsAskedFor) {
  const TransportDimensions d;
  const Model& model = default_aircraft();
  const Box& box = model.bounds();
  EXPECT_NEAR(box.low.x, 0, 1e-3);
  EXPECT_NEAR(box.high.x, d.fuselage_length, 0.05);
  EXPECT_NEAR(box.low.y, -d.wing.half_span, 1e-3);
  EXPECT_NEAR(box.high.y, d.wing.half_span, 1e-3);
  EXPECT_NEAR(box.high.z, d.vertical_tail.z + d.vertical_tail.half_span, 1e-3);
  EXPECT_NEAR(box.low.z, -0.5 * d.fuselage_diameter, 0.01);
  EXPECT_EQ(model.unit_name(), "m");
  // A cylinder with an ellipsoidal nose and a tail that tapers; the wings add what lies outside it.
  const double section = 0.25 * 3.14159265 * d.fuselage_diameter * d.fuselage_diameter;
  const double cabin = d.fuselage_length - d.nose_length - d.tail_length;
  const double volume = checks::facets_volume(model, 0.02, 0.3);
  EXPECT_GT(volume, section * (cabin + 0.6 * d.nose_length + 0.4 * d.tail_length));
  EXPECT_LT(volume, section * (cabin + 0.7 * d.nose_length + 0.7 * d.tail_length) + 45);
}

TEST(Transport, NamesEveryFace) {
  std::set<std::string> expected{"fuselage", "vertical_tail_right", "vertical_tail_left",
                                 "vertical_tail_trailing_edge", "vertical_tail_tip"};
  for (const char* part : {"wing_right", "wing_left", "horizontal_tail_right", "horizontal_tail_left"}) {
    for (const char* face : {"_upper", "_lower", "_trailing_edge", "_tip"})
      expected.insert(std::string(part) + face);
  }
  std::set<std::string> found;
  for (const auto& [name, area] : areas_by_name(default_aircraft())) found.insert(name);
  EXPECT_EQ(found, expected);
}

TEST(Transport, IsSymmetric) {
  const Model& model = default_aircraft();
  const auto areas = areas_by_name(model);
  for (const auto& [name, area] : areas) {
    std::string other = name;
    if (const auto at = name.find("right"); at != std::string::npos) other.replace(at, 5, "left");
    EXPECT_NEAR(area, areas.at(other), 1e-6 * area) << name;
  }
  EXPECT_NEAR(model.bounds().low.y, -model.bounds().high.y, 1e-6);
  for (VertexId v = 0; v < model.vertex_count(); ++v) {
    const Vec3 p = model.vertex(v), reflected{p.x, -p.y, p.z};
    double nearest = 1e300;
    for (VertexId w = 0; w < model.vertex_count(); ++w)
      nearest = std::min(nearest, distance(reflected, model.vertex(w)));
    EXPECT_LT(nearest, 1e-4);
  }
}

TEST(Transport, HasNoTinyEdges) {
  EXPECT_GT(shortest_edge(default_aircraft()), 0.019);
}

TEST(Transport, IsSmoothAcrossLeadingEdgesAndFuselageLines) {
  const Model& model = default_aircraft();
  int smooth = 0;
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    const Edge& edge = model.edge(e);
    if (edge.degenerate || edge.faces.size() != 2) continue;
    const std::string& a = model.face(edge.faces[0]).name;
    const std::string& b = model.face(edge.faces[1]).name;
    const bool leading = (a == "wing_right_upper" && b == "wing_right_lower") ||
                         (b == "wing_right_upper" && a == "wing_right_lower") ||
                         (a == "vertical_tail_right" && b == "vertical_tail_left");
    if (!leading && !(a == "fuselage" && b == "fuselage")) continue;
    ++smooth;
    const double t = 0.5 * (edge.first_parameter + edge.last_parameter);
    const auto normal = [&](FaceId f) {
      for (const auto& loop : model.face(f).loops) {
        for (const Coedge& use : loop) {
          if (use.edge == e) return model.face_frame(f, model.edge_uv(f, use, t)).normal;
        }
      }
      return Vec3{};
    };
    EXPECT_GT(dot(normal(edge.faces[0]), normal(edge.faces[1])), 0.9999) << a << " " << b;
  }
  EXPECT_GT(smooth, 15);
}

TEST(Transport, OtherShapesAreSound) {
  TransportDimensions glider;
  glider.fuselage_length = 24;
  glider.fuselage_diameter = 2.2;
  glider.nose_length = 3;
  glider.tail_length = 9;
  glider.tail_upsweep = 0.3;
  glider.wing = {2.6, 0.5, 14, 3, 3, 0.15, 0.03, 2, 0, 8, -0.3, 0.01};
  glider.horizontal_tail = {1.5, 0.6, 3.2, 8, 0, 0.09, 0, 0, 0, 19.2, 0.3, 0.015};
  glider.vertical_tail = {2.1, 0.5, 2.8, 35, 0, 0.1, 0, 0, 0, 18.8, 0.4, 0.015};
  expect_sound(make_aircraft(glider));

  TransportDimensions sharp;
  sharp.wing.trailing_edge = sharp.horizontal_tail.trailing_edge = sharp.vertical_tail.trailing_edge = 0;
  const Model model = make_aircraft(sharp);
  expect_sound(model);
  for (const auto& [name, area] : areas_by_name(model)) EXPECT_EQ(name.find("trailing"), std::string::npos);
}

TEST(Transport, NamesTheDimensionThatIsWrong) {
  const auto with = [](auto change) {
    TransportDimensions d;
    change(d);
    return d;
  };
  expect_complaint(with([](auto& d) { d.fuselage_diameter = -1; }), "fuselage_diameter");
  expect_complaint(with([](auto& d) { d.fuselage_length = 20; }), "fuselage_length");
  expect_complaint(with([](auto& d) { d.wing.taper = 1.5; }), "wing.taper");
  expect_complaint(with([](auto& d) { d.wing.root_chord = 0; }), "wing.root_chord");
  expect_complaint(with([](auto& d) { d.wing.z = 4; }), "wing.z");
  expect_complaint(with([](auto& d) { d.wing.x = 40; }), "wing.x");
  expect_complaint(with([](auto& d) { d.wing.half_span = 1; }), "wing.half_span");
  expect_complaint(with([](auto& d) { d.horizontal_tail.trailing_edge = -0.1; }),
                   "horizontal_tail.trailing_edge");
  expect_complaint(with([](auto& d) { d.vertical_tail.dihedral = 5; }), "vertical_tail.dihedral");
  expect_complaint(with([](auto& d) { d.vertical_tail.thickness = std::nan(""); }),
                   "vertical_tail.thickness");
}
