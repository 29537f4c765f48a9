// What a conversion has to say: left out, assumed, impossible.
#pragma once
#include <core/error.hpp>
#include <string>
#include <vector>

namespace whirl::convert {

class Notes {
 public:
  explicit Notes(std::string file) : file_(std::move(file)) {}
  /// Says once that something of `entity` was left out or assumed.
  void say(std::string message, std::string hint = {}, std::string entity = {}, int line = 0) {
    for (const Diagnostic& d : list_)
      if (d.message == message && d.where.entity == entity) return;
    list_.push_back({Diagnostic::Severity::warning, "W20", std::move(message), std::move(hint),
                     Where{file_, line, 0, 0, std::move(entity)}});
  }
  /// @throws Error (E42), always.
  [[noreturn]] void refuse(std::string message, std::string hint = {}, std::string entity = {},
                           int line = 0) const {
    throw Error(Exit::deck,
                Diagnostic{Diagnostic::Severity::error, "E42", std::move(message), std::move(hint),
                           Where{file_, line, 0, 0, std::move(entity)}});
  }
  const std::string& file() const { return file_; }
  std::vector<Diagnostic> take() { return std::move(list_); }
  const std::vector<Diagnostic>& list() const { return list_; }

 private:
  std::string file_;
  std::vector<Diagnostic> list_;
};

}  // namespace whirl::convert
