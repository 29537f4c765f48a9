// Campbell lines of motions that become so heavily damped that they no longer oscillate.
#include "deck_run.hpp"

#include <fstream>
#include <sstream>

using whirl::test::DeckRun;

namespace {

/// A stiff rotor of about 20 kg on springs of 1 MN/m whose damping grows with the speed to `last`,
/// N s/m each.
std::string deck(const char* last) {
  std::string out = R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 200, 80], ["b", 200, 80]]
[[disk]]
name = "d"
at = "a:end"
mass = "5 kg"
Ip = "0.05 kg.m^2"
Id = "0.025 kg.m^2"
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
)";
  for (const char* at : {"a:start", "b:end"})
    out += std::string("[[bearing]]\nname = \"B ") + at[0] + "\"\nat = \"" + at +
           "\"\ntype = \"table\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", \"kzz[N/m]\", "
           "\"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [[0, 1e6, 1e6, 100, 100], [10000, 1e6, 1e6, " +
           last + ", " + last + "]]\n";
  return out +
         "[[step]]\nname = \"c\"\ntype = \"campbell\"\nmodes = 4\nspeed = { start = \"0 rpm\", "
         "stop = \"10000 rpm\", points = 21 }\n";
}

std::string report(const DeckRun& d) {
  std::ostringstream text;
  text << std::ifstream(d.folder / "r" / "report.html").rdbuf();
  return text.str();
}

}  // namespace

TEST(OverdampedLines, EndWithAWordAndAreDrawnThin) {
  // critical damping of the bounce: 2 sqrt(2 MN/m 21 kg)/2 = 6,500 N s/m a bearing
  const DeckRun d(deck("20000"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::string text = report(d);
  EXPECT_NE(text.find("overdamped"), std::string::npos);
  EXPECT_NE(text.find("damping ratio above 0.7"), std::string::npos);
}

TEST(OverdampedLines, LightDampingIsDrawnAsEver) {
  const DeckRun d(deck("1000"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::string text = report(d);
  EXPECT_EQ(text.find("overdamped"), std::string::npos);
  EXPECT_EQ(text.find("damping ratio above 0.7"), std::string::npos);
}
