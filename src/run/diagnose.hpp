// Diagnostics on standard error (or inside JSON).
#pragma once
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <io/value.hpp>
#include <vector>

namespace whirl::run {

/// Prints what was found while reading, with source lines. With `quiet` warnings are left out.
void print_diagnostics(const deck::Deck& deck, bool quiet);
/// Prints the diagnostics of an error; source lines are read from the files named, where they can
/// be.
void print_diagnostics(const std::vector<Diagnostic>& diagnostics);
io::Value to_value(const Diagnostic& d);
io::Value to_value(const std::vector<Diagnostic>& diagnostics);
/// "2 errors, 1 warning"
std::string count_text(const std::vector<Diagnostic>& diagnostics);

}  // namespace whirl::run
