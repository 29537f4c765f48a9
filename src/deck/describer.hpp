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
  int count = -1;  ///< of lists of fixed length
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

  bool quantity(const Key&, double&, const char* unit, Range, const char*) override;
  bool integer(const Key&, int&, Range, const char*) override;
  bool flag(const Key&, bool&, const char*) override;
  bool text(const Key&, std::string&, const char*) override;
  bool texts(const Key&, std::vector<std::string>&, const char*) override;
  bool quantities(const Key&, std::vector<double>&, const char* unit, Range, int count, const char*,
                  const char* per) override;
  bool matrix(const Key&, Matrix<6>&, const char*, const char*, const char*, const char*) override;
  bool option(const Key&, int& index, std::span<const Option>, const char*) override;
  bool options(const Key&, std::vector<std::string>&, std::span<const Option>,
               const char*) override;
  bool name(model::Entity&, const char* kind) override;
  bool location(const Key&, model::Location&, const char*) override;
  bool material(const Key&, std::size_t&, const char*) override;
  bool shaft(const Key&, std::size_t&, const char*) override;
  bool step(const Key&, std::string&, const char*) override;
  void free_table(const Key&, const char*) override;
  bool table(const Key&, const std::function<void(Visitor&)>&, const char*) override;
  void list(const Key&, const ListBody&, const char*) override;
  bool rows(const ListBody&, bool must, const char*) override;
  void alternatives(const Key&, std::span<const Alternative>, const char*) override;
  bool either(const Key&, double&, const char* unit, bool&, const std::function<void(Visitor&)>&,
              const char*) override;
  bool clean() const override { return false; }
  bool given(const char*) const override { return false; }
  void error(const char*, const char*, std::string, std::string) override {}
  void warning(const char*, const char*, std::string, std::string) override {}
  Where where() const override { return {}; }
  const model::Model& model() const override;

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
