/// Reading HDF5 files of any origin.
///
/// On a damaged file the library may crash, hang or use far too much memory. So it reads in child processes
/// (parallel/sandbox/sandbox.hpp), and such a failure becomes an exception.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io::hdf5 {

enum class ItemKind : std::uint8_t { missing, integer, real, text, other };

/// Type and dimensions of an array, known without reading its items.
struct ArrayFacts {
  ItemKind kind = ItemKind::missing;  ///< `other`: a group, or items of another type
  std::vector<std::int64_t> dimensions;
  bool exists() const { return kind != ItemKind::missing; }
  /// The length of the first dimension.
  std::int64_t rows() const { return dimensions.empty() ? 0 : dimensions[0]; }
};

/// An attribute to look up. Its value comes as text; of several integers the first one counts.
struct AttributeName {
  std::string object, attribute;
};

/// Names to look up in one child process, which opens the file once.
struct SurveyRequest {
  std::vector<std::string> arrays;
  std::vector<AttributeName> attributes;
  /// Asks for the first member (by name) of `group` whose attribute mark.attribute has the value mark.object.
  std::string group;
  AttributeName mark;
};
struct Survey {
  std::vector<ArrayFacts> arrays;       ///< in the order of the request
  std::vector<std::string> attributes;  ///< in the order of the request; empty where missing
  std::string marked;                   ///< name of the member of the group; empty where missing
};

/// An HDF5 file to read. The functions throw std::runtime_error with the file and the object. The constructor
/// throws std::ios_base::failure where the file cannot be opened. Not collective.
class InputFile {
public:
  explicit InputFile(std::string path);

  /// Throws for an array that claims more than the file can hold (if compressed, 1,100 times the stored
  /// bytes), lies in another file or behind a link to one, or has more than two dimensions.
  Survey survey(const SurveyRequest& request) const;

  /// Rows begin ... begin + count - 1, row by row.
  std::vector<std::int64_t> integers(const std::string& array, std::int64_t begin, std::int64_t count) const;
  std::vector<double> reals(const std::string& array, std::int64_t begin, std::int64_t count) const;
  /// All texts of an array.
  std::vector<std::string> texts(const std::string& array) const;

  const std::string& path() const { return _path; }

private:
  std::string _path;
};

}  // namespace aeroloom::io::hdf5
