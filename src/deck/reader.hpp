// The visitor that reads: fills the model from the document, reports every mistake, and writes the
// resolved deck on the way (what the user wrote with parameters put in, plus every default made
// explicit, plus the tables of CSV files).
#pragma once
#include <core/units.hpp>
#include <deck/text/parameters.hpp>
#include <deck/suggest.hpp>
#include <deck/visitor.hpp>
#include <deque>
#include <map>
#include <optional>

namespace whirl::deck {

class Reader : public Visitor {
 public:
  Reader(Sources& sources, Diagnostics& diagnostics, Parameters& parameters,
         const Document& document, model::Model& model);

  /// Describes the whole model into the one given.
  void read();
  Value take_resolved() { return std::move(resolved_); }
  bool files_allowed = true;  ///< false: naming a file is a mistake (texts from untrusted sources)

#include <deck/visitor_overrides.inl>

 private:
  struct Scope {
    const Value* table = nullptr;    ///< what is read
    Value* resolved = nullptr;       ///< what is written; null for rows
    std::vector<std::string> known;  ///< keys asked for so far
    std::vector<KeyShape> shapes;    ///< what values those of them take that are not choices
    std::map<std::string, std::map<std::string, Spot>>
        names;  ///< names of the things in this table's lists, by kind
    int errors_at_start = 0;
    bool dirty = false;    ///< holds something reported before
    bool any_key = false;  ///< unknown keys are not reported (their table has an unknown type)
    std::string path;      ///< "output" in [output]; empty at the top
    std::string entity;    ///< "disk 'impeller'"
    const Spot* header = nullptr;  ///< of rows: where missing columns are reported
    struct Other {
      std::string key;
      Alternative alternative;
    };
    std::vector<Other> others;  ///< alternatives not chosen and the key that chooses, for hints
  };
  struct PendingStep {
    Spot spot;
    std::string name;
    int from = -1; /**< index of the step that refers, or -1 */
  };
  Scope& scope() { return scopes_.back(); }
  const Scope& scope() const { return scopes_.back(); }

  /// Notes the key as known and finds it; reports when it is required and missing.
  const Member* find(const Key&);
  void put(const Key&, Value);
  void note_shape(const Key& k, KeyShape::Kind kind, const char* unit = "") {
    scope().shapes.push_back({k.name, kind, unit});
  }
  /// The resolved deck shows what holds without the key.
  static bool shows_default(const Key& k) { return !k.absent && !k.required; }
  void put_default(const Key& k, Value v) {
    if (shows_default(k)) put(k, std::move(v));
  }
  void problem(const char* code, const Spot&, std::string message, std::string hint = {});
  bool wrong_type(const char* key, const Value&, const char* wanted, std::string hint = {});
  Value expand(const Value& v, Parameters::Use use = Parameters::Use::text);
  /// The number v in the unit: that of its column, or none where none is needed.
  std::optional<double> in_unit(const char* key, const Value& v, const char* unit);
  /// The text v in the unit; given: as it stands in the deck.
  std::optional<double> convert(const char* key, const Value& v, const Value& given,
                                const char* unit);
  /// One quantity; false when reported. `shown` gets what goes into the resolved deck.
  bool read_quantity(const char* key, const Value&, const char* unit, Range, double& target,
                     Value& shown);
  bool read_text(const char* key, const Value&, std::string& target);
  bool read_option(const char* key, const Value&, std::span<const Option>, int& index);
  bool read_list(const Key&, const Member&, int count, Value& list);
  void close_table();
  void in_table(const char* key, const Value&, Value* resolved, const Spot* header,
                const std::function<void(Visitor&)>& body);
  /// Path of a key of the present table, as it stands in a header: "output.vtk".
  std::string path_of(const char* key) const;
  void read_row(const std::vector<ColumnUnit*>& columns, const std::vector<std::string>& keys,
                std::vector<Value> cells, const Spot& row, const Spot& header, const ListBody&);
  bool read_titles(const std::vector<Value>& titles, const ListBody&,
                   std::vector<ColumnUnit*>& columns, std::vector<std::string>& keys);
  /// Reads the table that the deck names; its number among the sources, -1 when reported.
  int open_table(const Value& file);
  void read_rows_from_file(const Value& file, const ListBody&, Value& columns, Value& rows);
  void read_rows_from_deck(const Value& columns, const Value& rows, const ListBody&,
                           Value& out_columns, Value& out_rows);
  void settle_steps();

  Sources& sources_;
  Diagnostics& diagnostics_;
  Parameters& parameters_;
  const Document& document_;
  model::Model& model_;
  Value resolved_;
  std::deque<Scope> scopes_;
  std::deque<ColumnUnit> columns_;  ///< titles that cells point at
  std::deque<Value> expanded_;      ///< tables that came out of parameters
  std::map<std::pair<std::string, std::string>, units::Factor> factors_;
  std::vector<PendingStep> pending_steps_;
  /// The first error not said because its cause was.
  struct Withheld {
    std::string code;
    Spot spot;
    std::string message, hint, entity;
  };
  std::optional<Withheld> withheld_;
  bool shafts_bad_ = false;  ///< a shaft was reported: places on shafts are not judged
};

}  // namespace whirl::deck
