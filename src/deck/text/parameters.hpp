// [parameters] and ${name}: substitution by value where the text is the parameter alone, else in
// the text.
#pragma once
#include <deck/text/document.hpp>
#include <map>
#include <set>

namespace whirl::deck {

class Parameters {
 public:
  /// Takes the table [parameters]; `builtin` names exist without being written ("deck" = name of
  /// the deck file). varied: names that a map puts other values in for, kept in Value::varied.
  Parameters(const Value* table, std::map<std::string, std::string> builtin,
             std::set<std::string> varied = {});

  enum class Use { quantity /* put in parentheses when part of a longer text */, text };
  /// `v` with its ${...} replaced (deep for lists is the caller's business). Unreadable when that
  /// failed; reported once.
  Value expand(const Value& v, Use use, Diagnostics& diagnostics);
  /// Warns about parameters that were never used.
  void warn_unused(Diagnostics& diagnostics) const;
  /// [parameters] of a resolved deck: those that were used and depend on a varied one. Empty: none.
  Value varied_table() const;

 private:
  struct Entry {
    Value value;
    Spot spot;
    bool used = false, expanding = false;
  };
  Value value_of(const std::string& name, const Spot& use_at, Diagnostics& diagnostics);
  std::map<std::string, Entry> entries_;
  std::map<std::string, std::string> builtin_;
  std::set<std::string> varied_;
};

}  // namespace whirl::deck
