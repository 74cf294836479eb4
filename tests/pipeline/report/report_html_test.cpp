// The page of a report: whatever is in report.json, it is a page, complete in itself and below its limit.
#include "pipeline/report/html.hpp"
#include "pipeline/report/page/html_text.hpp"
#include "pipeline/report/report_json.hpp"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::report {
namespace {

namespace html = page;
using html::Json;
using layers::PatchLayers;

constexpr const char* hostile = "</td></table></style><script>alert(1)</script><a href='http://x'>&\"\x01";
constexpr std::size_t limit = 5'000'000;

mesh::Distribution distribution(double least, double most) {
  mesh::Distribution of{
      least, most, (least + most) / 2, least, least, least, {0, most * 1.1, {0, 3, 50, 1000000}}};
  return of;
}

/// A run that has something of everything.
RunRecord rich_record() {
  RunRecord record;
  record.input_hash = "00ff";
  record.resumed = {"surface"};
  record.unit = "m";
  record.faces = 2;
  record.edges = 3;
  record.bounds.add(geometry::Vec3{0, 0, 0});
  record.bounds.add(geometry::Vec3{1, 1, 1});
  record.face_names = {"nose", "tail"};
  record.domain.changes = {{"sewn", geometry::Vec3{1, 2, 3}, 1e-5}};
  record.findings.joined.changes = {{"joined", std::nullopt, 0.25}};
  record.sizes.maximum = 2;
  record.surface.triangles = 120;
  record.surface.sharp_corners = {{0, {1, 2, 3}, 12.5}};
  record.volume.retries = {{3, "a wider halo", "it crashed"}};
  record.counts = {1'384'540, 300'000, 120};
  record.mesh_volume = 53156962.9;
  record.hash = "0123456789abcdef0123456789abcdef";
  record.quality = mesh::QualitySummary{distribution(3.5, 70),
                                        distribution(71, 150),
                                        distribution(0.2, 1),
                                        distribution(0.1, 1),
                                        {{3.5, 17, {1, 2, 3}}}};
  record.pinned.entities.resize(1);
  record.pinned.entities[0].faces = {0, 1};
  record.pinned.entities[0].tetrahedra = 7;
  record.pinned.features.resize(1);
  record.pinned.features[0].face = 1;
  record.patches = {{"wing", mesh::PatchType::wall, 10, 10.1, 60, false}};
  LayerRecord& layers = record.layers.emplace();
  layers.asked.patches = {{2.5e-4, 1.2, 2, 30, 0}};
  layers.boundary_layer = 0.5;
  layers.report.patches.resize(1);
  PatchLayers& on_wing = layers.report.patches[0];
  on_wing.area = 10, on_wing.full_area = 7, on_wing.partial_area = 2, on_wing.empty_area = 1;
  on_wing.limited_area[static_cast<std::size_t>(layers::LayerLimit::gap)] = 1;
  on_wing.limited_area[static_cast<std::size_t>(layers::LayerLimit::validity)] = 2;
  on_wing.sums = {255, 300, 6.25, 3, 4.2};
  on_wing.most_layers = 30;
  record.regions_filled = {{"fluid", 53156962.9, 1'384'540}};
  record.wall_seconds = 7.4;
  return record;
}

ReportFacts facts(int ranks = 2) {
  ReportFacts facts;
  facts.outcome = {ExitCode::volume, "volume", "it crashed"};
  facts.subject.case_file = "cases/wing.yaml";
  facts.ranks = ranks;
  parallel::StageSummary stage;
  stage.name = "surface";
  stage.wall_seconds = 7;
  stage.cpu_seconds_max = 5;
  stage.cpu_seconds_mean = 4;
  stage.peak_resident_bytes_sum = 466LL << 20;
  stage.collective.bytes = 12LL << 20;
  stage.neighbour.bytes = 300LL << 20;
  stage.rendezvous.bytes = 5LL << 20;
  for (int r = 0; r < ranks; ++r) stage.cpu_seconds_of_ranks.push_back(3 + 2.0 * r / ranks);
  facts.stages = {stage};
  facts.warnings.kept = {{"beware", 1, 3}};
  facts.date = "2026-03-01T10:20:30Z";
  return facts;
}

cases::Case some_case() {
  return cases::case_of_overrides({"improve.gate.smallest_angle=5", "improve.gate.largest_angle=170"});
}

Json rich_report() {
  return Json::parse(report_json(some_case(), rich_record(), facts()));
}

bool contains(const std::string& page, const std::string& words) {
  return page.find(words) != std::string::npos;
}

/// Does something to every value.
void for_each_value(Json& json, const std::function<void(Json&)>& work) {
  if (json.is_structured()) {
    for (Json& item : json) for_each_value(item, work);
  } else {
    work(json);
  }
}

void expect_harmless(const std::string& page) {
  for (const char* words : {"<script", "href='", "href=\"http", "\x01", "</td></table></style>"})
    EXPECT_FALSE(contains(page, words)) << words;
  EXPECT_LT(page.size(), limit);
  EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(ReportHtml, SaysWhatPeopleAskFor) {
  const std::string page = report_html(rich_report().dump(), {});
  for (const char* words :
       {"1,384,540", "3.5°", "53,156,963", "7.4 s", "466 MiB", "0123456789abcdef0123456789abcdef",
        "gate failed", "improve.gate.smallest_angle", "beware", "(3 times)", "a wider halo", "sewn", "joined",
        "wing", "from a checkpoint", "2026-03-01 10:20 UTC", "What to do", "offending_triangles.vtp",
        "smallest_angle: 5"}) {
    EXPECT_TRUE(contains(page, words)) << words;
  }
  EXPECT_TRUE(contains(page, "317 MiB"));  // messages of all kinds
}

TEST(ReportHtml, TellsOfLayersByPatch) {
  const std::string page = report_html(rich_report().dump(), {});
  for (const char* words :
       {"<section id=\"layers\"", "70.0 % of the walls have all layers", "0.00025", "30 layers",
        "25.5 of 30.0", "1.250", "0.420", "20.0 % bad cells, 10.0 % walls opposite"})
    EXPECT_TRUE(contains(page, words)) << words;
  Json without = rich_report();
  without.erase("layers");
  EXPECT_FALSE(contains(report_html(without.dump(), {}), "id=\"layers\""));
}

TEST(ReportHtml, EveryTextIsEscaped) {
  Json report = rich_report();
  for_each_value(report, [](Json& value) {
    if (value.is_string()) value = hostile;
  });
  Picture picture{"body", hostile, 10, 10, {1, 2, 3}, {}};
  picture.legend = {{hostile, hostile}, {"wing", "#12ab9f"}};
  const std::string page = report_html(report.dump(), {picture});
  expect_harmless(page);
  EXPECT_TRUE(contains(page, "&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_TRUE(contains(page, "fill=\"#12ab9f\""));
}

TEST(ReportHtml, BytesThatAreNoTextAreReplaced) {
  RunRecord record = rich_record();
  record.patches[0].name = "wing\xff\xfe\xc3";
  const std::string json = report_json(some_case(), record, facts());
  EXPECT_TRUE(Json::accept(json));
  EXPECT_TRUE(contains(report_html(json, {}), "wing\xEF\xBF\xBD"));
}

TEST(ReportHtml, WhateverIsMissingOrOfAnotherKindIsNoReasonToFail) {
  expect_harmless(report_html("{}", {}));
  const Json whole = rich_report();
  const Json flat = whole.flatten();
  for (const Json& other : {Json(), Json("text"), Json(-1.5), Json(1e300), Json::array(), Json::object()}) {
    for (const auto& [key, value] : whole.items()) {
      Json report = whole;
      report[key] = other;
      EXPECT_NO_THROW(expect_harmless(report_html(report.dump(), {}))) << key << " = " << other;
    }
    for (const auto& [path, value] : flat.items()) {
      Json report = whole;
      report.at(Json::json_pointer(path)) = other;
      EXPECT_NO_THROW(static_cast<void>(report_html(report.dump(), {}))) << path << " = " << other;
    }
  }
}

TEST(ReportHtml, LongTablesEndWithACount) {
  RunRecord record = rich_record();
  for (int i = 0; i < 20000; ++i)
    record.patches.push_back(
        {std::string(1000, 'w') + std::to_string(i), mesh::PatchType::wall, 1, 1, 1, false});
  ReportFacts many = facts();
  many.warnings.kept.assign(500, {std::string(4000, '<'), 0, 1});
  const std::string page = report_html(report_json(some_case(), record, many), {});
  EXPECT_LT(page.size(), limit);
  EXPECT_TRUE(contains(page, "and 19,951 more, see report.json"));
  EXPECT_TRUE(contains(page, "and 450 more, see report.json"));
}

TEST(ReportHtml, PicturesThatDoNotFitAreNamed) {
  std::vector<Picture> pictures;
  for (int i = 0; i < 6; ++i)
    pictures.push_back(
        {"p", "picture number " + std::to_string(i), 100, 100, std::vector<std::uint8_t>(900'000), {}});
  const std::string page = report_html(rich_report().dump(), pictures);
  EXPECT_LT(page.size(), limit);
  EXPECT_TRUE(contains(page, "picture number 5 (no room within 5 MB)"));
}

TEST(ReportHtml, ManyRanksBecomeAHistogram) {
  for (const int ranks : {1, 64, 65, 5000}) {
    const Json report = Json::parse(report_json(some_case(), rich_record(), facts(ranks)));
    const Json& stage = report["stages"][0];
    EXPECT_EQ(stage.contains("cpu_seconds_by_rank"), ranks <= 64);
    EXPECT_EQ(stage.contains("cpu_seconds_histogram"), ranks > 64);
    if (ranks > 64) {
      std::int64_t sum = 0;
      for (const Json& count : stage["cpu_seconds_histogram"]["counts"]) sum += count.get<std::int64_t>();
      EXPECT_EQ(sum, ranks);
    }
    const std::string page = report_html(report.dump(), {});
    EXPECT_EQ(contains(page, "class=\"loads\""), ranks <= 64);
    EXPECT_EQ(contains(page, "class=\"small\""), ranks > 64);
  }
}

}  // namespace
}  // namespace aeroloom::report
