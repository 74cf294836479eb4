/// Messages for the tests of what carries them.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstddef>

namespace aeroloom::parallel {

/// Content that tells who sent it to whom, of any length.
inline Bytes letter(Rank from, Rank to, std::size_t length) {
  Bytes content(length);
  for (std::size_t i = 0; i < length; ++i) {
    content[i] = static_cast<std::byte>(i * 31 + i / 251 + static_cast<std::size_t>(from) * 7 +
                                        static_cast<std::size_t>(to) * 13);
  }
  return content;
}

}  // namespace aeroloom::parallel
