// Whatever a file to convert holds, converting ends with a text or with an Error; a deck that comes
// out reads with a model or with errors that a user can mend.
#include "../app/write_workbook.hpp"
#include "scratch.hpp"
#include <convert/convert.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>

using namespace whirl;

namespace {

void read_workbook(const std::filesystem::path& file) {
  try {
    (void)convert::convert_file(file);
  } catch (const Error&) {}
}

}  // namespace

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
  // a workbook's bytes; the rows and texts of one (a line of "--" between them)
  if (text.starts_with("PK")) read_workbook(fuzz::write("fuzz.xlsx", text));
  if (text.starts_with("<row")) {
    const std::size_t end = text.find("\n--\n");
    const std::string texts = end == std::string::npos ? std::string() : text.substr(end + 4);
    const std::filesystem::path file = fuzz::folder() / "parts.xlsx";
    test::write_workbook(file, test::workbook_of(text.substr(0, end), texts));
    read_workbook(file);
  }
  return 0;
}
