// A deck as a tree of values, each with its place in the text. Independent of the TOML library
// (toml.cpp alone knows it).
#pragma once
#include <deck/text/sources.hpp>
#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

namespace whirl::deck {

struct Member;

struct Value {
  enum class Kind {
    boolean,
    integer,
    real,
    text,
    date,
    array,
    table,
    unreadable /* reported already */
  };
  Kind kind = Kind::table;
  Spot spot;
  bool boolean = false;
  std::int64_t integer = 0;
  double real = 0;
  std::string text;
  /// The same as text with the parameters that a map varies left in, "${c} N.s/m"; empty: none is in
  /// it. What a resolved deck shows.
  std::string varied;
  std::vector<Value> items;     ///< of an array
  std::vector<Member> members;  ///< of a table, in the order of the text
  /// Cells of a table with a header: the unit in the column title, and the title's place. Null
  /// elsewhere.
  const struct ColumnUnit* column = nullptr;

  bool is_table() const { return kind == Kind::table; }
  bool is_array() const { return kind == Kind::array; }
  bool is_text() const { return kind == Kind::text; }
  bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
  double number() const { return kind == Kind::integer ? static_cast<double>(integer) : real; }
  const Member* find(std::string_view key) const;
  Member* find(std::string_view key);
  Member& add(std::string key, Value v, Spot key_spot = {});

  static Value of_text(std::string s, Spot spot = {});
  static Value of_number(double x, Spot spot = {});
  static Value of_integer(std::int64_t i, Spot spot = {});
  static Value of_flag(bool b, Spot spot = {});
  static Value make_array(Spot spot = {});
  static Value make_table(Spot spot = {});
};

struct ColumnUnit {
  std::string unit;
  bool given = false;  ///< the title has a unit
  Spot spot;           ///< of the title
};

struct Member {
  std::string key;
  Spot spot;  ///< of the key
  Value value;
  bool moves = true;  ///< of a resolved deck: motion may depend on it (Key::moves)
};

/// "a number", "text", "a list", ...
const char* name_of(Value::Kind k);

/// Diagnostics of one reading, sorted by place and without repetitions when taken. Errors beyond
/// the first `limit` are counted and not kept: nobody reads them, and a wholly wrong table has a
/// million.
class Diagnostics {
 public:
  static constexpr int limit = 200;
  void error(std::string code, const Spot& spot, std::string message, std::string hint = {},
             std::string entity = {});
  void warning(std::string code, const Spot& spot, std::string message, std::string hint = {},
               std::string entity = {});
  int errors() const { return errors_; }
  /// Long lists need not be read further: what is wrong with them would not be shown.
  bool full() const { return kept_ >= limit; }
  /// With a note at the end when errors were left out.
  std::vector<Diagnostic> take(const Sources& sources);

 private:
  /// Whether this is said for the first time.
  bool fresh(const std::string& code, const Spot& spot, const std::string& message);
  void add(Diagnostic::Severity severity, std::string code, const Spot& spot, std::string message,
           std::string hint, std::string entity);
  struct Entry {
    Diagnostic d;
    Spot spot;
  };
  std::vector<Entry> list_;
  std::unordered_set<std::string> seen_;  ///< place, code and message of what is in list_
  int errors_ = 0;                        ///< repetitions included
  int kept_ = 0, warnings_ = 0;
};

/// A text as a document. Mistakes are reported and stepped over, so that one reading finds them
/// all.
struct Document {
  Value root;
  bool complete =
      true;  ///< false: reading stopped at a mistake; what is in root is not to be judged
  bool damaged = false;  ///< lines were left out: missing keys are not to be reported
};
Document parse_toml(const Sources& sources, int source, Diagnostics& diagnostics);
/// The value of a --set argument: TOML when it is that, else the text itself.
Value parse_set_value(std::string_view text, const Spot& spot);

/// TOML text of a table: scalars and lists first, then [tables] and [[lists of tables]].
std::string write_toml(const Value& root);

/// The names nearest in spelling to `word`, best first (at most `count`), for "did you mean".
std::vector<std::string> nearest(std::string_view word, const std::vector<std::string>& names,
                                 std::size_t count = 1);

}  // namespace whirl::deck
