// Whatever a file to convert holds, converting ends with a text or with an Error; a deck that comes
// out reads with a model or with errors that a user can mend.
#include "scratch.hpp"
#include <convert/convert.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>

using namespace whirl;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = fuzz::text_of(data, size);
  for (const auto convert :
       {convert::convert_ross_toml, convert::convert_ross_json, convert::convert_csv})
    try {
      const convert::Converted out = convert(text, "fuzz");
      if (out.is_table) continue;
      deck::ReadOptions options;
      options.files_allowed = false;
      (void)deck::read_deck_text(out.text, "converted.toml", options).report();
    } catch (const Error&) {}
  return 0;
}
