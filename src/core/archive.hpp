// A byte string of numbers and texts in the order they were put: what checkpoints are made of.
// Numbers are stored as they stand in memory, so what is taken out is bit for bit what was put in;
// files are for the machine type that wrote them.
#pragma once
#include <core/types.hpp>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace whirl {

class OutArchive {
 public:
  /// head: what stands before it all.
  explicit OutArchive(std::string_view head = {}) : data_(head) {}
  void put(double x) { raw(&x, sizeof x); }
  void put_count(std::uint64_t n) { raw(&n, sizeof n); }
  void put(std::string_view s) {
    put_count(s.size());
    raw(s.data(), s.size());
  }
  void put(std::span<const double> x) {
    put_count(x.size());
    raw(x.data(), x.size_bytes());
  }
  void put(const VecX& x) {
    put(std::span<const double>(x.data(), static_cast<std::size_t>(x.size())));
  }
  const std::string& data() const { return data_; }
  /// Room for so many bytes.
  void reserve(std::size_t bytes) { data_.reserve(bytes); }
  /// The bytes; nothing is left.
  std::string take() { return std::move(data_); }

 private:
  void raw(const void* p, std::size_t n) {
    if (n) data_.append(static_cast<const char*>(p), n);
  }
  std::string data_;
};

/// Takes out in the order of put. Throws std::invalid_argument when there is less than asked for.
class InArchive {
 public:
  explicit InArchive(std::string_view data) : data_(data) {}
  double number() {
    double x;
    raw(&x, sizeof x);
    return x;
  }
  std::uint64_t count() {
    std::uint64_t n;
    raw(&n, sizeof n);
    return n;
  }
  std::string text() {
    std::string s(sized(1), '\0');
    raw(s.data(), s.size());
    return s;
  }
  std::vector<double> numbers() {
    std::vector<double> x(sized(sizeof(double)));
    raw(x.data(), x.size() * sizeof(double));
    return x;
  }
  VecX vector() {
    const std::vector<double> x = numbers();
    return Eigen::Map<const VecX>(x.data(), static_cast<Index>(x.size()));
  }

 private:
  std::size_t sized(std::size_t unit) {
    const std::uint64_t n = count();
    if (n > data_.size() / unit) throw std::invalid_argument("archive: cut short");
    return static_cast<std::size_t>(n);
  }
  void raw(void* p, std::size_t n) {
    if (n > data_.size()) throw std::invalid_argument("archive: cut short");
    if (n) std::memcpy(p, data_.data(), n);
    data_.remove_prefix(n);
  }
  std::string_view data_;
};

}  // namespace whirl
