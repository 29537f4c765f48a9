// Python values as TOML: how decks are built by code.
#pragma once
#include <pybind11/pybind11.h>
#include <string>

namespace whirl::python {

/// A whole deck from a dict of dicts, lists, text, numbers and flags (NumPy scalars and arrays too).
/// @throws py::type_error for what a deck cannot hold, py::value_error for numbers that are not
/// finite; both name the place.
std::string toml_of_deck(const pybind11::dict& deck);
/// One value, on one line: of a setting.
std::string toml_of_value(const pybind11::handle& value, const std::string& place);

}  // namespace whirl::python
