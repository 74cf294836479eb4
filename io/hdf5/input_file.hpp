/// Reading HDF5 files of any origin.
///
/// The library may crash, loop or ask for absurd memory on a damaged file, so it reads in sandboxed children
/// (parallel/sandbox/sandbox.hpp): what it does there becomes an exception here.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io::hdf5 {

enum class ItemKind : std::uint8_t { missing, integer, real, text, other };

/// Facts about an array that are known without reading it.
struct ArrayFacts {
  ItemKind kind = ItemKind::missing;  ///< `other`: a group, or items of another kind
  std::vector<std::int64_t> dimensions;

  static constexpr auto fields() { return std::tuple(&ArrayFacts::kind, &ArrayFacts::dimensions); }
  bool exists() const { return kind != ItemKind::missing; }
  /// Of the first dimension.
  std::int64_t rows() const { return dimensions.empty() ? 0 : dimensions[0]; }
};

/// An attribute to look up: texts come as they are, the first of integers as digits.
struct AttributeName {
  std::string object, attribute;

  static constexpr auto fields() { return std::tuple(&AttributeName::object, &AttributeName::attribute); }
};

/// Names to be looked up by one child, so that the file is opened once.
struct SurveyRequest {
  std::vector<std::string> arrays;
  std::vector<AttributeName> attributes;
  /// A member of `group` whose attribute has this value is wanted (the first by name).
  std::string group;
  AttributeName mark;  ///< `object`: the value

  static constexpr auto fields() {
    return std::tuple(&SurveyRequest::arrays, &SurveyRequest::attributes, &SurveyRequest::group,
                      &SurveyRequest::mark);
  }
};
struct Survey {
  std::vector<ArrayFacts> arrays;       ///< in the order of the request
  std::vector<std::string> attributes;  ///< in the order of the request; empty where there is none
  std::string marked;                   ///< name of the member of the group; empty where there is none

  static constexpr auto fields() { return std::tuple(&Survey::arrays, &Survey::attributes, &Survey::marked); }
};

/// An HDF5 file to read. All throw std::runtime_error that names the file and what cannot be read;
/// the constructor std::filesystem::filesystem_error where the file cannot be opened. Not collective.
class InputFile {
public:
  explicit InputFile(std::string path);

  /// Arrays that claim more than the file can hold (a deflated one at most 1,100 times what it stores), that
  /// lie in other files or have more than two dimensions throw.
  Survey survey(const SurveyRequest& request) const;

  /// Rows begin .. begin + count - 1, all columns of a row together.
  std::vector<std::int64_t> integers(const std::string& array, std::int64_t begin, std::int64_t count) const;
  std::vector<double> reals(const std::string& array, std::int64_t begin, std::int64_t count) const;
  /// All texts of an array.
  std::vector<std::string> texts(const std::string& array) const;

  const std::string& path() const { return _path; }

private:
  std::string _path;
};

}  // namespace aeroloom::io::hdf5
