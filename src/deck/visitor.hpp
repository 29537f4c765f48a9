// One description of every table and key of a deck, from which everything else is made.
//
// For each entity of the model there is one function `describe(Visitor&, Entity&)`. It names the
// keys of its table with type, unit, range, default (the value the struct has) and explanation, and
// ends with the checks between keys. Two visitors walk it: the Reader fills the struct from a deck,
// reports what is wrong and writes the resolved deck; the Describer collects the keys for the JSON
// schema, the reference documentation, templates and suggestions.
//
// A new key is one line in its describe function; a new kind of bearing is one describe function
// and one line in the list of alternatives (see bearings.cpp).
#pragma once
#include <deck/text/document.hpp>
#include <model/model.hpp>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace whirl::deck {

/// A key and whether it must be there.
struct Key {
  Key(const char* n) : name(n) {}  // implicit: a plain key has the default its struct holds
  Key(const char* n, bool must, const char* without) : name(n), required(must), absent(without) {}
  const char* name;
  bool required = false;
  const char* absent =
      nullptr;  ///< what holds when the key is left out, where the default value does not say it
  bool plain_zero = false;  ///< a quantity: 0 needs no unit, nor the right one
  bool listed = true;       ///< false: one of a family that the reference explains as a whole
  bool moves = true;        ///< motion may depend on it; false: it says what is written, or when
                            ///< the run ends
};
inline Key required(const char* name) { return {name, true, nullptr}; }
inline Key optional(const char* name, const char* absent) { return {name, false, absent}; }
inline Key zero_without_unit(const char* name) {
  Key k(name);
  k.plain_zero = true;
  return k;
}

/// A key that no motion depends on: a resumed run may change it.
inline Key beside_motion(Key k) {
  k.moves = false;
  return k;
}

struct Range {
  double min = -infinity, max = infinity;
  bool open_min = false, open_max = false;
};
inline constexpr Range any{};
inline constexpr Range positive{0, infinity, true, false};
inline constexpr Range not_negative{0, infinity, false, false};
inline constexpr Range fraction{0, 1, false, false};
constexpr Range at_least(double x) { return {x, infinity, false, false}; }
constexpr Range between(double a, double b) { return {a, b, false, false}; }
/// "must be positive", "must lie between 0 and 1"
std::string text_of(const Range& r);
bool inside(const Range& r, double x);

struct Option {
  const char* name;
  const char* doc;
};

class Visitor;

/// A list of entities behind one interface: how many, add one, describe one.
struct ListBody {
  std::function<void(Visitor&)> add_and_describe;  ///< appends a default element and describes it
  std::function<void(Visitor&)> prototype;  ///< describes a default element that is thrown away
};

struct Alternative {
  const char* name;
  const char* doc;
  std::function<void(Visitor&)> body;  ///< selects the alternative in its variant and describes it
};

class Visitor {
 public:
  virtual ~Visitor() = default;

  // ---- values. Each returns whether the deck gives the key. A bad value is reported and leaves
  // the target unchanged.
  virtual bool quantity(const Key&, double& target, const char* unit, Range, const char* doc) = 0;
  bool number(const Key& k, double& target, Range r, const char* doc) {
    return quantity(k, target, "", r, doc);
  }
  virtual bool integer(const Key&, int& target, Range, const char* doc) = 0;
  virtual bool flag(const Key&, bool& target, const char* doc) = 0;
  virtual bool text(const Key&, std::string& target, const char* doc) = 0;
  virtual bool texts(const Key&, std::vector<std::string>& target, const char* doc) = 0;
  /// A list of quantities; `count` fixes its length when not negative. With `per`, item k is in
  /// unit/per^k (polynomials).
  virtual bool quantities(const Key&, std::vector<double>& target, const char* unit, Range,
                          int count, const char* doc, const char* per = nullptr) = 0;
  /// A quantity for all of several things alike, or a list of them, one for each: `each` is then what
  /// was `all`. The length of the list is the caller's to check; an empty one is a mistake.
  virtual bool one_or_each(const Key&, double& all, std::vector<double>& each, const char* unit,
                           Range, const char* doc) = 0;
  /// 6x6 in the order (x, y, z, rx, ry, rz): units of the translational, coupling and rotational
  /// entries. A plain 0 needs no unit here.
  virtual bool matrix(const Key&, Matrix<6>& target, const char* translation, const char* coupling,
                      const char* rotation, const char* doc) = 0;
  bool vector(const Key&, Vec3& target, const char* unit, const char* doc);
  /// One of a few words.
  virtual bool option(const Key&, int& index, std::span<const Option>, const char* doc) = 0;
  template <class Enum>
  bool choice(const Key& k, Enum& target, std::initializer_list<Option> options, const char* doc) {
    int i = static_cast<int>(target);
    const bool given = option(k, i, std::span(options.begin(), options.size()), doc);
    target = static_cast<Enum>(i);
    return given;
  }
  /// Several of a few words.
  virtual bool options(const Key&, std::vector<std::string>& target, std::span<const Option>,
                       const char* doc) = 0;

  // ---- references
  virtual bool name(model::Entity&, const char* kind) = 0;
  virtual bool location(const Key&, model::Location& target, const char* doc) = 0;
  virtual bool material(const Key&, std::size_t& index, const char* doc) = 0;
  virtual bool shaft(const Key&, std::size_t& index, const char* doc) = 0;
  virtual bool step(const Key&, std::string& target, const char* doc) = 0;

  // ---- tables in tables
  /// A table with keys of the user's own (parameters); read elsewhere.
  virtual void free_table(const Key&, const char* doc) = 0;
  virtual bool table(const Key&, const std::function<void(Visitor&)>& body, const char* doc) = 0;
  virtual void list(const Key&, const ListBody&, const char* doc) = 0;
  /// The table itself holds `columns` and `rows`, or `file` (CSV): one element a row, columns named
  /// like the element's keys. Returns whether it is given.
  virtual bool rows(const ListBody&, bool must, const char* doc) = 0;
  /// The word under `key` (usually "type") decides which further keys the table has.
  virtual void alternatives(const Key&, std::span<const Alternative>, const char* doc) = 0;
  /// A value that is either a quantity or a table.
  virtual bool either(const Key&, double& simple, const char* unit, bool& is_simple,
                      const std::function<void(Visitor&)>& body, const char* doc) = 0;

  template <class T>
  bool table(const Key& k, T& target, const char* doc) {
    return table(
        k, [&](Visitor& v) { describe(v, target); }, doc);
  }
  template <class T>
  bool table(const Key& k, std::optional<T>& target, const char* doc) {
    T value{};
    const bool given = table(
        k, [&](Visitor& v) { describe(v, value); }, doc);
    if (given) target = value;
    return given;
  }
  template <class T>
  void list(const Key& k, std::vector<T>& target, const char* doc) {
    list(k, body_of(target, T{}), doc);
  }
  /// `start`: what a new element looks like before its keys are read.
  template <class T>
  static ListBody body_of(std::vector<T>& target, T start) {
    return {[&target, start](Visitor& v) {
              target.push_back(start);
              describe(v, target.back());
            },
            [start](Visitor& v) {
              T t = start;
              describe(v, t);
            }};
  }
  template <class T, class... Ts>
  static Alternative alternative(const char* word, std::variant<Ts...>& target, const char* doc) {
    return {word, doc, [&target](Visitor& v) {
              if (!std::holds_alternative<T>(target)) target = T{};
              describe(v, std::get<T>(target));
            }};
  }

  // ---- checks between keys
  /// True while a deck is read and nothing in this table was reported yet: checks between keys make
  /// sense.
  virtual bool clean() const = 0;
  virtual bool given(const char* key) const = 0;
  /// Reports at the value of `key` (at the header of the table when the key is not there).
  virtual void error(const char* code, const char* key, std::string message,
                     std::string hint = {}) = 0;
  virtual void warning(const char* code, const char* key, std::string message,
                       std::string hint = {}) = 0;
  /// Where the present table stands.
  virtual Where where() const = 0;
  virtual const model::Model& model() const = 0;
};

// One function per entity, each in the file that describes its kind.
void describe(Visitor&, model::Model&);     // model.cpp
void describe(Visitor&, model::Material&);  // shaft.cpp
void describe(Visitor&, model::Shaft&);
void describe(Visitor&, model::Section&);
void describe(Visitor&, model::Disk&);  // attachments.cpp
void describe(Visitor&, model::Unbalance&);
void describe(Visitor&, model::Crack&);
void describe(Visitor&, model::PointLoad&);
void describe(Visitor&, model::Probe&);
void describe(Visitor&, model::InitialMotion&);
void describe(Visitor&, model::Bearing&);         // bearings.cpp
void describe(Visitor&, model::Joint&);           // joints.cpp
void describe(Visitor&, model::Foundation&);      // foundations.cpp
void describe(Visitor&, model::Drive&);           // drives.cpp
void describe(Visitor&, model::Step&);            // steps.cpp
void describe(Visitor&, model::ApiLateralStep&);  // steps_reports.cpp
void describe(Visitor&, model::ApiTorsionalStep&);
void describe(Visitor&, model::BalancingStep&);
void describe(Visitor&, model::VibrationZones&);
void describe(Visitor&, model::TitleBlock&);
void describe(Visitor&, model::Output&);  // output.cpp
void describe(Visitor&, model::VtkOutput&);
void describe(Visitor&, model::TrackingOutput&);  // postprocess.cpp
void describe(Visitor&, model::SpectraOutput&);
void describe(Visitor&, model::SweepPlan&);
void describe(Visitor&, model::BaseMotion&);  // base.cpp
void describe(Visitor&, model::BaseTurn&);
void describe(Visitor&, model::Event&);
/// A law of time given as a constant or as a table: laws.cpp. Returns whether it is given.
bool describe_law(Visitor&, const Key&, LawPtr& target, const char* unit, const char* doc);

}  // namespace whirl::deck
