// The visitor that collects: what keys a deck has, without reading one. The JSON schema, the
// reference documentation, templates and "did you mean" come from it.
#pragma once
#include <deck/suggest.hpp>
#include <deck/visitor.hpp>
#include <memory>

namespace whirl::deck {

struct TableInfo;

struct KeyInfo {
  enum class Kind {
    quantity,
    integer,
    flag,
    text,
    texts,
    quantities,
    matrix,
    option,
    options,
    location,
    reference,
    table,
    list,
    alternatives,
    either,
    free_table
  };
  std::string name;
  Kind kind = Kind::text;
  std::string doc;
  std::string unit;  ///< of quantities; "" = plain number
  bool required = false;
  bool listed = true;        ///< in the reference; see Key
  bool plain_zero = false;   ///< of a quantity: 0 needs no unit
  std::string default_text;  ///< as written in a deck; empty when there is none
  std::string absent;        ///< what holds when left out, where the default does not say it
  Range range;
  int count = -1;     ///< of lists of fixed length
  bool each = false;  ///< of a quantity: or a list of them, one for each of several things
  std::vector<Option> words;
  std::shared_ptr<TableInfo> table;  ///< of tables, lists of tables, and `either`
  struct Choice {
    std::string name, doc;
    std::shared_ptr<TableInfo> table;
  };
  std::vector<Choice> choices;  ///< of alternatives: further keys of the same table
};

struct TableInfo {
  std::vector<KeyInfo> keys;
  std::shared_ptr<TableInfo>
      row;  ///< keys usable as columns of `columns`/`rows`/`file`; null = no rows here
  bool row_required = false;
  std::string row_doc;
};

class Describer : public Visitor {
 public:
  explicit Describer(TableInfo& root) { tables_.push_back(&root); }

#include <deck/visitor_overrides.inl>

 private:
  KeyInfo& add(const Key&, KeyInfo::Kind, const char* doc);
  std::shared_ptr<TableInfo> collect(const std::function<void(Visitor&)>& body);
  std::vector<TableInfo*> tables_;
};

/// The keys of a whole deck.
const TableInfo& deck_keys();
/// The names of all keys of one table, alternatives and columns left out.
std::vector<std::string> key_names(const std::function<void(Visitor&)>& body);
/// Those of them that can be columns of a table, with the values they take: one value each.
std::vector<KeyShape> column_shapes(const std::function<void(Visitor&)>& body);
/// Reference documentation of every table and key, Markdown.
std::string reference_markdown();
/// Table of units, Markdown.
std::string units_markdown();

}  // namespace whirl::deck
