// Nested values with ordered keys: the run summary and everything else that becomes JSON.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace whirl::io {

/// null, bool, integer, number, text, array or object (keys keep the order in which they were set).
class Value {
 public:
  using Array = std::vector<Value>;
  using Object = std::vector<std::pair<std::string, Value>>;

  Value() = default;
  Value(bool b) : v_(b) {}
  Value(int i) : v_(std::int64_t{i}) {}
  Value(long i) : v_(std::int64_t{i}) {}
  Value(long long i) : v_(std::int64_t{i}) {}
  Value(unsigned i) : v_(std::int64_t{i}) {}
  Value(unsigned long i) : v_(static_cast<std::int64_t>(i)) {}
  Value(unsigned long long i) : v_(static_cast<std::int64_t>(i)) {}
  Value(double x) : v_(x) {}
  Value(const char* s) : v_(std::string(s)) {}
  Value(std::string_view s) : v_(std::string(s)) {}
  Value(std::string s) : v_(std::move(s)) {}
  Value(Array a) : v_(std::move(a)) {}
  Value(Object o) : v_(std::move(o)) {}
  template <class T>
  Value(const std::vector<T>& xs) : v_(Array(xs.begin(), xs.end())) {}

  static Value object() { return Value(Object{}); }
  static Value array() { return Value(Array{}); }

  bool is_null() const { return v_.index() == 0; }
  bool is_object() const { return std::holds_alternative<Object>(v_); }
  bool is_array() const { return std::holds_alternative<Array>(v_); }
  bool is_text() const { return std::holds_alternative<std::string>(v_); }
  bool is_number() const { return v_.index() == 2 || v_.index() == 3; }

  /// Member by key; made when absent (null becomes an object), like summary["newton"]["iterations"]
  /// = 12.
  Value& operator[](std::string_view key);
  /// Member by key, or a null value.
  const Value& at(std::string_view key) const;
  /// Appends to an array (null becomes an array).
  Value& push(Value v);

  const Object& members() const { return std::get<Object>(v_); }
  const Array& items() const { return std::get<Array>(v_); }
  const std::string& text() const { return std::get<std::string>(v_); }
  double number() const {
    return v_.index() == 2 ? double(std::get<std::int64_t>(v_)) : std::get<double>(v_);
  }
  bool boolean() const { return std::get<bool>(v_); }

  using Variant =
      std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Object>;
  const Variant& variant() const { return v_; }

 private:
  Variant v_;
};

/// JSON text, two-space indent, ends with a newline. Numbers read back to the same double; nan and
/// the infinities, which JSON lacks, become the strings "nan", "inf", "-inf". Text that is not
/// UTF-8 has the bad bytes replaced.
std::string to_json(const Value& v, int indent = 2);

}  // namespace whirl::io
