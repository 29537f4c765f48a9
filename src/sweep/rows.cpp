#include <sweep/rows.hpp>
#include <core/error.hpp>
#include <core/types.hpp>
#include <io/file.hpp>

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace whirl::sweep {
namespace {

/// FNV-1a, 64 bits: against lines cut short and damaged, not against intent.
std::uint64_t checksum(std::string_view s) {
  std::uint64_t h = 0xcbf29ce484222325U;
  for (const char c : s)
    h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return h;
}

/// Tabs part the cells, line ends the rows.
std::string cell(std::string s) {
  for (char& c : s)
    if (c == '\t' || c == '\n' || c == '\r') c = ' ';
  return s;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> out;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= line.size(); ++k)
    if (k == line.size() || line[k] == '\t') {
      out.push_back(line.substr(begin, k - begin));
      begin = k + 1;
    }
  return out;
}

template <class Number>
bool read(std::string_view s, Number& x) {
  const auto r = std::from_chars(s.data(), s.data() + s.size(), x);
  return r.ec == std::errc{} && r.ptr == s.data() + s.size();
}

constexpr std::size_t fixed_cells = 5, cells_per_answer = 3;

/// Stands before a word, where else a number stands.
constexpr char before_words = '"';

std::string cell_of_value(const Answer& a) {
  return a.word.empty() ? fmt::format("{}", a.value) : before_words + cell(a.word);
}

/// False: neither a word nor a number.
bool read_value(std::string_view text, Answer& a) {
  if (text.starts_with(before_words))
    a.word = text.substr(1);
  else if (text != "nan")
    return read(text, a.value);
  return true;
}

}  // namespace

std::string line_of(const Row& row) {
  std::string line = fmt::format("{}\t{}\t{}\t{}\t{:.3f}", row.run, row.exit, cell(row.code),
                                 cell(row.message), row.cpu);
  for (const Answer& a : row.answers)
    line += fmt::format("\t{}\t{}\t{}", cell_of_value(a), cell(a.unit), cell(a.failure));
  return line + fmt::format("\t{:016x}\n", checksum(line));
}

std::optional<Row> row_of(std::string_view line) {
  const auto tab = line.rfind('\t');
  if (tab == std::string_view::npos) return std::nullopt;
  if (fmt::format("{:016x}", checksum(line.substr(0, tab))) != line.substr(tab + 1))
    return std::nullopt;
  const auto cells = cells_of(line.substr(0, tab));
  if (cells.size() < fixed_cells || (cells.size() - fixed_cells) % cells_per_answer != 0)
    return std::nullopt;
  Row row;
  if (!read(cells[0], row.run) || !read(cells[1], row.exit) || !read(cells[4], row.cpu))
    return std::nullopt;
  row.code = cells[2];
  row.message = cells[3];
  for (std::size_t k = fixed_cells; k < cells.size(); k += cells_per_answer) {
    Answer a{nan, std::string(cells[k + 1]), std::string(cells[k + 2])};
    if (!read_value(cells[k], a)) return std::nullopt;
    row.answers.push_back(std::move(a));
  }
  return row;
}

RowsRead read_rows(const std::filesystem::path& file) {
  RowsRead out;
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) return out;
  const std::string text = io::read_text(file);
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    auto row = row_of(std::string_view(text).substr(begin, end - begin));
    if (!row) break;  // what follows a damaged line is done again
    out.rows.insert_or_assign(row->run, std::move(*row));
    begin = end + 1;
    out.bytes = begin;
  }
  return out;
}

}  // namespace whirl::sweep
