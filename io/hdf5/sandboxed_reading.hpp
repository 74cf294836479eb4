/// The part of InputFile that runs in a child process and calls HDF5. Internal to io/hdf5/.
#pragma once

#include "parallel/communication/packer.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::io::hdf5 {

enum class Operation : std::uint8_t { survey, integers, reals, texts };

/// A request to the child process.
struct ReadingRequest {
  Operation operation = Operation::survey;
  std::string path;
  parallel::Bytes details;  ///< packed: a SurveyRequest, a RowRange, or the name of an array of texts
};

/// Consecutive rows of an array.
struct RowRange {
  std::string array;
  std::int64_t begin = 0, count = 0;
};

/// Turns a packed ReadingRequest into the packed result.
extern const parallel::NamedTask reading_task;

}  // namespace aeroloom::io::hdf5
