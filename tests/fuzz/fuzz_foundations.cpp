// Whatever stands in a table of the matrices of a foundation, reading ends with a model or
// with errors, and the resolved form of a good deck reads again.
#include "scratch.hpp"
#include <deck/deck.hpp>

#include <cstdlib>

using namespace whirl;

namespace {

const std::string machine = R"(format = 1
[shaft]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 20]]
[[bearing]]
name = "DE"
at = "a:start"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
support = "ground"
[[bearing]]
name = "NDE"
at = "a:end"
type = "rigid"
[[foundation]]
name = "ground"
symmetric = false
coordinates = ["DE.y", "DE.z", "mode"]
file = "table.csv"
[[step]]
name = "modes"
type = "modal"
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::write("table.csv", fuzz::text_of(data, size));
  const deck::Deck read = deck::read_deck(fuzz::write("deck.toml", machine), {});
  (void)read.report();
  if (!read.ok()) return 0;
  const deck::Deck again = deck::read_deck_text(read.model.resolved, "resolved.toml", {});
  if (!again.ok()) std::abort();
  return 0;
}
