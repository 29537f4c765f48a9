#include <deck/text/locate.hpp>
#include <gtest/gtest.h>

using namespace whirl;

namespace {

model::Model two_shafts() {
  model::Model m;
  const auto add = [&](const char* name, std::vector<std::pair<const char*, double>> sections) {
    model::Shaft s;
    s.name = name;
    for (const auto& [n, l] : sections) {
      model::Section x;
      x.name = n;
      x.length = l;
      s.sections.push_back(x);
    }
    m.shafts.push_back(s);
  };
  add("hp", {{"body", 0.4}, {"body2", 0.2}, {"DE-end", 0.1}});
  add("lp", {{"body", 1.0}, {"tail", 0.5}});
  model::Disk d;
  d.name = "fan";
  d.at = {1, 1.2, "lp/tail", {}};
  m.disks.push_back(d);
  return m;
}

}  // namespace

TEST(Locate, Places) {
  const auto m = two_shafts();
  const struct {
    const char* text;
    std::size_t shaft;
    double s;
  } table[] = {
      {"body2", 0, 0.4},         {"body2:start", 0, 0.4},      {"body2:mid", 0, 0.5},
      {"body2:end", 0, 0.6},     {"body2:end-20 mm", 0, 0.58}, {"body2:mid + 2 cm", 0, 0.52},
      {"body2+1 in", 0, 0.4254}, {"hp/body:end", 0, 0.4},      {"lp/body:end", 1, 1.0},
      {"tail:mid", 1, 1.25},     {"hp:end", 0, 0.7},           {"lp:mid", 1, 0.75},
      {"hp/0.3 m", 0, 0.3},      {"lp/(2 * 300 mm)", 1, 0.6},  {"fan", 1, 1.2},
      {"fan - 100 mm", 1, 1.1},  {"DE-end:mid", 0, 0.65},      {" DE-end:mid-1mm ", 0, 0.649},
  };
  for (const auto& t : table) {
    const auto r = deck::locate(m, t.text);
    ASSERT_TRUE(r.at) << t.text << ": " << r.message;
    EXPECT_EQ(r.at->shaft, t.shaft) << t.text;
    EXPECT_NEAR(r.at->s, t.s, 1e-15) << t.text;  // sums of a few decimals
  }
}

TEST(Locate, TheEndIsReachedDespiteRounding) {
  model::Model m;
  model::Shaft s;
  s.name = "s";
  for (int k = 0; k < 10; ++k) {
    model::Section x;
    x.length = 0.1;
    s.sections.push_back(x);
  }
  m.shafts.push_back(s);
  const auto r = deck::locate(m, "1 m");  // ten times 0.1 is less than 1
  ASSERT_TRUE(r.at);
  EXPECT_EQ(r.at->s, m.shafts[0].length());
}

TEST(Locate, Problems) {
  const auto m = two_shafts();
  const struct {
    const char* text;
    const char* code;
    const char* message;
  } table[] = {
      {"body:mid", "E18", "'body' stands on more than one shaft"},
      {"0.3 m", "E18", "\"0.3 m\" does not say on which shaft"},
      {"bdy2:mid", "E18", "there is no section, disk or bearing 'bdy2'"},
      {"lp/body2:mid", "E18", "there is no section, disk or bearing 'body2' on shaft 'lp'"},
      {"body2:middle", "E18", "':middle' is not a place in a section"},
      {"hp/0.3", "E07", "\"0.3\" has no unit where a length is needed"},
      {"hp/0.8 m", "E19", "\"hp/0.8 m\" is 100 mm beyond the end of shaft 'hp'"},
      {"tail:end + 1 mm", "E19", "\"tail:end + 1 mm\" is 1 mm beyond the end of shaft 'lp'"},
      {"body2:start - 0.5 m", "E19",
       "\"body2:start - 0.5 m\" is 100 mm before the start of shaft 'hp'"},
      {"", "E18", "the place is empty"},
  };
  for (const auto& t : table) {
    const auto r = deck::locate(m, t.text);
    EXPECT_FALSE(r.at) << t.text;
    EXPECT_EQ(r.code, t.code) << t.text;
    EXPECT_EQ(r.message, t.message) << t.text;
  }
}

TEST(Locate, WithoutAShaftThereIsNoPlace) {
  for (const char* text : {"1 m", "a:mid", "-3 mm", "(1 m)", "a/1 m", ""}) {
    const auto r = deck::locate(model::Model{}, text);
    EXPECT_FALSE(r.at) << text;
    EXPECT_EQ(r.code, "E18") << text;
  }
}
