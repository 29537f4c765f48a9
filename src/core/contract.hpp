// Contracts inside the program: what a function needs from its callers, checked where
// WHIRL_CHECKS is defined (presets dev and asan) and nothing at all elsewhere. They are no means
// to report what a user did: that is an Error.
#pragma once

#ifdef WHIRL_CHECKS
#include <cstdio>
#include <cstdlib>

namespace whirl {

[[noreturn]] inline void broken_contract(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: contract broken: %s\n", file, line, condition);
  std::abort();
}

}  // namespace whirl

/// Ends the program when the condition does not hold.
#define WHIRL_EXPECTS(condition) \
  ((condition) ? static_cast<void>(0) : ::whirl::broken_contract(#condition, __FILE__, __LINE__))
#else
#define WHIRL_EXPECTS(condition) static_cast<void>(0)
#endif
