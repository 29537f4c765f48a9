// The only file that sees minizip and Expat.
#include <convert/workbook.hpp>

#include <deck/text/sources.hpp>
#include <expat.h>
#include <fmt/format.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

namespace whirl::convert {
namespace {

constexpr std::size_t largest_part = deck::max_table_bytes;
constexpr std::size_t most_columns = 16384;  // of the format
constexpr std::size_t most_rows = 1048576;

/// The parts of a zipped file.
class Archive {
 public:
  Archive(const std::filesystem::path& file, const Notes& notes)
      : notes_(notes),
        zip_(unzOpen64(file.c_str())) {
    if (!zip_) damaged("it is not a workbook of the kind .xlsx");
  }

  std::optional<std::string> part(const std::string& name) const {
    constexpr int as_it_is = 1;
    if (unzLocateFile(zip_.get(), name.c_str(), as_it_is) != UNZ_OK) return {};
    unz_file_info64 about;
    const std::string unreadable = fmt::format("its part {} cannot be unpacked", name);
    if (unzGetCurrentFileInfo64(zip_.get(), &about, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
      damaged(unreadable);
    if (about.uncompressed_size > largest_part)
      damaged(fmt::format("its part {} is larger than {} MB", name, largest_part / 1000000));
    std::string out(static_cast<std::size_t>(about.uncompressed_size), '\0');
    bool good = unzOpenCurrentFile(zip_.get()) == UNZ_OK;
    const auto all = static_cast<unsigned>(out.size());
    good = good && unzReadCurrentFile(zip_.get(), out.data(), all) == static_cast<int>(all);
    good = unzCloseCurrentFile(zip_.get()) == UNZ_OK && good;  // looks at the checksum
    if (!good) damaged(unreadable);
    return out;
  }

  [[noreturn]] void damaged(const std::string& why) const {
    notes_.refuse(why, "save it anew as .xlsx, or the sheet as CSV, and convert that");
  }

 private:
  struct Close {
    void operator()(unzFile z) const { unzClose(z); }
  };
  const Notes& notes_;
  std::unique_ptr<std::remove_pointer_t<unzFile>, Close> zip_;
};

using Attributes = std::map<std::string, std::string>;

/// "sheet" of "x:sheet"
std::string local(const char* name) {
  const std::string_view n = name;
  const std::size_t colon = n.rfind(':');
  return std::string(colon == std::string_view::npos ? n : n.substr(colon + 1));
}

/// What is told of the elements of a part, in their order.
struct Reader {
  std::function<void(const std::string&, const Attributes&)> begin;
  std::function<void(const std::string&)> end;
  std::function<void(std::string_view)> text;
};

bool parse(const std::string& xml, const Reader& to) {
  const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser(XML_ParserCreate(nullptr),
                                                                       XML_ParserFree);
  XML_SetUserData(parser.get(), const_cast<Reader*>(&to));
  XML_SetElementHandler(
      parser.get(),
      [](void* user, const XML_Char* name, const XML_Char** given) {
        Attributes attributes;
        for (; *given; given += 2)
          attributes.emplace(local(given[0]), given[1]);
        static_cast<Reader*>(user)->begin(local(name), attributes);
      },
      [](void* user, const XML_Char* name) { static_cast<Reader*>(user)->end(local(name)); });
  XML_SetCharacterDataHandler(parser.get(), [](void* user, const XML_Char* s, int n) {
    static_cast<Reader*>(user)->text({s, static_cast<std::size_t>(n)});
  });
  return XML_Parse(parser.get(), xml.data(), static_cast<int>(xml.size()), 1) == XML_STATUS_OK;
}

std::string value(const Attributes& of, const char* name) {
  const auto it = of.find(name);
  return it == of.end() ? std::string() : it->second;
}

struct Sheet {
  std::string name, part;
  bool hidden = false;
};

std::vector<Sheet> sheets_of(const Archive& archive) {
  const auto workbook = archive.part("xl/workbook.xml");
  const auto relations = archive.part("xl/_rels/workbook.xml.rels");
  if (!workbook || !relations) archive.damaged("it is not a workbook of the kind .xlsx");
  std::map<std::string, std::string> target;
  const auto nothing = [](const auto&...) {};
  bool good = parse(*relations, {[&](const std::string& element, const Attributes& a) {
                                   if (element != "Relationship") return;
                                   const std::string to = value(a, "Target");
                                   target[value(a, "Id")] =
                                       to.starts_with('/') ? to.substr(1) : "xl/" + to;
                                 },
                                 nothing, nothing});
  std::vector<Sheet> out;
  good = good && parse(*workbook, {[&](const std::string& element, const Attributes& a) {
                                     if (element == "sheet")
                                       out.push_back({value(a, "name"), target[value(a, "id")],
                                                      !value(a, "state").empty() &&
                                                          value(a, "state") != "visible"});
                                   },
                                   nothing, nothing});
  if (!good) archive.damaged("its list of sheets is damaged");
  return out;
}

/// The texts that cells share; those that say how others are pronounced are left out.
std::vector<std::string> shared_texts(const Archive& archive) {
  const auto part = archive.part("xl/sharedStrings.xml");
  std::vector<std::string> out;
  if (!part) return out;
  bool inside = false, pronounced = false;
  const bool good = parse(*part, {[&](const std::string& element, const Attributes&) {
                                    if (element == "si") out.emplace_back();
                                    if (element == "rPh") pronounced = true;
                                    inside = element == "t" && !pronounced;
                                  },
                                  [&](const std::string& element) {
                                    inside = false;
                                    if (element == "rPh") pronounced = false;
                                  },
                                  [&](std::string_view text) {
                                    if (inside && !out.empty()) out.back() += text;
                                  }});
  if (!good) archive.damaged("its texts are damaged");
  return out;
}

/// Number of a column from "BC7", from 0.
std::optional<std::size_t> column_of(const std::string& reference) {
  std::size_t n = 0;
  for (const char c : reference) {
    if (c < 'A' || c > 'Z') break;
    n = 26 * n + static_cast<std::size_t>(c - 'A' + 1);
    if (n > most_columns) return {};
  }
  return n > 0 ? std::optional(n - 1) : std::nullopt;
}

template <class T>
std::optional<T> number(const std::string& text) {
  T x{};
  const char* end = text.data() + text.size();
  const auto [at, problem] = std::from_chars(text.data(), end, x);
  return problem == std::errc() && at == end ? std::optional(x) : std::nullopt;
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text)
    out += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' || c == '\r' ? ' ' : c);
  return out + '"';
}

/// The rows of a sheet, by their numbers from 1: cells as they stand in CSV.
class Cells {
 public:
  Cells(const Archive& archive, const Sheet& sheet, const std::vector<std::string>& texts)
      : archive_(archive),
        texts_(texts) {
    const auto part = archive.part(sheet.part);
    const std::string damaged = fmt::format("its sheet '{}' is damaged", sheet.name);
    if (!part) archive.damaged(damaged);
    const bool good =
        parse(*part, {[this](const std::string& e, const Attributes& a) { begin(e, a); },
                      [this](const std::string& e) { end(e); },
                      [this](std::string_view t) {
                        if (inside_) text_ += t;
                      }});
    if (!good || !sound_) archive.damaged(damaged);
  }
  const std::map<std::size_t, std::vector<std::string>>& rows() const { return rows_; }

 private:
  void begin(const std::string& element, const Attributes& a) {
    if (element == "row") {
      const auto given = number<std::size_t>(value(a, "r"));
      row_ = given ? *given : row_ + 1;
      column_ = 0;
      sound_ = sound_ && row_ > 0 && row_ <= most_rows;
    } else if (element == "c") {
      kind_ = value(a, "t");
      text_.clear();
      const std::string place = value(a, "r");
      if (!place.empty()) column_ = column_of(place).value_or(most_columns);
      sound_ = sound_ && column_ < most_columns;
    }
    inside_ = element == "v" || element == "t";
  }
  void end(const std::string& element) {
    inside_ = false;
    if (element != "c") return;
    const std::string cell = shown();
    if (!cell.empty() && sound_) {
      std::vector<std::string>& row = rows_[row_];
      size_ += cell.size() + (row.size() <= column_ ? column_ + 1 - row.size() : 0);
      if (size_ > largest_part) archive_.damaged("a sheet is larger than a table may be");
      if (row.size() <= column_) row.resize(column_ + 1);
      row[column_] = cell;
    }
    ++column_;
  }
  std::string shown() {
    if (text_.empty()) return {};
    if (kind_ == "s") {
      const auto k = number<std::size_t>(text_);
      sound_ = sound_ && k && *k < texts_.size();
      return sound_ && !texts_[*k].empty() ? in_quotes(texts_[*k]) : std::string();
    }
    if (kind_ == "b") return text_ == "1" ? "true" : "false";
    if (kind_.empty() || kind_ == "n") {
      // the shortest text of the number: a workbook holds 25.4 as 25.399999999999999
      const auto x = number<double>(text_);
      return x && std::isfinite(*x) ? fmt::format("{}", *x) : in_quotes(text_);
    }
    return in_quotes(text_);  // of its own, of a formula, of an error
  }

  const Archive& archive_;
  const std::vector<std::string>& texts_;
  std::map<std::size_t, std::vector<std::string>> rows_;
  std::size_t row_ = 0, column_ = 0, size_ = 0;
  std::string kind_, text_;
  bool inside_ = false, sound_ = true;
};

std::string listed(const std::vector<Sheet>& sheets, const std::string& but) {
  std::string out;
  for (const Sheet& s : sheets)
    if (s.name != but) out += fmt::format("{}'{}'", out.empty() ? "" : ", ", s.name);
  return out;
}

std::string as_csv(const Cells& cells, Notes& notes) {
  const auto filled = [](const std::vector<std::string>& row) {
    return std::count_if(row.begin(), row.end(), [](const std::string& c) { return !c.empty(); });
  };
  std::string out;
  std::size_t line = 1;
  bool titles = false;
  for (const auto& [number, row] : cells.rows()) {
    if (!titles && filled(row) < 2) {
      notes.say(fmt::format("{} above the titles is left out", row.back()), {}, {},
                static_cast<int>(number));
      continue;
    }
    titles = true;
    out.append(number - line, '\n');
    line = number;
    for (std::size_t i = 0; i < row.size(); ++i)
      out += (i ? "," : "") + row[i];
  }
  return out + "\n";
}

}  // namespace

std::string sheet_as_csv(const std::filesystem::path& file, const std::string& sheet,
                         Notes& notes) {
  const Archive archive(file, notes);
  const std::vector<Sheet> sheets = sheets_of(archive);
  const std::vector<std::string> texts = shared_texts(archive);
  for (const Sheet& s : sheets) {
    if (sheet.empty() ? s.hidden : s.name != sheet) continue;
    const Cells cells(archive, s, texts);
    if (cells.rows().empty() && sheet.empty()) continue;
    if (sheet.empty() && sheets.size() > 1)
      notes.say(fmt::format("sheet '{}' is read, {} are not", s.name, listed(sheets, s.name)),
                "--sheet names another");
    return as_csv(cells, notes);
  }
  if (sheet.empty()) notes.refuse("it has no sheet with cells");
  notes.refuse(fmt::format("it has no sheet '{}'", sheet),
               fmt::format("its sheets are {}", listed(sheets, "")));
}

}  // namespace whirl::convert
