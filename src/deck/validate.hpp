// Checks that need the whole model.
#pragma once
#include <deck/text/document.hpp>
#include <model/model.hpp>

namespace whirl::deck {

struct WholeModelProblem {
  Diagnostic::Severity severity = Diagnostic::Severity::error;
  std::string code, message, hint;
  Where where;
};
/// Unrestrained motions, speed ranges of tables, and settings without effect.
std::vector<WholeModelProblem> check_model(const model::Model& model);

}  // namespace whirl::deck
