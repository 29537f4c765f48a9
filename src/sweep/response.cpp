#include <sweep/response.hpp>
#include <core/error.hpp>
#include <core/types.hpp>
#include <io/table_file.hpp>
#include <sweep/summary_entries.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace whirl::sweep {
namespace {

struct PickName {
  const char* name;
  Response::Pick pick;
};
constexpr PickName picks[] = {{"last", Response::Pick::last},
                              {"min", Response::Pick::least},
                              {"max", Response::Pick::largest},
                              {"absmax", Response::Pick::largest_magnitude},
                              {"mean", Response::Pick::mean}};

Error bad_response(const std::string& text, const std::string& problem) {
  return Error(
      Exit::usage,
      Diagnostic{Diagnostic::Severity::error, "E99",
                 fmt::format("--response '{}': {}", text, problem),
                 "[NAME=]TABLE:COLUMN[:PICK], PICK a row from 1, last, min, max, absmax or "
                 "mean; `whirl sweep DECK --list` shows tables and columns",
                 Where{}});
}

/// Whether the row of a cell that is no finite number has nothing to give.
bool is_absent(const io::TableFile::Column& column, std::size_t row, const NanMeaning& nan) {
  if (!std::isnan(column.numbers[row])) return false;
  const bool is_text = !column.texts.empty() && column.texts[row] != "nan";
  return is_text ? column.texts[row].empty() : nan.absence;
}

std::string with_meaning(const std::string& failure, const NanMeaning& nan) {
  return nan.text.empty() ? failure : failure + ": " + nan.text;
}

/// What stands against a column as it is; else the values that count.
std::string finite_values(const io::TableFile::Column& column, const NanMeaning& nan,
                          std::vector<double>& out) {
  const std::size_t rows = column.numbers.size();
  std::size_t missing = 0;
  for (std::size_t row = 0; row < rows; ++row)
    if (std::isfinite(column.numbers[row]))
      out.push_back(column.numbers[row]);
    else
      missing += !is_absent(column, row, nan);
  if (rows == 0) return "the table has no rows";
  if (out.empty()) return with_meaning("no value in the column is finite", nan);
  if (missing == 0) return "";
  return with_meaning(fmt::format("no finite value in {} of {} rows", missing, rows), nan);
}

double picked(Response::Pick pick, const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  switch (pick) {
    case Response::Pick::least: return *least;
    case Response::Pick::largest: return *largest;
    case Response::Pick::largest_magnitude: return std::max(std::abs(*least), std::abs(*largest));
    case Response::Pick::mean: {
      double sum = 0;
      for (double x : values)
        sum += x;
      return sum / static_cast<double>(values.size());
    }
    case Response::Pick::row:
    case Response::Pick::last: break;
  }
  return nan;
}

bool is_titled(const std::string& asked, const std::string& name, const std::string& unit) {
  return asked == name || asked == name + " [" + unit + "]";
}

const io::TableFile::Column* column_of(const io::TableFile& table, const std::string& title) {
  const auto found =
      std::find_if(table.columns.begin(), table.columns.end(),
                   [&](const auto& column) { return is_titled(title, column.name, column.unit); });
  return found == table.columns.end() ? nullptr : &*found;
}

/// What a cell of a column with text says that is no number.
std::string word_in(const io::TableFile::Column& column, std::size_t row) {
  if (column.texts.empty() || std::isfinite(column.numbers[row])) return {};
  const std::string& text = column.texts[row];
  return text == "nan" || text == "inf" || text == "-inf" ? std::string() : text;
}

void answer_by_row(const Response& r, const io::TableFile::Column& column, Answer& a) {
  const std::size_t rows = column.numbers.size();
  const std::size_t row = r.pick == Response::Pick::last ? rows : r.row;
  if (row == 0 || row > rows) {
    a.failure = fmt::format("no row {}: the table has {}", r.row, rows);
    return;
  }
  a.word = word_in(column, row - 1);
  if (!a.word.empty()) return;
  if (std::isfinite(column.numbers[row - 1]))
    a.value = column.numbers[row - 1];
  else
    a.failure = fmt::format("no finite value in row {}", row);
}

Answer answer_of_summary(const Response& r, const std::filesystem::path& file) {
  Answer a{nan, "", ""};
  const std::vector<SummaryEntry> entries = read_summary(file);
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const SummaryEntry& e) {
    return is_titled(r.column, e.path, e.unit);
  });
  if (entry == entries.end()) {
    a.failure = fmt::format("no entry '{}' in the summary", r.column);
    return a;
  }
  a.unit = entry->unit;
  a.word = entry->word;
  if (!a.word.empty()) return a;
  a.value = entry->number;
  if (!std::isfinite(a.value)) a.failure = "the value is not finite";
  return a;
}

}  // namespace

Response read_response(const std::string& text) {
  Response r;
  const auto equals = text.find('=');
  const std::string rest = equals == std::string::npos ? text : text.substr(equals + 1);
  r.name = equals == std::string::npos ? text : text.substr(0, equals);
  if (!r.name.empty() &&
      std::string_view("=+-@\t\r").find(r.name.front()) != std::string_view::npos)
    throw bad_response(
        text,
        fmt::format("the name begins with '{}': it heads a column of tables, where spreadsheets "
                    "would take it for a formula",
                    r.name.front()));
  const auto first = rest.find(':');
  if (first == std::string::npos || first == 0) throw bad_response(text, "no table and column");
  r.table = rest.substr(0, first);
  if (r.table.ends_with(".csv")) r.table.resize(r.table.size() - 4);
  if (r.table.find("..") != std::string::npos || r.table.starts_with('/'))
    throw bad_response(text, "a table stands in the results folder");
  r.column = rest.substr(first + 1);
  const auto last = r.column.rfind(':');
  if (last != std::string::npos) {
    const std::string pick = r.column.substr(last + 1);
    r.column.resize(last);
    const auto* known = std::find_if(std::begin(picks), std::end(picks),
                                     [&](const PickName& p) { return pick == p.name; });
    const auto read = std::from_chars(pick.data(), pick.data() + pick.size(), r.row);
    if (known != std::end(picks))
      r.pick = known->pick;
    else if (read.ec != std::errc{} || read.ptr != pick.data() + pick.size() || r.row == 0)
      throw bad_response(text, fmt::format("'{}' picks no value", pick));
  }
  if (r.column.empty() || r.name.empty()) throw bad_response(text, "an empty name");
  return r;
}

std::string file_of(const Response& r) {
  return r.table + (r.table == summary_table ? ".json" : ".csv");
}

Answer answer(const Response& r, const std::filesystem::path& results,
              const NanMeanings& meanings) {
  Answer a{nan, "", ""};
  const auto file = results / file_of(r);
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) {
    a.failure = fmt::format("no table '{}'", r.table);
    return a;
  }
  if (r.table == summary_table) return answer_of_summary(r, file);
  const io::TableFile table = io::read_table(file);
  const io::TableFile::Column* column = column_of(table, r.column);
  if (column == nullptr) {
    a.failure = fmt::format("no column '{}'", r.column);
    return a;
  }
  a.unit = column->unit;
  if (r.pick == Response::Pick::row || r.pick == Response::Pick::last) {
    answer_by_row(r, *column, a);
    return a;
  }
  const auto meaning = meanings.find(file_of(r));
  std::vector<double> values;
  a.failure =
      finite_values(*column, meaning == meanings.end() ? NanMeaning() : meaning->second, values);
  if (a.failure.empty()) a.value = picked(r.pick, values);
  return a;
}

namespace {

std::string listed(const std::string& table, const std::string& name, const std::string& unit,
                   bool is_word) {
  const std::string of_unit = unit.empty() ? "" : " [" + unit + "]";
  return fmt::format("{}:{}{}{}", table, name, of_unit, is_word ? " (words)" : "");
}

void list_columns(const std::filesystem::path& file, std::vector<std::string>& out) {
  const io::TableFile table = io::read_table(file);
  for (const io::TableFile::Column& column : table.columns) {
    const bool numbers = std::any_of(column.numbers.begin(), column.numbers.end(),
                                     [](double x) { return std::isfinite(x); });
    const bool texts = std::any_of(column.texts.begin(), column.texts.end(),
                                   [](const std::string& text) { return !text.empty(); });
    if (numbers || texts)
      out.push_back(listed(file.stem().string(), column.name, column.unit, !numbers));
  }
}

/// Without times, which no model decides.
void list_summary(const std::filesystem::path& file, std::vector<std::string>& out) {
  for (const SummaryEntry& e : read_summary(file))
    if (e.path.find("run time") == std::string::npos)
      out.push_back(listed(summary_table, e.path, e.unit, !e.word.empty()));
}

}  // namespace

std::vector<std::string> list_responses(const std::filesystem::path& results) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(results))
    if (entry.path().extension() == ".csv") list_columns(entry.path(), out);
  std::sort(out.begin(), out.end());
  const std::filesystem::path summary = results / "summary.json";
  std::error_code ec;
  if (std::filesystem::exists(summary, ec)) list_summary(summary, out);
  return out;
}

}  // namespace whirl::sweep
