// Fuzzes the deck reader: whatever the bytes are, reading ends with a model or with errors, and a
// good deck reads again from its resolved form. Build with -DWHIRL_FUZZ=ON (clang); run with the
// shipped decks as corpus:
//   fuzz_deck -max_total_time=60 corpus ../../examples/*/
#include <deck/deck.hpp>
#include <cstdint>
#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  whirl::deck::ReadOptions options;
  options.files_allowed = false;
  const auto deck = whirl::deck::read_deck_text(
      std::string(reinterpret_cast<const char*>(data), size), "fuzz.toml", options);
  (void)deck.report();
  if (!deck.ok()) return 0;
  const auto again = whirl::deck::read_deck_text(deck.model.resolved, "resolved.toml", options);
  if (!again.ok() || again.model.resolved.empty()) std::abort();
  return 0;
}
