#include "pipeline/checkpoints.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using parallel::log_warning;

constexpr std::array<const char*, saved_stages> names{"geometry", "sizing", "surface", "volume", "improve"};

const char* name_of(SavedStage stage) {
  return names.at(static_cast<std::size_t>(stage));
}

/// The texts of a label.
enum About : std::uint8_t { about_version, about_build, about_input, about_digest, about_keys, about_texts };

/// The case with only what matters up to a stage; all else is as by default.
cases::Case relevant_part(const cases::Case& input, SavedStage stage) {
  cases::Case part;
  part.domain = input.domain;
  if (!part.domain.file.empty()) part.domain.file = std::filesystem::path(input.domain.file).filename();
  for (cad::FacetedBody& body : part.domain.parts) body.file = std::filesystem::path(body.file).filename();
  // What patches are to a solver is for the output. But openings tell a duct from a body.
  const auto is_opening = [&](const auto& rule) {
    return input.domain.kind == cad::DomainKind::automatic &&
           (rule.type == mesh::PatchType::inlet || rule.type == mesh::PatchType::outlet);
  };
  part.groups.rules = input.groups.rules;
  part.patches = input.patches;
  if (stage < SavedStage::sizing) {
    std::erase_if(part.groups.rules, [&](const cases::GroupRule& rule) { return !is_opening(rule); });
    std::erase_if(part.patches, [&](const cases::PatchRule& rule) { return !is_opening(rule); });
  }
  for (cases::GroupRule& rule : part.groups.rules)
    if (!is_opening(rule)) rule.type.reset();
  for (cases::PatchRule& rule : part.patches)
    if (!is_opening(rule)) rule.type.reset();
  if (stage >= SavedStage::sizing) {
    part.narrow_faces = input.narrow_faces;
    part.sizing = input.sizing;
  } else {
    part.sizing.minimum = input.domain.smallest_size > 0 ? input.sizing.minimum : std::nullopt;
    if (part.sizing.minimum) part.sizing.reference_length = input.sizing.reference_length;
  }
  if (stage >= SavedStage::surface) part.surface = input.surface;
  if (stage >= SavedStage::volume) {
    part.volume = input.volume;
    part.layers = input.layers;
    part.layers.gate = {};
    part.layers.elements = {};  // layers are made after this, from what their front has left
  }
  if (stage >= SavedStage::improve) {
    part.improve = input.improve;
    part.gate.percentile_01 = input.gate.percentile_01;
    part.gate.percentile_1 = input.gate.percentile_1;
    part.gate.percentile_5 = input.gate.percentile_5;
  }
  return part;
}

/// The keys of a resolved case with their values, in order: "improve.target_angle".
std::vector<std::pair<std::string, std::string>> keys_of(const std::string& yaml) {
  struct Section {
    std::size_t indent;
    std::string name;
  };
  std::vector<std::pair<std::string, std::string>> keys;
  std::vector<Section> sections;
  std::istringstream lines(yaml);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos) continue;
    while (!sections.empty() && sections.back().indent >= indent) sections.pop_back();
    const std::size_t colon = std::min(line.find(": ", indent), line.size() - (line.back() == ':' ? 1 : 0));
    std::string path;
    for (const Section& section : sections) path += section.name + ".";
    const std::string name = line.substr(indent, colon - indent);
    if (colon + 1 < line.size())
      keys.emplace_back(path + name, line.substr(colon + 2));
    else
      sections.push_back({indent, name});
  }
  return keys;
}

/// The first key that differs, in words.
std::string difference(const std::string& then, const std::string& now) {
  const auto before = keys_of(then), after = keys_of(now);
  const auto value_in = [](const auto& keys, const std::string& wanted) -> std::string {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.first == wanted; });
    return found == keys.end() ? "not given" : found->second;
  };
  for (const auto* keys : {&before, &after}) {
    for (const auto& [key, value] : *keys) {
      const std::string old = value_in(before, key), own = value_in(after, key);
      if (old != own) return fmt::format("{}: {}, in the case {}", key, old, own);
    }
  }
  return "other keys";
}

}  // namespace

Checkpoints::Checkpoints(parallel::Communicator communicator, const cases::Case& input,
                         const RunIdentity& identity)
    : _communicator(std::move(communicator)),
      _input(input),
      _identity(identity),
      _folder(input.output.directory + "/checkpoint"),
      _writes(input.output.checkpoints != cases::CheckpointUse::none),
      _resumes(input.output.checkpoints == cases::CheckpointUse::resume) {
  if (_resumes && identity.is_known) refuse_imported();
}

std::string Checkpoints::path_of(SavedStage stage) const {
  return fmt::format("{}/{}.checkpoint", _folder, name_of(stage));
}

io::CheckpointLabel Checkpoints::label_of(SavedStage stage) const {
  io::CheckpointLabel label;
  label.about.resize(about_texts);
  label.about[about_version] = _identity.version;
  label.about[about_build] = _identity.build.text();
  label.about[about_input] = _identity.input;
  label.about[about_digest] = _identity.digest.text();
  label.about[about_keys] = cases::resolved_yaml(relevant_part(_input, stage));
  parallel::Digester digester;
  digester.text(name_of(stage));
  for (const std::string& text : label.about) digester.text(text);
  label.key = digester.result();
  return label;
}

/// Nothing where there is none that can be read.
std::optional<io::CheckpointLabel> Checkpoints::read_label(SavedStage stage) const {
  try {
    return io::read_checkpoint_label({_communicator, path_of(stage)}, about_texts);
  } catch (const parallel::CollectiveError& error) {
    if (_communicator.is_root())
      log_warning(fmt::format("checkpoint: {}; stage {} is done anew", error.what(), name_of(stage)));
    return std::nullopt;
  }
}

/// Or is not there at all.
bool Checkpoints::is_of_this_case(SavedStage stage) const {
  try {
    const std::optional<io::CheckpointLabel> found =
        io::read_checkpoint_label({_communicator, path_of(stage)}, about_texts);
    return !found || found->key == label_of(stage).key;
  } catch (const parallel::CollectiveError&) {
    return false;
  }
}

void Checkpoints::refuse_imported() const {
  for (std::size_t s = 0; s < saved_stages; ++s) {
    const auto stage = static_cast<SavedStage>(s);
    std::optional<io::CheckpointLabel> found;
    try {
      found = io::read_checkpoint_label({_communicator, path_of(stage)}, about_texts);
    } catch (const parallel::CollectiveError&) {  // find() logs it where it matters
    }
    if (!found) continue;
    const io::CheckpointLabel own = label_of(stage);
    const auto differs = [&](About text) { return found->about[text] != own.about[text]; };
    std::string what;
    if (differs(about_digest)) {
      what = fmt::format("of another geometry: '{}' ({}), this is '{}' ({})", found->about[about_input],
                         found->about[about_digest], own.about[about_input], own.about[about_digest]);
    } else if (differs(about_version) || differs(about_build)) {
      what =
          fmt::format("by another program: {} (build {}), this is {} (build {})", found->about[about_version],
                      found->about[about_build], own.about[about_version], own.about[about_build]);
    }
    if (what.empty()) continue;
    throw std::invalid_argument(
        fmt::format("'{}' is {}. Remedy: give another output.directory, or start anew with --checkpoints, "
                    "which replaces it",
                    path_of(stage), what));
  }
}

std::optional<io::CheckpointContent> Checkpoints::find(SavedStage stage) {
  if (!_resumes) return std::nullopt;
  const std::optional<io::CheckpointLabel> found = read_label(stage);
  if (!found) return std::nullopt;
  const io::CheckpointLabel own = label_of(stage);
  if (found->key != own.key) {
    parallel::log_info(fmt::format("checkpoint: stage {} was run with {}: done anew", name_of(stage),
                                   difference(found->about[about_keys], own.about[about_keys])));
    return std::nullopt;
  }
  try {
    io::CheckpointContent content = io::read_checkpoint({_communicator, path_of(stage)});
    parallel::log_info(fmt::format("checkpoint: stage {} from '{}'", name_of(stage), path_of(stage)));
    remove_left_over(stage);
    return content;
  } catch (const parallel::CollectiveError& error) {
    if (_communicator.is_root())
      log_warning(fmt::format("checkpoint: {}; stage {} is done anew", error.what(), name_of(stage)));
    return std::nullopt;
  }
}

/// False where files could not be written; nothing is kept from then on.
bool Checkpoints::attempt(const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const parallel::CollectiveError& error) {
    if (error.kind() != parallel::FailureKind::files) throw;
    if (_communicator.is_root()) {
      log_warning(fmt::format("checkpoint: {}. The run goes on; from here on nothing is kept for another run",
                              error.what()));
    }
    _writes = false;
    return false;
  }
}

void Checkpoints::keep(SavedStage stage, const std::function<io::CheckpointDraft()>& draft) {
  if (!_writes) return;
  attempt([&] {
    io::write_checkpoint({_communicator, path_of(stage)}, label_of(stage), draft());
    remove_needless(stage);
  });
}

parallel::TaskStore* Checkpoints::tasks(SavedStage stage) {
  std::unique_ptr<parallel::TaskStore>& store = _tasks.at(static_cast<std::size_t>(stage));
  if (!store && _writes) {
    attempt([&] {
      store = std::make_unique<parallel::TaskStore>(
          _communicator, _folder, name_of(stage), label_of(stage).key,
          _resumes ? parallel::TaskStore::Earlier::find : parallel::TaskStore::Earlier::forget);
    });
  }
  return store.get();
}

/// The tasks of a stage that is kept as a whole; a volume that has been improved; later stages of what the
/// case no longer is.
void Checkpoints::remove_needless(SavedStage kept) {
  std::unique_ptr<parallel::TaskStore>& store = _tasks.at(static_cast<std::size_t>(kept));
  if (store) {
    if (const std::int64_t found = _communicator.sum(store->found()); found > 0) {
      parallel::log_info(
          fmt::format("checkpoint: stage {}: {} task(s) had been finished before", name_of(kept), found));
    }
    store->remove();
  }
  store.reset();
  for (auto s = static_cast<std::size_t>(kept) + 1; s < saved_stages; ++s) {
    const auto later = static_cast<SavedStage>(s);
    if (is_of_this_case(later)) continue;
    parallel::on_root(_communicator, [&] { std::filesystem::remove(path_of(later)); });
  }
  remove_volume_of(kept);
}

/// Removes files of a run that was killed after the stage was kept.
void Checkpoints::remove_left_over(SavedStage found) {
  attempt([&] {
    const parallel::TaskStore emptied(_communicator, _folder, name_of(found), {},
                                      parallel::TaskStore::Earlier::forget);
    remove_volume_of(found);
  });
}

/// Removes the volume once an improved one is kept.
void Checkpoints::remove_volume_of(SavedStage kept) {
  if (kept != SavedStage::improve) return;
  parallel::on_root(_communicator, [&] { std::filesystem::remove(path_of(SavedStage::volume)); });
}

}  // namespace aeroloom::pipeline
