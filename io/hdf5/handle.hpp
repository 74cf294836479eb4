/// Handles of HDF5 that close themselves, and its errors as exceptions. Included by io/hdf5/*.cpp alone: it
/// names HDF5.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <hdf5.h>

namespace aeroloom::io::hdf5 {

/// The message of HDF5 about its last failure in this thread: the innermost reason, and what it was about to
/// do.
std::string last_reason();

/// Throws std::runtime_error "WHAT: the library's reason" where a call has returned a negative number.
template <class Result>
Result require(Result result, const std::string& what) {
  if (result < 0) throw std::runtime_error(what + ": " + last_reason());
  return result;
}

/// Keeps the library from printing its errors; the first call opens it.
void open_library();

/// Closes what it holds.
class Handle {
public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  /// Throws as require() where `id` is none.
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
