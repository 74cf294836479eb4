#include "pipeline/study/plan.hpp"

#include "tests/pipeline/study/studies.hpp"

#include <set>

#include <gtest/gtest.h>

namespace aeroloom::study {
namespace {

TEST(Plan, RepeatsGoRoundTheRanks) {
  const StudyRecord study = a_study("/results", {1, 4}, 2, {{1, {"a=1"}}, {4, {"a=4"}}});
  std::vector<std::string> names;
  for (const RunSpec& run : study.runs) names.push_back(run.name());
  EXPECT_EQ(names,
            (std::vector<std::string>{"serial_1_1", "strong_1_1", "strong_4_1", "weak_1_1", "weak_4_1",
                                      "serial_1_2", "strong_1_2", "strong_4_2", "weak_1_2", "weak_4_2"}));
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_TRUE(study.runs[1].settings.empty());
  EXPECT_FALSE(study.runs[0].settings.empty());
  EXPECT_EQ(study.runs[4].settings, std::vector<std::string>{"a=4"});
  EXPECT_EQ(folder_of("/results", study.runs[2]), "/results/runs/strong_4_1");
}

TEST(Plan, NodesAreFilled) {
  EXPECT_EQ(nodes_for(7, 0), 1);
  EXPECT_EQ(nodes_for(7, 4), 2);
  EXPECT_EQ(nodes_for(8, 4), 2);
}

TEST(Plan, IsKeptInItsFolder) {
  const StudyFolder folder("plan");
  EXPECT_FALSE(holds_study(folder.path));
  const StudyRecord study = a_study(folder.path, {1, 2}, 1, {{2, {"sizing.minimum=0.5"}}});
  save(study);
  ASSERT_TRUE(holds_study(folder.path));
  const StudyRecord read = load_study(folder.path);
  ASSERT_EQ(read.runs.size(), study.runs.size());
  for (std::size_t i = 0; i < read.runs.size(); ++i) EXPECT_EQ(to_json(read.runs[i]), to_json(study.runs[i]));
  EXPECT_NO_THROW(require_same_subject(read, study));
}

TEST(Plan, RefusesToMixCases) {
  const StudyRecord before = a_study("/results", {1}, 1);
  StudyRecord now = before;
  now.subject = "sizing:\n  minimum: 2\n";
  try {
    require_same_subject(before, now);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("it has '  minimum: 1', this case '  minimum: 2'"),
              std::string::npos)
        << error.what();
  }
  now = before;
  now.versions = "aeroloom 2";
  EXPECT_THROW(require_same_subject(before, now), std::invalid_argument);
}

TEST(Plan, RefusesGeometryThatHasChanged) {
  const StudyFolder folder("geometry");
  StudyRecord before = a_study(folder.path, {1}, 1);
  before.geometry = {"wing.poly", "f00d"};
  before.network = {"network.json", "cafe"};
  save(before);
  const StudyRecord read = load_study(folder.path);
  EXPECT_EQ(read.geometry.hash, "f00d");
  EXPECT_EQ(read.network.hash, "cafe");
  StudyRecord now = before;
  now.network.hash = "";
  EXPECT_NO_THROW(require_same_subject(read, now)) << "runs do not depend on it";
  now.geometry.hash = "beef";
  try {
    require_same_subject(read, now);
    ADD_FAILURE() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("'wing.poly' with all that is read beside it, has changed"),
              std::string::npos)
        << error.what();
  }
  now.geometry.hash = "";
  EXPECT_THROW(require_same_subject(read, now), std::runtime_error);
}

TEST(Plan, DamagedRecordsAreNamed) {
  const StudyFolder folder("damaged");
  const auto expect = [&](const std::string& text, const std::string& words) {
    write_file(folder.path / "study.json", text);
    try {
      load_study(folder.path);
      ADD_FAILURE() << text;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  expect("{\"program\": 1}", "study.json' is not the record of a study");
  expect("{\"program\": \"a\"}", "key 'case' not found");
  expect("{\"program\": ", "study.json' is not whole JSON: parse error at line 1");
  expect("[]", "study.json' is not");
  save(a_study(folder.path, {1}, 1));
  Json record = Json::parse(read_file(folder.path / "study.json"));
  record["runs"][0]["ranks"] = -1;
  expect(record.dump(), "'serial_-1_1'");
  record["runs"][0]["series"] = "../..";
  expect(record.dump(), "no series is called '../..'");
}

}  // namespace
}  // namespace aeroloom::study
