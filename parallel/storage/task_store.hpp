/// Results of tasks on disk, for a run that goes on where this one was cut off: whatever was finished need
/// not be done again, on any number of ranks.
///
/// A task is named by the digest of all that its result depends on, so a stage asks for each of its tasks
/// whether somebody did it before, and otherwise runs as ever. Each rank appends to a file of its own; a
/// record that a killed run left unfinished, or that has changed since, is not found.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/storage/digest.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::parallel {

class FileDescriptor;

class TaskStore {
public:
  enum class Earlier : bool { forget, find };
  /// Files FOLDER/NAME.GENERATION.RANK.tasks; the folder is made. What earlier runs left under that name is
  /// found, or removed. `context` stands for what all tasks depend on and their keys do not hold: version,
  /// options. Collective; throws CollectiveError.
  TaskStore(Communicator communicator, std::string folder, std::string name, const Digest& context,
            Earlier earlier);
  ~TaskStore();
  TaskStore(const TaskStore&) = delete;
  TaskStore& operator=(const TaskStore&) = delete;

  /// The bytes that any rank of an earlier run has kept under the key; none where they are not there or not
  /// what they were. Not collective.
  std::optional<Bytes> find(const Digest& key);
  /// Keeps a result. Where that fails, on a full disk, warns once, and keeps nothing from then on. Not
  /// collective.
  void keep(const Digest& key, std::span<const std::byte> result);
  /// How often this rank has found what it asked for.
  std::int64_t found() const { return _found; }
  /// Removes all files of this name. Collective; the store is not to be used afterwards.
  void remove();

private:
  struct StoredTask {
    Digest key, content;
    std::int64_t offset = 0, bytes = 0;
    std::int32_t generation = 0, rank = 0;
  };
  struct RecordHeader;
  struct FileName;

  std::string path_of(std::int32_t generation, Rank rank) const;
  std::vector<FileName> list_files() const;
  std::vector<StoredTask> scan(const FileName& file) const;
  void remove_files() const;
  Digest in_context(const Digest& key) const;
  void give_up(const std::string& reason);

  Communicator _communicator;
  std::string _folder, _name;
  Digest _context;
  std::map<Digest, StoredTask> _places;
  std::int32_t _generation = 0;
  std::unique_ptr<FileDescriptor> _file;  // opened by the first that is kept
  std::int64_t _end = 0;
  bool _failed = false;
  std::int64_t _found = 0;
};

}  // namespace aeroloom::parallel
