// Tables of the report, read back from the page: those that are files too against their files, the
// others against closed forms.
#include "deck_run.hpp"
#include "lateral_mass.hpp"
#include "written_decks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <set>
#include <tuple>

namespace {

using namespace whirl;
using test::Columns;
using test::DeckRun;
namespace fs = std::filesystem;

struct PageTable {
  std::string caption;
  std::vector<std::string> names, units;
  std::vector<std::vector<std::string>> rows;
};

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t k = text.find(from); k != std::string::npos; k = text.find(from, k + to.size()))
    text.replace(k, from.size(), to);
  return text;
}

/// As one reads it.
std::string plain(const std::string& html) {
  std::string text = std::regex_replace(html, std::regex("<[^>]*>"), "");
  for (const auto& [from, to] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&#39;", "'"}, {"&amp;", "&"}})
    text = replaced(text, from, to);
  return text;
}

/// What stands between each pair of marks.
std::vector<std::string> parts(const std::string& text, const std::string& begin,
                               const std::string& end) {
  std::vector<std::string> out;
  for (std::size_t a = text.find(begin); a != std::string::npos; a = text.find(begin, a + 1)) {
    const std::size_t from = text.find('>', a) + 1;
    out.push_back(text.substr(from, text.find(end, from) - from));
  }
  return out;
}

std::vector<PageTable> tables_of(const DeckRun& run) {
  std::vector<PageTable> out;
  for (const std::string& html : parts(text_of(run.folder / "r" / "report.html"),
                                       "<div class=\"scroll\"><table", "</table>")) {
    const std::size_t body = html.find("<tbody>");
    if (body == std::string::npos) continue;
    const std::string head = html.substr(0, body);
    PageTable t;
    for (const std::string& c : parts(head, "<caption", "</caption>"))
      t.caption = plain(c);
    for (const std::string& h : parts(replaced(head, "<thead", "<x"), "<th", "</th>")) {
      t.names.push_back(plain(h.substr(0, h.find("<small>"))));
      t.units.push_back(
          h.find("<small>") == std::string::npos ? "-" : plain(h.substr(h.find("<small>"))));
    }
    for (const std::string& r : parts(html.substr(body), "<tr", "</tr>")) {
      t.rows.emplace_back();
      for (const std::string& c : parts(r, "<td", "</td>"))
        t.rows.back().push_back(plain(c));
    }
    out.push_back(std::move(t));
  }
  return out;
}

/// "kN·s/m" to "N s/m": 1e3; none: nan.
double factor_of(std::string shown, const std::string& file) {
  for (const auto& [from, to] :
       {std::pair{"·", " "}, {"²", "^2"}, {"³", "^3"}, {"°C", "degC"}, {"°", "deg"}})
    shown = replaced(shown, from, to);
  const std::string base = replaced(file, ".", " ");
  if (shown == base) return 1;
  const std::map<std::string, double> prefixes{{"n", 1e-9}, {"µ", 1e-6}, {"m", 1e-3},
                                               {"k", 1e3},  {"M", 1e6},  {"G", 1e9}};
  for (const auto& [prefix, factor] : prefixes)
    if (shown == prefix + base) return factor;
  return std::nan("");
}

/// "speed [rpm]" to its two halves.
std::pair<std::string, std::string> halves(const std::string& heading) {
  const std::size_t k = heading.rfind(" [");
  return {heading.substr(0, k), heading.substr(k + 2, heading.size() - k - 3)};
}

std::vector<std::vector<std::string>> cells_of(const fs::path& csv) {
  std::vector<std::vector<std::string>> out;
  std::ifstream in(csv);
  for (std::string line; std::getline(in, line);) {
    out.push_back(Columns::cells_of(line));
    if (line.ends_with(',')) out.back().emplace_back();
  }
  return out;
}

/// The page's column of a file's, by name and order; -1: none.
std::vector<int> columns_in(const PageTable& t, const std::vector<std::string>& headings) {
  std::vector<int> out;
  for (const std::string& name : t.names) {
    int at = -1;
    for (int k = static_cast<int>(headings.size()) - 1; k >= 0; --k)
      if (halves(headings[static_cast<std::size_t>(k)]).first == name &&
          std::find(out.begin(), out.end(), k) == out.end())
        at = k;
    out.push_back(at);
  }
  return out;
}

/// "−1.2×10⁻³" to -1.2e-3; a word: nan.
double number_of(std::string shown) {
  for (const auto& [from, to] : {std::pair{"−", "-"},
                                 {"×10", "e"},
                                 {"·10", "e"},
                                 {"⁻", "-"},
                                 {"⁰", "0"},
                                 {"¹", "1"},
                                 {"²", "2"},
                                 {"³", "3"},
                                 {"⁴", "4"},
                                 {"⁵", "5"},
                                 {"⁶", "6"},
                                 {"⁷", "7"},
                                 {"⁸", "8"},
                                 {"⁹", "9"}})
    shown = replaced(shown, from, to);
  return Columns::number(shown);
}

/// What differs, cell by cell.
std::vector<std::string> differences(const PageTable& t,
                                     const std::vector<std::vector<std::string>>& file,
                                     const std::vector<int>& columns) {
  std::vector<std::string> out;
  for (std::size_t c = 0; c < t.names.size(); ++c) {
    const auto k = static_cast<std::size_t>(columns[c]);
    const std::string unit = halves(file[0][k]).second;
    const double factor = factor_of(t.units[c], unit);
    if (std::isnan(factor)) out.push_back(t.names[c] + ": " + t.units[c] + " for " + unit);
    for (std::size_t r = 0; r < t.rows.size(); ++r) {
      const std::string &shown = t.rows[r].at(c), &cell = file[r + 1].at(k);
      const double is = factor * number_of(shown), wanted = Columns::number(cell);
      const bool same =
          std::isnan(wanted)
              ? shown == cell || shown == "–"
              : std::abs(is - wanted) <= 6e-5 * std::abs(wanted) + 1e-9 * factor;  // five digits
      if (!same) out.push_back(t.names[c] + ": " + shown + " for " + cell);
    }
  }
  return out;
}

/// Whether a file of the run has such columns and rows; one of these must be the table then.
bool is_a_file(const PageTable& t, const DeckRun& run, const std::string& of) {
  bool found = false, same = false;
  std::string all;
  for (const auto& entry : fs::directory_iterator(run.folder / "r")) {
    if (entry.path().extension() != ".csv") continue;
    const auto cells = cells_of(entry.path());
    const std::vector<int> columns = columns_in(t, cells.at(0));
    if (std::count(columns.begin(), columns.end(), -1) > 0) continue;
    if (cells.size() != t.rows.size() + 1) continue;
    found = true;
    const std::vector<std::string> differ = differences(t, cells, columns);
    same = same || differ.empty();
    for (const std::string& d : differ)
      all += "\n" + entry.path().filename().string() + ", " + d;
  }
  EXPECT_TRUE(same || !found) << of << ", " << t.caption << all;
  return found;
}

std::string with_report(const std::string& deck) {
  return replaced(deck, "report = false", "report = true");
}

/// A cell of a table that is no file.
struct Shown {
  const char* deck;
  const char* caption;
  std::size_t row;
  const char* column;
  const char* unit;
  const char* text;  ///< five digits
  const char* why;
};

const char* const stations = "Stations";
const char* const masses = "Masses";
const char* const damping = "Damping of the modes at 0 rpm: physical, and what the steps add";
const char* const largest = "Largest section forces and stresses";

const Shown shown[] = {
    {"cantilever", stations, 0, "s", "m", "0", "its left end"},
    {"cantilever", stations, 1, "s", "m", "1", "its length"},
    {"cantilever", stations, 1, "outer diameter", "mm", "50", "given"},
    {"cantilever", stations, 1, "node", "-", "4", "four elements"},
    {"cantilever", stations, 1, "station", "-", "section 1:end, load 'load 1'", "what is there"},
    {"cantilever", masses, 0, "shaft", "-", "r", "its name"},
    {"cantilever", masses, 0, "mass", "kg", "15.413", "7850 kg/m^3"},
    {"cantilever", masses, 0, "centre", "m", "0.5", "half its length"},
    {"cantilever", masses, 0, "Ip", "kg·m²", "0.0048167", "m r^2/2"},
    {"cantilever", masses, 0, "Id", "kg·m²", "1.2869", "m (3 r^2 + L^2)/12"},
    {"unbalance", masses, 0, "mass", "kg", "10", "of the disk"},
    {"unbalance", masses, 0, "centre", "mm", "100", "at the disk"},
    {"unbalance", masses, 0, "Ip", "kg·m²", "0.1", "given"},
    {"unbalance", masses, 0, "Id", "kg·m²", "0.06", "given"},
    {"unbalance", stations, 2, "s", "mm", "200", "its right end"},
    {"unbalance", stations, 2, "station", "-", "right:end", "what is there"},
    // wall at the left, 206.155 N at the end of 1 m
    {"cantilever", largest, 0, "value", "-", "0.32983", "F^2 L^2/(2 E I)"},
    {"cantilever", largest, 0, "s", "m", "1", "the steepest"},
    {"cantilever", largest, 1, "quantity", "-", "shear force", "the second"},
    {"cantilever", largest, 1, "value", "-", "206.16", "resultant"},
    {"cantilever", largest, 1, "unit", "-", "N", "of a force"},
    {"cantilever", largest, 3, "value", "-", "206.16", "F L"},
    {"cantilever", largest, 3, "unit", "-", "N·m", "of a moment"},
    {"cantilever", largest, 5, "value", "-", "16.799", "32 M/(pi d^3)"},
    {"cantilever", largest, 5, "unit", "-", "MPa", "of a stress"},
    {"cantilever", largest, 5, "s", "m", "0", "the wall"},
    {"cantilever", largest, 7, "quantity", "-", "von Mises stress", "the last"},
    {"cantilever", largest, 7, "value", "-", "16.799", "bending alone"},
    // w_n sqrt(1 - zeta^2)
    {"limited", damping, 0, "frequency", "Hz", "49.696", "of the twist"},
    {"limited", damping, 0, "motion", "-", "torsional", "of the twist"},
    {"limited", damping, 0, "physical damping ratio", "-", "0.15811", "zeta"},
    {"limited", damping, 1, "frequency", "Hz", "50.102", "lateral"},
    {"limited", damping, 1, "physical damping ratio", "-", "0.094868", "zeta"},
    {"limited", "Peaks", 0, "amplitude 0-peak", "mm", "1.2", "the limit"},
    {"limited", "Peaks", 0, "motion 0-peak", "µm", "600", "half the way"},
    {"limited", "Peaks", 0, "speed", "rpm", "0", "does not turn"},
    {"limited", "Peaks", 0, "time", "s", "0.0060575", "the first passage"},
    {"limited", "Peaks", 0, "motion at", "s", "0.0060575", "the first passage"},
};

void expect_shown(const std::vector<PageTable>& all, const Shown& s) {
  const std::string of = std::string(s.deck) + ", " + s.caption + ", " + s.column;
  const auto t = std::find_if(all.begin(), all.end(),
                              [&](const PageTable& x) { return x.caption == s.caption; });
  ASSERT_NE(t, all.end()) << of;
  const auto c = std::find(t->names.begin(), t->names.end(), s.column);
  ASSERT_NE(c, t->names.end()) << of;
  const auto k = static_cast<std::size_t>(c - t->names.begin());
  ASSERT_LT(s.row, t->rows.size()) << of;
  EXPECT_EQ(t->units[k], s.unit) << of;
  EXPECT_EQ(t->rows[s.row][k], s.text) << of << ": " << s.why;
}

}  // namespace

TEST(ReportTables, AreThoseOfTheFilesOrOfClosedForms) {
  const auto decks = test::written_decks();
  const std::set<std::string> alone{stations, masses, damping, largest, "Peaks"};
  std::size_t compared = 0, read = 0;
  for (const char* name :
       {"arms at rest", "campbell", "cantilever", "events", "harmonic peaks", "laden rectangle",
        "limited", "operated above the peak", "path", "speed-coupled", "struts", "unbalance"}) {
    const DeckRun run(with_report(decks.at(name)));
    ASSERT_EQ(run.exit, 0) << name << "\n" << run.log;
    const std::vector<PageTable> all = tables_of(run);
    for (const PageTable& t : all) {
      if (t.rows.size() == 1 && t.rows[0].size() == 1) continue;  // "none"
      if (alone.contains(t.caption)) continue;
      EXPECT_TRUE(is_a_file(t, run, name)) << name << ", " << t.caption;
      ++compared;
    }
    for (const Shown& s : shown) {
      if (std::string(name) != s.deck) continue;
      expect_shown(all, s);
      ++read;
    }
  }
  EXPECT_GT(compared, 15u);
  EXPECT_EQ(read, std::size(shown));
}

namespace {

/// 1 kg mm on 10 kg, a stop that is not reached; modes of one motion each, about the rotor at rest
/// and about it as drawn.
const char* const three_steps = R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
krxx = "1e4 N.m/rad"
[[bearing]]
name = "stop"
at = "mass"
type = "rub"
gap = "2 mm"
stiffness = "5e6 N/m"
[[probe]]
name = "P"
at = "mass"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
[[step]]
name = "u"
type = "unbalance_response"
about = "undeformed"
speed = { values = ["2000 rpm", "3000 rpm"], refine = "no" }
[[step]]
name = "m"
type = "modal"
motion = "torsional"
modes = 1
[[step]]
name = "n"
type = "modal"
motion = "lateral"
about = "undeformed"
modes = 2
[output]
report = true
)";

/// From a heading of the page to the next.
std::string section_of(const std::string& page, const std::string& heading) {
  const std::size_t at = page.find("<h2>" + heading);
  return at == std::string::npos ? "" : page.substr(at, page.find("</section>", at) - at);
}

}  // namespace

TEST(ReportTables, SayWhatTheyAreAbout) {
  const DeckRun run(test::lateral_mass(10, "0 m/s^2", three_steps));
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::string page = text_of(run.folder / "r" / "report.html");
  struct Step {
    const char* heading;
    const char* about;
    const char* motion;
  };
  const char *lateral = "Lateral motion:", *torsional = "Torsional motion:";
  for (const Step& s : {Step{"u: unbalance response", "about the undeformed rotor", ""},
                        {"m: whirl modes", "about the static equilibrium at 0 rpm", torsional},
                        {"n: whirl modes", "about the undeformed rotor", lateral}}) {
    const std::string section = section_of(page, s.heading);
    EXPECT_NE(section.find(std::string("Linearised ") + s.about + "."), std::string::npos)
        << s.heading;
    for (const char* motion : {lateral, torsional})
      EXPECT_EQ(section.find(motion) != std::string::npos, std::string(motion) == s.motion)
          << s.heading;
    for (const std::string& caption : parts(section, "<caption", "</caption>"))
      EXPECT_TRUE(caption.starts_with("Clearances") ||
                  caption.ends_with(std::string(", ") + s.about))
          << caption;
    // the page's list of contents leads to each
    EXPECT_NE(page.find(std::string(">") + s.heading + "</a>"), std::string::npos) << s.heading;
  }
  // m_u w^2/|k - m w^2 + i c w| at 3000 rpm: 522.35 um
  const std::vector<PageTable> all = tables_of(run);
  for (const auto& [column, unit, text] : {std::tuple{"at", "-", "stop"},
                                           {"position", "mm", "100"},
                                           {"gap", "mm", "2"},
                                           {"largest displacement", "µm", "522.35"},
                                           {"of the gap", "%", "26.118"},
                                           {"when", "-", "at 3000 rpm"}})
    expect_shown(all, {"three steps", "Clearances: u, response to unbalance", 0, column, unit, text,
                       "closed form"});
}

// Whatever table stands in the folder, the page leads to it.
TEST(ReportTables, AreLinked) {
  const auto decks = test::written_decks();
  const std::set<std::string> open{"st_joints.csv", "t_peaks.csv"};  // stand in the page alone
  std::size_t linked = 0;
  for (const char* name : {"arms at rest", "ball bearing at its node", "campbell", "circle",
                           "floating rings", "harmonic peaks", "modes", "operated at the peak",
                           "orbits", "path", "speed-coupled", "struts", "tilting pads"}) {
    const DeckRun run(with_report(decks.at(name)));
    ASSERT_EQ(run.exit, 0) << name << "\n" << run.log;
    const std::string page = text_of(run.folder / "r" / "report.html");
    for (const auto& entry : fs::directory_iterator(run.folder / "r")) {
      const std::string file = entry.path().filename().string();
      if (entry.path().extension() != ".csv" || open.contains(file)) continue;
      EXPECT_NE(page.find("href=\"" + file + "\""), std::string::npos) << name << ", " << file;
      ++linked;
    }
  }
  EXPECT_GT(linked, 30u);
}
