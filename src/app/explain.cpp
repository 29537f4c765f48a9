#include <app/commands.hpp>
#include <core/error.hpp>
#include <cctype>
#include <cstdio>
#include <deck/text/document.hpp>
#include <fmt/format.h>

namespace whirl::app {
namespace {

/// Breaks text at blanks so that lines stay within 88 characters.
std::string wrap(const std::string& text) {
  std::string r;
  std::size_t column = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t stop = std::min(text.find(' ', i), text.size());
    if (column > 0 && column + 1 + (stop - i) > 88) {
      r += '\n';
      column = 0;
    }
    if (column > 0) {
      r += ' ';
      ++column;
    }
    r += text.substr(i, stop - i);
    column += stop - i;
    i = stop + 1;
  }
  return r + "\n";
}

}  // namespace

int explain(const std::vector<std::string>& codes) {
  if (codes.empty()) {
    for (const auto& c : error_catalogue())
      std::fputs(fmt::format("{}  {}\n", c.code, c.title).c_str(), stdout);
    return static_cast<int>(Exit::ok);
  }
  for (std::string code : codes) {
    for (char& c : code)
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const CodeInfo* info = find_code(code);
    if (!info) {
      Diagnostic d;
      d.message = fmt::format("there is no code '{}'", code);
      d.hint = "`whirl explain` lists all codes";
      throw Error(Exit::usage, std::move(d));
    }
    std::string out = fmt::format("{}: {}\n\n{}", info->code, info->title, wrap(info->text));
    if (*info->example) {
      out += "\nExample:\n\n";
      std::string_view rest = info->example;
      while (!rest.empty()) {
        const std::size_t stop = std::min(rest.find('\n'), rest.size());
        out += fmt::format("    {}\n", rest.substr(0, stop));
        rest.remove_prefix(std::min(stop + 1, rest.size()));
      }
    }
    if (codes.size() > 1) out += "\n";
    std::fputs(out.c_str(), stdout);
  }
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
