/// The layout of `--help`.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

/// Usage lines as in docs/usage.md, an empty line between groups, exclusions in words.
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
};

}  // namespace aeroloom::pipeline
