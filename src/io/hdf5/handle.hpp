// HDF5 identifiers. The folder hdf5 alone sees the HDF5 library (C API, 1.10).
#pragma once
#include <hdf5.h>
#include <io/file.hpp>
#include <filesystem>
#include <mutex>
#include <utility>

namespace whirl::io {

/// The library is not thread-safe.
inline std::mutex& library() {
  static std::mutex one;
  return one;
}

/// To be called before anything else on every thread. Failures are Errors, each thread has a stack of
/// them of its own, and none is printed. At the end of the process the library does nothing: what could
/// not be written (a full disk) it would try again there, and crash.
inline void prepare_library() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// An HDF5 identifier and how to close it.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t), const std::filesystem::path& file, const char* what)
      : id_(id),
        close_(close) {
    if (id < 0) io_failure(file, what);
  }
  Handle(Handle&& o) noexcept : id_(std::exchange(o.id_, -1)), close_(o.close_) {}
  Handle& operator=(Handle&& o) noexcept {
    reset();
    id_ = std::exchange(o.id_, -1);
    close_ = o.close_;
    return *this;
  }
  ~Handle() { reset(); }
  void reset() {
    if (id_ >= 0) close_(std::exchange(id_, -1));
  }
  operator hid_t() const { return id_; }
  bool open() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// Of any length, UTF-8.
inline Handle string_type() {
  Handle t(H5Tcopy(H5T_C_S1), H5Tclose, {}, "HDF5: no string type");
  H5Tset_size(t, H5T_VARIABLE);
  H5Tset_cset(t, H5T_CSET_UTF8);
  return t;
}

}  // namespace whirl::io
