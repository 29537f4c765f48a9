// What linear results say of their limits: a mesh too coarse (W10), a response larger than a gap
// (W11), a table held beyond its end (W12); and nothing where there is nothing to say.
#include "deck_run.hpp"

using whirl::test::DeckRun;

namespace {

std::string rotor(const std::string& mesh, const std::string& parts) {
  return R"(format = 1
[output]
report = false
)" + mesh +
         R"(
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 30], ["b", 500, 30]]
[[disk]]
name = "d"
at = "a:end"
mass = "5 kg"
Ip = "0.05 kg.m^2"
Id = "0.025 kg.m^2"
[[unbalance]]
at = "d"
amount = "200 g.mm"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
)" + parts;
}

constexpr const char* modes = "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 12\n";
constexpr const char* response =
    "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
    "speed = { start = \"500 rpm\", stop = \"4000 rpm\", points = 15 }\n";

}  // namespace

TEST(LinearLimits, ACoarseMeshIsNamed) {
  const DeckRun coarse(rotor("[model.mesh]\nmin_elements_per_section = 1\n", modes));
  EXPECT_EQ(coarse.exit, 0) << coarse.log;
  EXPECT_TRUE(coarse.says("W10")) << coarse.log;
  const auto modes_of = coarse.csv("m_modes.csv");
  double worst = 0;
  for (const auto& row : modes_of.rows)
    worst = std::max(worst, row[modes_of.column("mesh error [-]")]);
  EXPECT_GT(worst, 1e-3);
}

TEST(LinearLimits, AChosenMeshIsNot) {
  const DeckRun chosen(rotor("", modes));
  EXPECT_FALSE(chosen.says("W10")) << chosen.log;
}

TEST(LinearLimits, AResponseBeyondAGapIsNamed) {
  const auto stop = [](const char* gap) {
    return std::string("[[bearing]]\nname = \"stop\"\nat = \"a:end\"\ntype = \"rub\"\ngap = \"") +
           gap + "\"\nstiffness = \"1e7 N/m\"\n";
  };
  const DeckRun small(rotor("", stop("0.05 mm") + response));
  EXPECT_TRUE(small.says("W11")) << small.log;
  EXPECT_TRUE(small.says("'stop'")) << small.log;
  const DeckRun wide(rotor("", stop("500 mm") + response));
  EXPECT_FALSE(wide.says("W11")) << wide.log;
}

TEST(LinearLimits, AHeldTableIsNamed) {
  const auto table = [](const char* last) {
    return std::string(
               "[[bearing]]\nname = \"seal\"\nat = \"a:end\"\ntype = \"table\"\n"
               "extrapolate = \"hold\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", "
               "\"kzz[N/m]\"]\nrows = [[0, 1e4, 1e4], [") +
           last + ", 2e4, 2e4]]\n";
  };
  const DeckRun shorter(rotor("", table("3000") + response));
  EXPECT_TRUE(shorter.says("W12")) << shorter.log;
  const DeckRun enough(rotor("", table("4000") + response));
  EXPECT_FALSE(enough.says("W12")) << enough.log;
}

TEST(LinearLimits, PeaksAreRefinedUnlessSpeedsAreListed) {
  const DeckRun range(rotor("", response));
  EXPECT_GT(range.csv("u_response.csv").rows.size(), 20u) << range.log;
  const DeckRun listed(rotor(
      "",
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"500 rpm\", "
      "\"4000 rpm\"] }\n"));
  EXPECT_EQ(listed.csv("u_response.csv").rows.size(), 2u) << listed.log;
}
