// Models of other programs as decks: ROSS rotors (TOML, JSON), tables of stations and of bearing
// coefficients (CSV, XLSX).
#pragma once
#include <core/error.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::convert {

/// What came out of a file.
struct Converted {
  std::string text;       ///< a deck (TOML), or a coefficient table (CSV)
  bool is_table = false;  ///< text is a table for [[bearing]] type = "table"
  /// What was left out or assumed (W20), in the order of the file; also as comments in a deck.
  std::vector<Diagnostic> left_out;
};

/// Converts one file by what is in it: a rotor saved by ROSS (.toml, .json), a table (.csv, .xlsx) of
/// stations (length, diameters, lumped masses) or of bearing coefficients (speed, kxx, kxy, ..).
/// Axes: what others call x, y across and z along the shaft become y, z across and x along.
/// @throws Error (E02, E03: unreadable; E42: neither of these, or without what a deck must have).
/// sheet: of a workbook; empty: the first with cells.
Converted convert_file(const std::filesystem::path& file, const std::string& sheet = {});

/// The same from text; `name` is shown in messages.
Converted convert_ross_toml(const std::string& text, const std::string& name);
Converted convert_ross_json(const std::string& text, const std::string& name);
Converted convert_csv(const std::string& text, const std::string& name);

}  // namespace whirl::convert
