// One error type for everything a user can cause or must know.
#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace whirl {

/// Process exit codes of the `whirl` program.
enum class Exit : int {
  ok = 0,
  internal = 1,
  usage = 2,
  deck = 3,
  no_convergence = 4,
  io = 5,
  interrupted = 130
};

/// Where in the user's input something comes from. line and column count from 1; 0 = unknown.
struct Where {
  std::string file;
  int line = 0;
  int column = 0;
  int length = 0;      ///< number of characters the caret underlines
  std::string entity;  ///< "disk 'impeller'", "node 12 of shaft 'hp'", ...
};

/// A diagnosis. `code` is stable ("E07"); `explain E07` tells more.
struct Diagnostic {
  enum class Severity { error, warning, note };
  Severity severity = Severity::error;
  std::string code;
  std::string message;
  std::string hint;
  Where where;
};

/// "deck.toml:62:12: error[E07]: message", the source line with a caret underline when one is
/// given, and the hint. Lines end with a newline. `colour` adds terminal escape codes.
std::string format(const Diagnostic& d, std::string_view source_line = {}, bool colour = false);
/// "error", "warning", "note"
const char* name_of(Diagnostic::Severity s);

/// What is known about a code: the long answer of `whirl explain CODE`.
struct CodeInfo {
  const char* code;
  const char* title;    ///< one line
  const char* text;     ///< what it means, why it is checked, what to do
  const char* example;  ///< wrong and right, as they stand in a deck; may be empty
};
/// All codes in order.
const std::vector<CodeInfo>& error_catalogue();
/// nullptr when there is no such code.
const CodeInfo* find_code(std::string_view code);

/// Thrown at API edges; never in the step loop (non-convergence inside is a returned status).
class Error : public std::runtime_error {
 public:
  Error(Exit exit, Diagnostic d)
      : std::runtime_error(d.message),
        exit_(exit),
        diagnostics_{std::move(d)} {}
  Error(Exit exit, std::vector<Diagnostic> ds)
      : std::runtime_error(ds.empty() ? "error" : ds.front().message),
        exit_(exit),
        diagnostics_(std::move(ds)) {}
  Exit exit() const { return exit_; }
  const std::vector<Diagnostic>& diagnostics() const { return diagnostics_; }

 private:
  Exit exit_;
  std::vector<Diagnostic> diagnostics_;
};

/// A numerical failure found while running: code, message, hint; `entity` names node, shaft or
/// element.
inline Error run_error(std::string code, std::string message, std::string hint = {},
                       std::string entity = {}) {
  return Error(Exit::no_convergence,
               Diagnostic{Diagnostic::Severity::error, std::move(code), std::move(message),
                          std::move(hint), Where{{}, 0, 0, 0, std::move(entity)}});
}

}  // namespace whirl
