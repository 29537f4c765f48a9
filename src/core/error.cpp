#include <core/error.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace whirl {
namespace {

constexpr int widest = 140;  // characters of a source line shown

/// Characters first to last of a line of UTF-8; tabs and control characters become a space and bad
/// bytes '?' so that the caret stays under its text. Returns how many characters the line has.
int cut(std::string_view line, int first, int last, std::string& out) {
  int k = 0;
  for (std::size_t i = 0; i < line.size(); ++k) {
    const auto c = static_cast<unsigned char>(line[i]);
    std::size_t n = c < 0x80 ? 1 : c < 0xE0 ? 2 : c < 0xF0 ? 3 : 4;
    n = std::min(n, line.size() - i);
    const bool bad = c >= 0x80 && c < 0xC2;
    if (bad) n = 1;
    if (k >= first && k < last) {
      if (c < 0x20)
        out += ' ';
      else if (bad || c == 0x7F)
        out += '?';
      else
        out += line.substr(i, n);
    }
    i += n;
  }
  return k;
}

/// Control characters (a NUL would end the text, an escape could repaint the terminal) as they are
/// written in a deck; lines stay.
std::string printable(std::string_view s) {
  std::string out;
  for (const char c : s) {
    const auto u = static_cast<unsigned char>(c);
    if ((u < 0x20 && c != '\n' && c != '\t') || u == 0x7F)
      out += fmt::format("\\u{:04x}", u);
    else
      out += c;
  }
  return out;
}

}  // namespace

const char* name_of(Diagnostic::Severity s) {
  return s == Diagnostic::Severity::error     ? "error"
         : s == Diagnostic::Severity::warning ? "warning"
                                              : "note";
}

std::string format(const Diagnostic& d, std::string_view source_line, bool colour) {
  const auto paint = [&](const char* code, const std::string& s) {
    return colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, s) : s;
  };
  std::string out;
  if (!d.where.file.empty()) {
    out += printable(d.where.file);
    if (d.where.line > 0) out += fmt::format(":{}", d.where.line);
    if (d.where.line > 0 && d.where.column > 0) out += fmt::format(":{}", d.where.column);
    out += ": ";
  }
  const char* tint = d.severity == Diagnostic::Severity::error     ? "1;31"
                     : d.severity == Diagnostic::Severity::warning ? "1;33"
                                                                   : "1;36";
  const std::string code = d.code.empty() ? std::string() : fmt::format("[{}]", d.code);
  out += fmt::format("{}: {}\n", paint(tint, fmt::format("{}{}", name_of(d.severity), code)),
                     printable(d.message));

  const std::string number = fmt::format("{:>4}", d.where.line);
  const std::string blank(number.size(), ' ');
  if (d.where.line > 0 && !source_line.empty()) {
    std::string line;
    const int size = cut(source_line, 0, 0, line);
    const int column = std::min(std::max(d.where.column, 1) - 1, size);
    const int first = size > widest ? std::clamp(column - widest / 2, 0, size - widest) : 0;
    const int last = std::min(first + widest, size);
    const int length = std::clamp(d.where.length, 1, std::max(1, last - column));
    cut(source_line, first, last, line);
    out += fmt::format("{} | {}{}{}\n", number, first > 0 ? "..." : "", line,
                       last < size ? "..." : "");
    if (d.where.column > 0)
      out += fmt::format(
          "{} | {}{}\n", blank,
          std::string(static_cast<std::size_t>(column - first + (first > 0 ? 3 : 0)), ' '),
          paint(tint, fmt::format("^{:~<{}}", "", length - 1)));
  }
  if (!d.hint.empty()) out += fmt::format("{} = hint: {}\n", blank, printable(d.hint));
  return out;
}

const CodeInfo* find_code(std::string_view code) {
  for (const auto& c : error_catalogue())
    if (code == c.code) return &c;
  return nullptr;
}

}  // namespace whirl
