#include <core/error.hpp>
#include <core/types.hpp>
#include <io/file.hpp>
#include <io/plain_csv.hpp>
#include <io/table_file.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

// Longest shortest form of a double: sign, 17 digits, point, exponent e-308; and a separator.
constexpr std::size_t widest_value = 26;

char* put(char* p, double x) {
  if (std::isnan(x)) return static_cast<char*>(std::memcpy(p, "nan", 3)) + 3;
  return std::to_chars(p, p + widest_value, x).ptr;
}

std::string csv_text(std::string_view s) {
  if (s.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(s);
  std::string q = "\"";
  for (const char c : s) {
    if (c == '"') q += '"';
    q += c;
  }
  return q + '"';
}

std::string heading(const std::string& name, const std::string& unit) {
  return csv_text(unit.empty() ? name : name + " [" + unit + "]");
}

std::string header_line(std::span<const Channel> channels) {
  std::string h;
  for (const auto& c : channels)
    for (std::size_t k = 0; k < c.width(); ++k) {
      if (!h.empty()) h += ',';
      h += heading(c.column(k), c.unit);
    }
  return h + "\n";
}

class CsvSeries final : public TimeSeries {
 public:
  CsvSeries(fs::path file, SeriesOptions options)
      : path_(std::move(file)),
        options_(options),
        out_(options.buffer_bytes) {}

  void begin(std::span<const Channel> channels) override {
    prepare(channels);
    rows_ = 0;
    out_.create(path_, header_line(channels));
  }

  void resume(std::span<const Channel> channels, std::uint64_t rows) override {
    prepare(channels);
    // in pieces: the file may be larger than the memory
    std::ifstream in(path_, std::ios::binary);
    if (!in) io_failure(path_, "cannot read", errno);
    const std::string head = header_line(channels);
    std::string text(head.size(), '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (text != head) io_failure(path_, "the columns asked for are not those of");
    std::uint64_t at = head.size();
    text.resize(std::size_t{1} << 20);
    for (std::uint64_t k = 0; k < rows;) {
      in.read(text.data(), static_cast<std::streamsize>(text.size()));
      const std::string_view piece(text.data(), static_cast<std::size_t>(in.gcount()));
      if (piece.empty()) io_failure(path_, "fewer rows than the checkpoint knows in");
      std::size_t p = 0;
      for (; k < rows; ++k) {
        const std::size_t end = piece.find('\n', p);
        if (end == std::string_view::npos) break;
        p = end + 1;
      }
      at += k < rows ? piece.size() : p;
    }
    rows_ = rows;
    out_.reopen(path_, at);
  }

  void append(std::span<const double> row) override {
    if (row.size() != scale_.size() || !out_.is_open())
      throw std::logic_error("TimeSeries: row of the wrong length, or not begun");
    char* const start = out_.reserve(row.size() * widest_value + 1);
    char* p = start;
    for (std::size_t k = 0; k < row.size(); ++k) {
      p = put(p, scale_[k] == 1.0 ? row[k] : scale_[k] * row[k]);
      *p++ = ',';
    }
    p[-1] = '\n';
    out_.commit(static_cast<std::size_t>(p - start));
    ++rows_;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_flush_ > flush_every_) hand_over();
  }

  void flush() override {
    out_.sync();
    last_flush_ = std::chrono::steady_clock::now();
  }
  void close() override { out_.close(); }
  std::uint64_t rows() const override { return rows_; }

 private:
  /// To the operating system: readers see it.
  void hand_over() {
    out_.flush();
    last_flush_ = std::chrono::steady_clock::now();
  }
  void prepare(std::span<const Channel> channels) {
    scale_.clear();
    for (const auto& c : channels)
      scale_.insert(scale_.end(), c.width(), c.scale);
    if (scale_.empty()) throw std::logic_error("TimeSeries: no channels");
    flush_every_ = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(options_.flush_seconds));
    last_flush_ = std::chrono::steady_clock::now();
  }
  fs::path path_;
  SeriesOptions options_;
  AppendFile out_;
  std::vector<double> scale_;
  std::uint64_t rows_ = 0;
  std::chrono::steady_clock::time_point last_flush_;
  std::chrono::steady_clock::duration flush_every_{};
};

// Splits one record that starts at `at` into cells; returns the position after its newline, or npos
// when the record has no newline yet.
std::size_t read_record(const std::string& text, std::size_t at, std::vector<std::string>& cells) {
  cells.assign(1, {});
  bool in_quotes = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (in_quotes) {
      if (c != '"')
        cells.back() += c;
      else if (at + 1 < text.size() && text[at + 1] == '"') {
        cells.back() += '"';
        ++at;
      } else
        in_quotes = false;
    } else if (c == '"')
      in_quotes = true;
    else if (c == ',')
      cells.emplace_back();
    else if (c == '\n')
      return at + 1;
    else if (c != '\r')
      cells.back() += c;
  }
  return std::string::npos;
}

/// False of text, which leaves x at NaN.
bool read_number(const std::string& cell, double& x) {
  x = nan;
  const char* end = cell.data() + cell.size();
  const auto r = std::from_chars(cell.data(), end, x);
  if (r.ec == std::errc{} && r.ptr == end) return true;
  x = nan;
  return false;
}

struct Heading {
  std::string name, unit;
};

Heading heading_of(const std::string& cell) {
  const auto open = cell.rfind(" [");
  const bool has_unit = open != std::string::npos && cell.back() == ']';
  if (!has_unit) return {cell, ""};
  return {cell.substr(0, open), cell.substr(open + 2, cell.size() - open - 3)};
}

/// Hands the cells of each whole row to `row`, after those of the header to `header`.
template <class Header, class Row>
void for_each_row(const fs::path& file, Header header, Row row) {
  const std::string text = read_text(file);
  std::vector<std::string> cells;
  std::size_t at = read_record(text, 0, cells);
  if (at == std::string::npos) io_failure(file, "no header line in");
  header(cells);
  const std::size_t width = cells.size();
  while ((at = read_record(text, at, cells)) != std::string::npos) {
    if (cells.size() != width)
      io_failure(file, "a row with " + std::to_string(cells.size()) + " cells in");
    row(cells);
  }
}

}  // namespace

TimeSeriesPtr make_plain_csv_series(fs::path file, SeriesOptions options) {
  return std::make_unique<CsvSeries>(std::move(file), options);
}

const std::vector<double>& Columns::operator[](std::string_view name) const {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (names[k] == name) return values[k];
  throw Error(Exit::io, Diagnostic{Diagnostic::Severity::error,
                                   "E91",
                                   "no column '" + std::string(name) + "'",
                                   {},
                                   Where{}});
}

Columns read_csv(const fs::path& file) {
  Columns c;
  const auto header = [&c](const std::vector<std::string>& cells) {
    for (const auto& cell : cells) {
      Heading h = heading_of(cell);
      c.names.push_back(std::move(h.name));
      c.units.push_back(std::move(h.unit));
    }
    c.values.resize(c.names.size());
  };
  for_each_row(file, header, [&c](const std::vector<std::string>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k)
      read_number(cells[k], c.values[k].emplace_back());
  });
  return c;
}

TableFile read_table(const fs::path& file) {
  TableFile t;
  std::vector<bool> has_text;
  const auto header = [&](const std::vector<std::string>& cells) {
    for (const auto& cell : cells) {
      Heading h = heading_of(cell);
      t.columns.push_back({std::move(h.name), std::move(h.unit), {}, {}});
    }
    has_text.resize(cells.size(), false);
  };
  for_each_row(file, header, [&](const std::vector<std::string>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const bool is_number = read_number(cells[k], t.columns[k].numbers.emplace_back());
      has_text[k] = has_text[k] || !is_number;
    }
  });
  if (std::find(has_text.begin(), has_text.end(), true) == has_text.end()) return t;
  // a second reading, for these columns alone: histories, which are long, have none
  for_each_row(
      file, [](const std::vector<std::string>&) {},
      [&](const std::vector<std::string>& cells) {
        for (std::size_t k = 0; k < cells.size(); ++k)
          if (has_text[k]) t.columns[k].texts.push_back(cells[k]);
      });
  return t;
}

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size()) throw std::logic_error("Table: a row needs one cell a column");
  rows.push_back(std::move(row));
}

void write_csv(const fs::path& file, const Table& table) {
  std::string s;
  for (std::size_t k = 0; k < table.columns.size(); ++k)
    s += (k ? "," : "") + heading(table.columns[k].name, table.columns[k].unit);
  s += '\n';
  char buffer[widest_value];
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (k) s += ',';
      if (row[k].is_text)
        s += csv_text(row[k].text);
      else
        s.append(buffer, put(buffer, row[k].number));
    }
    s += '\n';
  }
  write_atomic(file, s);
}

}  // namespace whirl::io
