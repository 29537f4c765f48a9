// A rotor as ROSS saves it: each element a table "CLASS_TAG" with the arguments of its class, in SI
// units; z along the shaft, x and y across it. Petrobras ROSS, github.com/petrobras/ross, files
// written by Rotor.save() of versions 1 to 3.
#pragma once
#include <convert/convert.hpp>
#include <deck/text/document.hpp>

namespace whirl::convert {

/// A deck of the tree of such a file.
/// @throws Error (E42) when the shaft cannot be put together.
Converted convert_ross(const deck::Value& file, const std::string& name);

}  // namespace whirl::convert
