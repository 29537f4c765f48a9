// Whatever stands in a table of the matrices of a foundation, reading ends with a model or
// with errors, and the resolved form of a good deck reads again.
#include "deck_with_table.hpp"
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
  return fuzz::read_deck_with_table(machine, data, size);
}
