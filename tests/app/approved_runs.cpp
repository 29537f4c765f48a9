#include "approved_runs.hpp"

#include "../io/read_json.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

namespace whirl::test {

namespace {

namespace fs = std::filesystem;

constexpr double unit = 1e-4;  ///< of a number in a fingerprint

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::uint32_t checksum(const std::string& text) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  return static_cast<std::uint32_t>(crc32(0L, bytes, static_cast<unsigned>(text.size())));
}

/// Of a number that stands by itself.
double by_logarithm(double x) {
  constexpr double next_to_nothing = 1e-9;
  return std::isfinite(x) ? std::round(std::asinh(x / next_to_nothing) / unit) : 0.0;
}

/// What differs from run to run.
bool is_time(const std::string& name) {
  static const std::regex times("cpu|wall|run time| s CPU", std::regex::icase);
  return std::regex_search(name, times);
}

/// Takes the numbers out of a text.
std::string without_numbers(const std::string& text, std::vector<double>& numbers) {
  static const std::regex number(R"([-+]?\d+(\.\d+)?([eE][-+]?\d+)?)");
  std::string words;
  auto last = text.cbegin();
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it) {
    words.append(last, (*it)[0].first);
    words += '#';
    last = (*it)[0].second;
    numbers.push_back(by_logarithm(std::strtod(it->str().c_str(), nullptr)));
  }
  words.append(last, text.cend());
  return words;
}

// ---- tables ----

std::optional<double> number_of(const std::string& cell) {
  char* end = nullptr;
  const double x = std::strtod(cell.c_str(), &end);
  if (end == cell.c_str() || *end != '\0' || !std::isfinite(x)) return std::nullopt;
  return x;
}

std::string unit_of(const std::string& title) {
  const std::size_t open = title.rfind('['), close = title.rfind(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return title;
  return title.substr(open, close - open);
}

Fingerprint of_table(const fs::path& file) {
  Fingerprint out;
  out.file = file.filename().string();
  std::istringstream in(text_of(file));
  std::string line, words;
  std::getline(in, line);
  const std::vector<std::string> titles = csv_cells(line);
  words = line;
  std::vector<std::vector<double>> columns(titles.size());
  while (std::getline(in, line)) {
    ++out.rows;
    const std::vector<std::string> cells = csv_cells(line);
    for (std::size_t k = 0; k < std::min(cells.size(), columns.size()); ++k) {
      if (is_time(titles[k])) continue;
      if (const std::optional<double> x = number_of(cells[k])) {
        columns[k].push_back(*x);
        continue;
      }
      std::vector<double> unread;
      words += '|' + without_numbers(cells[k], unread);
    }
  }
  std::map<std::string, double> largest;
  for (std::size_t k = 0; k < titles.size(); ++k)
    for (const double x : columns[k])
      largest[unit_of(titles[k])] = std::max(largest[unit_of(titles[k])], std::abs(x));
  for (const auto& [name, scale] : largest)
    out.numbers.push_back(by_logarithm(scale));
  out.numbers.push_back(static_cast<double>(out.rows));
  for (std::size_t k = 0; k < titles.size(); ++k) {
    const double scale = largest[unit_of(titles[k])], n = static_cast<double>(columns[k].size());
    std::array<double, 3> sums{};
    for (std::size_t i = 0; i < columns[k].size(); ++i) {
      const double x = scale > 0.0 ? columns[k][i] / scale : 0.0;
      sums[0] += x;
      sums[1] += x * (2.0 * static_cast<double>(i) / std::max(1.0, n - 1.0) - 1.0);
      sums[2] += x * x;
    }
    if (n == 0.0) continue;
    for (const double x : {sums[0] / n, sums[1] / n, std::sqrt(sums[2] / n)})
      out.numbers.push_back(std::round(x / unit));
  }
  out.words = checksum(words);
  return out;
}

// ---- the summary ----

void add_leaves(const io::Value& value, std::string& words, std::vector<double>& numbers) {
  if (value.is_object()) {
    for (const auto& [name, member] : value.members()) {
      if (is_time(name)) continue;
      words += '/' + name;
      add_leaves(member, words, numbers);
    }
  } else if (value.is_array()) {
    for (const io::Value& item : value.items())
      add_leaves(item, words, numbers);
  } else if (value.is_number()) {
    numbers.push_back(by_logarithm(value.number()));
  } else if (value.is_text()) {
    words += '=' + without_numbers(value.text(), numbers);
  } else {
    words += value.is_null() ? "=null" : value.boolean() ? "=true" : "=false";
  }
}

/// A step's part each.
std::vector<Fingerprint> of_summary(const fs::path& file) {
  std::vector<Fingerprint> out;
  const auto add = [&](const std::string& name, const io::Value& part) {
    Fingerprint f;
    std::string words;
    add_leaves(part, words, f.numbers);
    f.file = "summary/" + name;
    std::replace(f.file.begin(), f.file.end(), ' ', '_');
    f.words = checksum(words);
    out.push_back(std::move(f));
  };
  const io::Value summary = tests::read_json(file);
  for (const auto& [name, part] : summary.members()) {
    if (name != "steps" || !part.is_object()) {
      if (!is_time(name)) add(name, part);
      continue;
    }
    for (const auto& [step, its] : part.members())
      add("steps/" + step, its);
  }
  return out;
}

// ---- figures, log ----

/// What stands between the marks of all figures.
Fingerprint of_figures(const fs::path& folder) {
  static const std::regex text(R"(>([^<>]*[^<>\s][^<>]*)<)");
  Fingerprint out;
  out.file = "figures";
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".svg") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string words;
  std::vector<double> ticks;
  for (const fs::path& file : files) {
    words += file.filename().string();
    const std::string drawn = text_of(file);
    for (std::sregex_iterator it(drawn.begin(), drawn.end(), text), end; it != end; ++it)
      words += '|' + without_numbers((*it)[1].str(), ticks);
  }
  out.words = checksum(words);
  return out;
}

Fingerprint of_log(const std::string& log) {
  static const std::regex passing(R"(^results: | \d+ %  )");
  static const std::regex place(R"(\S*/([\w.-]+\.(toml|csv)))"), time(R"(, [\d.e-]+ s CPU.*)");
  Fingerprint out;
  out.file = "log";
  std::string words;
  std::istringstream in(log);
  for (std::string line; std::getline(in, line);) {
    if (std::regex_search(line, passing)) continue;
    line = std::regex_replace(line, time, "");
    line = std::regex_replace(line, place, "$1");
    words += without_numbers(line, out.numbers) + '\n';
  }
  out.words = checksum(words);
  return out;
}

// ---- what was approved ----

/// The lines of one deck, by their file.
std::map<std::string, std::string> approved_lines(const fs::path& file, const std::string& head) {
  std::map<std::string, std::string> out;
  std::ifstream in(file);
  bool here = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("deck "))
      here = line.starts_with(head);
    else if (here)
      out[line.substr(0, line.find(' '))] = line;
  }
  return out;
}

}  // namespace

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  bool quoted = false;
  for (const char c : line) {
    if (cells.empty()) cells.emplace_back();
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::string line_of(const Fingerprint& f) {
  std::string line = fmt::format("{} {:08x} {}", f.file, f.words, f.rows);
  for (const double x : f.numbers)
    line += fmt::format(" {:.0f}", x);
  return line;
}

std::string difference(const std::string& approved, const Fingerprint& now) {
  std::istringstream want(approved);
  std::string name, words, rows, number;
  want >> name >> words >> rows;
  if (words != "~" && words != fmt::format("{:08x}", now.words)) return "other words";
  constexpr std::size_t many = 50;
  const double allowed = now.rows > many ? 10.0 : 5.0;
  std::size_t k = 0;
  for (; want >> number; ++k) {
    if (number == "*") return "";  // as many as there may be
    if (k >= now.numbers.size()) return "fewer numbers";
    if (number == "~") continue;
    const double before = std::strtod(number.c_str(), nullptr);
    if (std::abs(before - now.numbers[k]) > allowed)
      return fmt::format("number {} is {:.0f}, was {}", k + 1, now.numbers[k], number);
  }
  return k < now.numbers.size() ? "more numbers" : "";
}

std::vector<Fingerprint> fingerprints(const fs::path& results, const std::string& log) {
  std::vector<Fingerprint> out{of_log(log)};
  if (!fs::is_directory(results)) return out;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(results))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    if (file.extension() == ".csv") out.push_back(of_table(file));
    if (file.filename() == "resolved.toml")
      out.push_back({"resolved.toml", checksum(text_of(file)), {}, 0});
    if (file.filename() == "summary.json")
      for (Fingerprint& part : of_summary(file))
        out.push_back(std::move(part));
  }
  if (fs::is_directory(results / "plots")) out.push_back(of_figures(results / "plots"));
  return out;
}

std::vector<std::string> differences_from_approved(const std::string& suite,
                                                   const std::string& deck, int exit,
                                                   const fs::path& results,
                                                   const std::string& log) {
  std::string name = suite;
  std::replace(name.begin(), name.end(), '/', '.');
  const std::string head = fmt::format("deck {:08x}", checksum(deck));
  std::vector<Fingerprint> of_run = fingerprints(results, log);
  of_run.push_back({"exit", static_cast<std::uint32_t>(exit), {}, 0});
  if (const char* to = std::getenv("WHIRL_APPROVED_RUNS_TO")) {
    std::ofstream left(fs::path(to) / fmt::format("{}-{}.txt", name, ::getpid()), std::ios::app);
    left << head << '\n';
    for (const Fingerprint& f : of_run)
      left << line_of(f) << '\n';
    return {};
  }
  const auto approved = approved_lines(fs::path(WHIRL_APPROVED_RUNS) / (name + ".txt"), head);
  std::vector<std::string> out;
  if (approved.empty()) return out;
  std::map<std::string, bool> written;
  for (const Fingerprint& f : of_run) {
    written[f.file] = true;
    const auto before = approved.find(f.file);
    const std::string what = before == approved.end() ? "is new" : difference(before->second, f);
    if (!what.empty()) out.push_back(f.file + ": " + what);
  }
  for (const auto& [file, line] : approved)
    if (!written[file]) out.push_back(file + ": is gone");
  return out;
}

}  // namespace whirl::test
