#include <core/error.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace whirl {
namespace {

constexpr int widest = 140;   // characters of a source line shown

/// Splits UTF-8 into code points; tabs and control characters become a space so that the caret stays under its text.
std::vector<std::string> characters(std::string_view line) {
  std::vector<std::string> r;
  for (std::size_t i = 0; i < line.size();) {
    const auto c = static_cast<unsigned char>(line[i]);
    std::size_t n = c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
    n = std::min(n, line.size() - i);
    if (c < 0x20 || c == 0x7F || (c >= 0x80 && c < 0xC2)) { r.emplace_back(c == 0x7F || c >= 0x80 ? "?" : " "); n = 1; }
    else r.emplace_back(line.substr(i, n));
    i += n;
  }
  return r;
}

}  // namespace

const char* name_of(Diagnostic::Severity s) {
  return s == Diagnostic::Severity::error ? "error" : s == Diagnostic::Severity::warning ? "warning" : "note";
}

std::string format(const Diagnostic& d, std::string_view source_line, bool colour) {
  const auto paint = [&](const char* code, const std::string& s) { return colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, s) : s; };
  std::string out;
  if (!d.where.file.empty()) {
    out += d.where.file;
    if (d.where.line > 0) out += fmt::format(":{}", d.where.line);
    if (d.where.line > 0 && d.where.column > 0) out += fmt::format(":{}", d.where.column);
    out += ": ";
  }
  const char* tint = d.severity == Diagnostic::Severity::error ? "1;31" : d.severity == Diagnostic::Severity::warning ? "1;33" : "1;36";
  out += paint(tint, fmt::format("{}{}", name_of(d.severity), d.code.empty() ? "" : fmt::format("[{}]", d.code))) + ": " + d.message + "\n";

  const std::string number = fmt::format("{:>4}", d.where.line);
  const std::string blank(number.size(), ' ');
  if (d.where.line > 0 && !source_line.empty()) {
    auto text = characters(source_line);
    int column = std::max(d.where.column, 1) - 1;
    column = std::min<int>(column, static_cast<int>(text.size()));
    int length = std::clamp(d.where.length, 1, std::max(1, static_cast<int>(text.size()) - column));
    int first = 0;
    if (static_cast<int>(text.size()) > widest) first = std::clamp(column - widest / 2, 0, static_cast<int>(text.size()) - widest);
    const int last = std::min<int>(first + widest, static_cast<int>(text.size()));
    length = std::min(length, std::max(1, last - column));
    std::string line = first > 0 ? "..." : "";
    for (int i = first; i < last; ++i) line += text[static_cast<std::size_t>(i)];
    if (last < static_cast<int>(text.size())) line += "...";
    out += fmt::format("{} | {}\n", number, line);
    if (d.where.column > 0)
      out += fmt::format("{} | {}{}\n", blank, std::string(static_cast<std::size_t>(column - first + (first > 0 ? 3 : 0)), ' '),
                         paint(tint, fmt::format("^{:~<{}}", "", length - 1)));
  }
  if (!d.hint.empty()) out += fmt::format("{} = hint: {}\n", blank, d.hint);
  return out;
}

const CodeInfo* find_code(std::string_view code) {
  for (const auto& c : error_catalogue())
    if (code == c.code) return &c;
  return nullptr;
}

}  // namespace whirl
