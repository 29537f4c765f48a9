// A place on a shaft, as a deck names it.
#pragma once
#include <core/error.hpp>
#include <cstddef>
#include <string>

namespace whirl::model {

/// A place on a shaft line: distance from station 0.
struct Location {
  std::size_t shaft = 0;
  double s = 0;      ///< m
  std::string text;  ///< as written in the deck ("body2:mid")
  Where where{};
  int housing = -1;  ///< bearing (index) whose support is meant instead of the shaft ("DE:support")
};

}  // namespace whirl::model
