#include "parallel/observation/task_kind.hpp"

#include <set>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

TEST(TaskKindLocal, RowsStandInTheOrderOfKinds) {
  for (std::size_t i = 0; i < task_kinds.size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(task_kinds[i].kind), i) << task_kinds[i].name;
    EXPECT_EQ(row_of(task_kinds[i].kind).name, task_kinds[i].name);
  }
  EXPECT_EQ(task_kinds.back().kind, TaskKind::file);
}

TEST(TaskKindLocal, NamesLeadBackToTheirKinds) {
  std::set<std::string_view> names;
  for (const TaskKindRow& row : task_kinds) {
    EXPECT_EQ(task_kind_called(name_of(row.kind)), row.kind) << row.name;
    EXPECT_EQ(row.name.find_first_of(",\n\""), std::string_view::npos) << row.name;  // a word of a table
    names.insert(row.name);
  }
  EXPECT_EQ(names.size(), task_kinds.size());
  EXPECT_EQ(task_kind_called("another kind"), std::nullopt);
  EXPECT_EQ(task_kind_called(""), std::nullopt);
}

/// Records of earlier runs have these words.
TEST(TaskKindLocal, NamesAreThoseOfRecords) {
  std::string all;
  for (const TaskKindRow& row : task_kinds) all += std::string(row.name) + ";";
  EXPECT_EQ(all,
            "sampled face;curve;face;divided face;divided part;surface piece;wall piece;zone;core piece;"
            "improved piece;cavity;file;");
}

TEST(TaskKindLocal, ZonesAloneComeAFewAtATime) {
  for (const TaskKindRow& row : task_kinds)
    EXPECT_EQ(row.at_a_time > 0, row.kind == TaskKind::zone) << row.name;
}

}  // namespace
}  // namespace aeroloom::parallel
