/// A folder with cases, for tests that read them.
#pragma once

#include "pipeline/case/case.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace aeroloom::cases {

namespace fs = std::filesystem;

/// A folder of this process with a case in it.
class CaseTest : public testing::Test {
protected:
  CaseTest() : folder(fs::temp_directory_path() / ("aeroloom_case_test_" + std::to_string(getpid()))) {
    fs::create_directories(folder);
  }
  ~CaseTest() override { fs::remove_all(folder); }

  std::string write(const std::string& yaml, const std::string& name = "case.yaml") const {
    const fs::path file = folder / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << yaml;
    return file.string();
  }
  Case read(const std::string& yaml, const std::vector<std::string>& overrides = {}) const {
    return read_case(write(yaml), overrides);
  }
  /// The message, without the folder.
  std::string error_of(const std::string& yaml, const std::vector<std::string>& overrides = {}) const {
    const std::string file = write(yaml);
    try {
      read_case(file, overrides);
    } catch (const CaseError& error) {
      std::string text = error.what();
      const std::string prefix = folder.string() + "/";
      while (text.find(prefix) != std::string::npos) text.erase(text.find(prefix), prefix.size());
      return text;
    }
    return "no error";
  }

  const fs::path folder;
};

inline const std::string transport = "geometry: {builtin: transport}\n";

}  // namespace aeroloom::cases
