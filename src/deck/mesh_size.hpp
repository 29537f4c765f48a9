// How many nodes a deck will have, before it is meshed.
#pragma once
#include <model/model.hpp>

namespace whirl::deck {

struct NodeCount {
  double line = 0;     ///< of shafts and casings, and about as many more as there are bodies
  double surface = 0;  ///< the same, those of a bore again
  const model::Shaft* shaft = nullptr;  ///< of the section that has most; null: there is none
  const model::Section* section = nullptr;
  double in_section = 0;
};
NodeCount count_of_nodes(const model::Model& model);

}  // namespace whirl::deck
