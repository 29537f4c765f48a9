#include <run/diagnose.hpp>
#include <core/messages.hpp>
#include <run/terminal.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fstream>

namespace whirl::run {

void print_diagnostics(const deck::Deck& deck, bool quiet) {
  const bool colour = wants_colour(2);
  for (const auto& d : deck.diagnostics)
    if (!quiet || d.severity == Diagnostic::Severity::error)
      std::fputs(format(d, deck.sources.line(d.where), colour).c_str(), stderr);
  if (deck.errors > 0)
    std::fputs(
        fmt::format("{}: {}\n",
                    deck.model.deck_path.empty() ? deck.sources[0].name : deck.model.deck_path,
                    count_text(deck.diagnostics))
            .c_str(),
        stderr);
}

void print_diagnostics(const std::vector<Diagnostic>& diagnostics) {
  const bool colour = wants_colour(2);
  for (const auto& d : diagnostics) {
    std::string line;
    if (!d.where.file.empty() && d.where.line > 0) {
      std::ifstream in(d.where.file);
      for (int k = 0; k < d.where.line && std::getline(in, line); ++k) {}
      if (!in) line.clear();
    }
    say(format(d, line, colour));
  }
}

io::Value to_value(const Diagnostic& d) {
  io::Value v = io::Value::object();
  v["severity"] = name_of(d.severity);
  v["code"] = d.code;
  v["message"] = d.message;
  if (!d.hint.empty()) v["hint"] = d.hint;
  if (!d.where.file.empty()) {
    v["file"] = d.where.file;
    v["line"] = d.where.line;
    v["column"] = d.where.column;
    v["length"] = d.where.length;
  }
  if (!d.where.entity.empty()) v["entity"] = d.where.entity;
  return v;
}

io::Value to_value(const std::vector<Diagnostic>& diagnostics) {
  io::Value v = io::Value::array();
  for (const auto& d : diagnostics)
    v.push(to_value(d));
  return v;
}

std::string count_text(const std::vector<Diagnostic>& diagnostics) {
  const auto of = [&](Diagnostic::Severity s) {
    return std::count_if(diagnostics.begin(), diagnostics.end(),
                         [s](const Diagnostic& d) { return d.severity == s; });
  };
  const auto e = of(Diagnostic::Severity::error), w = of(Diagnostic::Severity::warning);
  std::string r = fmt::format("{} error{}", e, e == 1 ? "" : "s");
  if (w > 0) r += fmt::format(", {} warning{}", w, w == 1 ? "" : "s");
  return r;
}

}  // namespace whirl::run
