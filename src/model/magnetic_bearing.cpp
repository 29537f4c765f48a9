#include <model/magnetic_bearing.hpp>

namespace whirl::model {

bool gives_current(const ControlStage& s) {
  if (const auto* t = std::get_if<TransferFunction>(&s)) return t->gain != 0;
  if (const auto* t = std::get_if<StateSpaceStage>(&s)) return t->gain != 0;
  return std::holds_alternative<Pid>(s);
}

}  // namespace whirl::model
