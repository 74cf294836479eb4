/// The side of InputFile that runs in a child and sees HDF5. Internal to io/hdf5/.
#pragma once

#include "parallel/communication/packer.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <cstdint>
#include <string>
#include <tuple>

namespace aeroloom::io::hdf5 {

enum class Operation : std::uint8_t { survey, integers, reals, texts };

/// The question to the child.
struct ReadingRequest {
  Operation operation = Operation::survey;
  std::string path;
  parallel::Bytes details;  ///< a SurveyRequest, a RowRange, or the name of an array of texts

  static constexpr auto fields() {
    return std::tuple(&ReadingRequest::operation, &ReadingRequest::path, &ReadingRequest::details);
  }
};

/// Rows of an array.
struct RowRange {
  std::string array;
  std::int64_t begin = 0, count = 0;

  static constexpr auto fields() { return std::tuple(&RowRange::array, &RowRange::begin, &RowRange::count); }
};

/// From a ReadingRequest to the bytes of what was read.
extern const parallel::NamedTask reading_task;

}  // namespace aeroloom::io::hdf5
