/// HDF5 handles that close themselves, and HDF5 errors as exceptions. Only io/hdf5/*.cpp include this header,
/// because it includes HDF5's own.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <hdf5.h>

namespace aeroloom::io::hdf5 {

/// HDF5's message about its last failure in this thread: the innermost one.
std::string last_reason();

/// Throws std::runtime_error "WHAT: REASON OF HDF5" where `result` is negative, which means failure.
template <class Result>
Result require(Result result, const std::string& what) {
  if (result < 0) throw std::runtime_error(what + ": " + last_reason());
  return result;
}

/// Opens the library at the first call, and keeps it from printing its errors.
void open_library();

/// Owns an HDF5 identifier and closes it.
class Handle {
public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// Throws as require() where `id` is negative.
  Handle(hid_t id, Close close, const std::string& what) : _id(require(id, what)), _close(close) {}
  Handle(Handle&& other) noexcept : _id(std::exchange(other._id, -1)), _close(other._close) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(_id, other._id);
    std::swap(_close, other._close);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (_id >= 0) _close(_id);
  }
  operator hid_t() const { return _id; }
  /// Throws where closing fails.
  void close(const std::string& what) {
    if (_id >= 0) require(_close(std::exchange(_id, -1)), what);
  }

private:
  hid_t _id = -1;
  Close _close = nullptr;
};

}  // namespace aeroloom::io::hdf5
