/// Keeps results of tasks on disk, so that a later run need not repeat the tasks of a run that was cut off.
/// The numbers of ranks may differ.
///
/// The key of a task is the digest of all data that its result depends on. A stage looks up each of its tasks
/// and runs those that are not found. Each rank appends to its own file. Incomplete or damaged records are
/// not found.
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
  /// Files are FOLDER/NAME.GENERATION.RANK.tasks; the folder is created. Results of earlier runs under this
  /// name are found, or removed. `context` is the digest of what all tasks depend on besides their keys, such
  /// as version and options. Collective; throws CollectiveError.
  TaskStore(Communicator communicator, std::string folder, std::string name, const Digest& context,
            Earlier earlier);
  ~TaskStore();
  TaskStore(const TaskStore&) = delete;
  TaskStore& operator=(const TaskStore&) = delete;

  /// The result that a rank of an earlier run has kept under the key; none if it is missing or damaged. Not
  /// collective.
  std::optional<Bytes> find(const Digest& key);
  /// Keeps a result. On a failure, such as a full disk, warns once and keeps nothing from then on. Not
  /// collective.
  void keep(const Digest& key, std::span<const std::byte> result);
  /// How many results this rank has found.
  std::int64_t found() const { return _found; }
  /// Removes all files of this name. The store must not be used afterwards. Collective.
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
