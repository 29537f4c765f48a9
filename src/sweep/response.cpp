#include <sweep/response.hpp>
#include <core/error.hpp>
#include <core/types.hpp>
#include <io/results.hpp>

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

/// What stands against a column as it is; else the values that count.
std::string finite_values(const std::vector<double>& all, std::vector<double>& out) {
  for (double x : all)
    if (std::isfinite(x)) out.push_back(x);
  if (all.empty()) return "the table has no rows";
  if (out.empty()) return "no value in the column is finite";
  return "";
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

std::size_t column_of(const io::Columns& table, const std::string& title) {
  for (std::size_t k = 0; k < table.names.size(); ++k)
    if (title == table.names[k] || title == table.names[k] + " [" + table.units[k] + "]") return k;
  return table.names.size();
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

Answer answer(const Response& r, const std::filesystem::path& results) {
  Answer a{nan, "", ""};
  const auto file = results / (r.table + ".csv");
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) {
    a.failure = fmt::format("no table '{}'", r.table);
    return a;
  }
  const io::Columns table = io::read_csv(file);
  const std::size_t k = column_of(table, r.column);
  if (k == table.names.size()) {
    a.failure = fmt::format("no column '{}'", r.column);
    return a;
  }
  a.unit = table.units[k];
  const std::vector<double>& column = table.values[k];
  if (r.pick == Response::Pick::row || r.pick == Response::Pick::last) {
    const std::size_t row = r.pick == Response::Pick::last ? column.size() : r.row;
    if (row == 0 || row > column.size())
      a.failure = fmt::format("no row {}: the table has {}", r.row, column.size());
    else if (!std::isfinite(column[row - 1]))
      a.failure = fmt::format("no finite value in row {}", row);
    else
      a.value = column[row - 1];
    return a;
  }
  std::vector<double> values;
  a.failure = finite_values(column, values);
  if (a.failure.empty()) a.value = picked(r.pick, values);
  return a;
}

std::vector<std::string> list_responses(const std::filesystem::path& results) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(results)) {
    if (entry.path().extension() != ".csv") continue;
    const io::Columns table = io::read_csv(entry.path());
    for (std::size_t k = 0; k < table.names.size(); ++k) {
      const auto finite = std::count_if(table.values[k].begin(), table.values[k].end(),
                                        [](double x) { return std::isfinite(x); });
      if (finite == 0) continue;  // text
      out.push_back(fmt::format("{}:{}{}", entry.path().stem().string(), table.names[k],
                                table.units[k].empty() ? "" : " [" + table.units[k] + "]"));
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace whirl::sweep
