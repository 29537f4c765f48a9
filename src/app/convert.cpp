#include <app/commands.hpp>
#include <convert/convert.hpp>
#include <cstdio>
#include <deck/deck.hpp>
#include <fmt/format.h>
#include <io/file.hpp>
#include <run/diagnose.hpp>

namespace whirl::app {

int convert_model(const ConvertOptions& o) {
  const convert::Converted made = convert::convert_file(o.input, o.sheet);
  if (!o.output.empty() && !o.force && std::filesystem::exists(o.output)) {
    Diagnostic d;
    d.code = "E91";
    d.message = fmt::format("'{}' exists already", o.output.string());
    d.hint = "choose another name or folder, or --force to replace it";
    throw Error(Exit::io, std::move(d));
  }
  run::print_diagnostics(made.left_out);
  if (o.output.empty())
    std::fputs(made.text.c_str(), stdout);
  else
    io::write_atomic(o.output, made.text);
  if (made.is_table) return static_cast<int>(Exit::ok);
  const deck::Deck deck =
      deck::read_deck_text(made.text, o.output.empty() ? "converted deck" : o.output.string(), {},
                           o.output.parent_path());
  std::fputs(deck.report(false).c_str(), stderr);
  if (!deck.ok()) return static_cast<int>(deck::exit_of(deck.diagnostics));
  if (!o.output.empty())
    std::fputs(
        fmt::format("wrote {}; next: whirl check '{}'\n", o.output.string(), o.output.string())
            .c_str(),
        stderr);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
