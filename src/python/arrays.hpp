// C++ memory as NumPy arrays, without copying: the array owns what it was made from.
#pragma once
#include <pybind11/numpy.h>
#include <memory>
#include <utility>
#include <vector>

namespace whirl::python {

/// The vector itself, as an array of one axis, or of `shape`.
/// @pre the product of shape is the length.
template <class T>
pybind11::array_t<T> array_of(std::vector<T>&& values, std::vector<pybind11::ssize_t> shape = {}) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  if (shape.empty()) shape = {static_cast<pybind11::ssize_t>(kept->size())};
  T* data = kept->data();
  const pybind11::capsule owner(kept.get(),
                                [](void* p) { delete static_cast<std::vector<T>*>(p); });
  static_cast<void>(kept.release());  // it is the capsule's
  return pybind11::array_t<T>(shape, data, owner);
}

}  // namespace whirl::python
