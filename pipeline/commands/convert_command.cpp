#include "pipeline/commands/commands.hpp"
#include "pipeline/convert_file.hpp"

#include <map>
#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_convert(CLI::App& program) {
  CLI::App* app = program.add_subcommand("convert", "write a mesh in another format");
  const auto conversion = std::make_shared<Conversion>();
  app->add_option("from", conversion->from, "the mesh to read")->required();
  app->add_option("to", conversion->to, "the file to write; its extension says the format")->required();
  std::map<std::string, io::FileFormat> formats;
  for (const io::FormatName& format : io::format_names) formats.emplace(format.name, format.format);
  app->add_option("--format", conversion->format, "the format, where the extension does not say it")
      ->transform(CLI::CheckedTransformer(formats));
  app->add_option("--parts", conversion->options.parts, "parts of a format that comes in parts")
      ->check(CLI::Range(1, 1000000));
  return {app, [conversion](const parallel::Communicator& communicator, const Loudness& loudness) {
            parallel::configure_log(communicator, loudness.level());
            return guarded(communicator, ExitCode::files, [&] {
              convert_file(communicator, *conversion);
              return ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
