// [parameters] and ${name}: substitution by value where the text is the parameter alone, else in
// the text.
#pragma once
#include <deck/text/document.hpp>
#include <map>

namespace whirl::deck {

class Parameters {
 public:
  /// Takes the table [parameters]; `builtin` names exist without being written ("deck" = name of
  /// the deck file).
  Parameters(const Value* table, std::map<std::string, std::string> builtin);

  enum class Use { quantity /* put in parentheses when part of a longer text */, text };
  /// `v` with its ${...} replaced (deep for lists is the caller's business). Unreadable when that
  /// failed; reported once.
  Value expand(const Value& v, Use use, Diagnostics& diagnostics);
  /// Warns about parameters that were never used.
  void warn_unused(Diagnostics& diagnostics) const;

 private:
  struct Entry {
    Value value;
    Spot spot;
    bool used = false, expanding = false;
  };
  Value value_of(const std::string& name, const Spot& use_at, Diagnostics& diagnostics);
  std::map<std::string, Entry> entries_;
  std::map<std::string, std::string> builtin_;
};

}  // namespace whirl::deck
