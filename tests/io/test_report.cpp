// The report: one file, nothing from outside, complete without its script, alive with it.
#include "gallery.hpp"
#include "temp_folder.hpp"
#include "xml_check.hpp"
#include <io/file.hpp>
#include <io/report.hpp>
#include <io/report/assets.hpp>
#include <cstdlib>
#include <set>

namespace whirl::io {
namespace {

/// Wider than a telephone, with names that a style sheet could trip over.
Table wide_table() {
  Table t;
  t.title = "Compliance";
  t.columns = {{"check", "-", ""},    {"set's \\ \"name\" & more", "-", ""},
               {"value", "-", ""},    {"", "-", ""},
               {"limit", "-", ""},    {"unit", "-", ""},
               {"result", "-", ""},   {"source", "-", ""},
               {"amplitude", "m", ""}};
  Table::Cell failed("failed");
  failed.mark = Table::Cell::Mark::failed;
  for (int k = 0; k < 3; ++k)
    t.add({"separation margin of mode " + std::to_string(k), "largest clearance", 0.1234567,
           ">=", 12.345e-7, "kg m2", failed, "API 617, 8th edition, 4.8.2.10", 1.2e-5});
  return t;
}

/// Does not fit either, and has none.
Table empty_table() {
  Table t = wide_table();
  t.title = "Peaks";
  t.rows.clear();
  return t;
}

Report sample() {
  Report r;
  r.title = "Test <rotor> & more";
  r.subtitle = "deck test.toml";
  r.facts = {{"run time", "3.4 s"}};
  r.warnings = {"look & see"};
  ReportSection a{"Step 'one'", "First paragraph.\n\nSecond.", {}, {}, {{"series", "one.csv"}}};
  Table t;
  t.title = "Modes";
  t.columns = {{"mode", "", ""}, {"frequency", "Hz", "damped"}};
  t.add({"1st", 12.34567891});
  a.tables.push_back(t);
  ReportSection b{"Step 'two'", "", {}, {}, {}};
  b.tables = {wide_table(), empty_table()};
  int k = 0;
  for (auto& f : gallery())
    (k++ % 2 ? a : b).figures.push_back(f);
  r.sections = {a, b};
  r.deck = "title = \"<x>\"\n";
  r.summary["steps"]["accepted"] = 12;
  r.summary["left out"].push("torsion");
  return r;
}

TEST(Report, IsSelfContained) {
  const std::string html = render_report(sample());
  EXPECT_EQ(html.find("http:"), std::string::npos);
  EXPECT_EQ(html.find("https:"), std::string::npos);
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_EQ(html.find(" src="), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  for (std::size_t at = html.find("href=\""); at != std::string::npos;
       at = html.find("href=\"", at + 1)) {
    const auto target = html.substr(at + 6, 5);
    EXPECT_TRUE(target[0] == '#' || target == "data:" || target == "one.c") << target;
  }
}

TEST(Report, ScriptAndStyleAreTheFilesOfTheSource) {
  EXPECT_EQ(std::string(report_js), read_text("../../src/io/report/report.js"));
  EXPECT_EQ(std::string(report_css), read_text("../../src/io/report/report.css"));
}

TEST(Report, HoldsEverythingInOrderAndEscaped) {
  const std::string html = render_report(sample());
  std::size_t last = 0;
  for (const char* part :
       {"<title>Test &lt;rotor&gt; &amp; more</title>", "run time", "look &amp; see",
        "Step 'one'</h2>", "First paragraph.</p>", "<p>Second.", "12.346", "one.csv",
        "Step 'two'</h2>", "accepted", "torsion", "title = &quot;&lt;x&gt;&quot;", "<script>"}) {
    const auto at = html.find(part, last);
    ASSERT_NE(at, std::string::npos) << part;
    last = at;
  }
  // Every figure's SVG is well-formed on its own.
  std::size_t figures = 0;
  for (std::size_t at = html.find("<svg"); at != std::string::npos;
       at = html.find("<svg", at + 1), ++figures)
    EXPECT_EQ(xml_fault(html.substr(at, html.find("</svg>", at) + 6 - at)), "");
  EXPECT_EQ(figures, 2 * gallery().size());  // for desks and for telephones
}

// What is beside each other in one unit has one prefix while that leaves it its digits; rounding is 0.
TEST(Report, TablesHaveUnitsAndDigitsThatSuit) {
  Table t;
  t.columns = {{"part", "-", ""},  {"lowest", "N m", ""}, {"highest", "N m", ""},
               {"ratio", "-", ""}, {"y", "m", ""},        {"z", "m", ""},
               {"share", "%", ""}, {"torque", "N.m", ""}};
  t.add({"shaft", -16840.0, 4384.0, 1e-11, 3e-22, 2e-6, 2e-6, 5.0});
  t.add({"coupling", 1.0, 2e-9, 1.0, 0.0, 1e-9, 100.0, 25000.0});
  Table none;
  none.title = "Onset";
  none.columns = {{"speed", "rpm", ""}, {"kind", "-", ""}};
  Report r;
  r.title = "tables";
  r.sections = {{"one", "", {t, none}, {}, {}}};
  const std::string html = render_report(r);
  const auto numbers = [](std::vector<const char*> cells) {
    std::string row;
    for (const char* c : cells)
      row += std::string("<td class=\"n\">") + c + "</td>";
    return row;
  };
  for (const std::string& part :
       {std::string("lowest<small>kN·m</small>"), std::string("highest<small>kN·m</small>"),
        std::string("y<small>µm</small>"), std::string("z<small>µm</small>"),
        std::string("torque<small>kN·m</small>"),
        numbers({"−16.84", "4.384", "1×10⁻¹¹", "0", "2", "0", "0.005"}),
        numbers({"0.001", "0", "1", "0", "0.001", "100", "25"}),
        std::string("<td colspan=\"2\">none</td>")})
    EXPECT_NE(html.find(part), std::string::npos)
        << part << html.substr(html.find("<caption"), 900);
}

// On paper a table is as wide as its numbers; what a page cannot take is set smaller. Units are
// printed as one writes them.
TEST(Report, WideTablesFitThePage) {
  const auto html_of = [](std::size_t columns) {
    Table t;
    t.columns = {{"bearing", "-", ""}};
    std::vector<Table::Cell> row{"DE"};
    for (std::size_t k = 0; k < columns; ++k) {
      t.columns.push_back({"inflow", "m^3/s", ""});
      row.emplace_back(1.2345e-5);
    }
    t.rows.push_back(row);
    Report r;
    r.sections = {{"one", "", {t}, {}, {}}};
    return render_report(r);
  };
  const std::string narrow = html_of(3), wide = html_of(20);
  EXPECT_EQ(narrow.find("--print:"), std::string::npos);
  const std::size_t at = wide.find("--print:");
  ASSERT_NE(at, std::string::npos);
  const double size = std::stod(wide.substr(at + 8));
  EXPECT_GT(size, 3);
  // "1.2345x10^-5" has eleven letters of 0.58 em and 0.75 em of air
  EXPECT_LE(size * 20 * (11 * 0.58 + 0.75), 510);
  EXPECT_NE(narrow.find("<small>m³/s</small>"), std::string::npos);
}

TEST(Report, WideTablesLeaveEmptyColumnsOut) {
  const auto html_of = [](std::size_t columns) {
    Table t;
    for (std::size_t k = 0; k < columns; ++k)
      t.columns.push_back({"column " + std::to_string(k), "-", ""});
    for (int row = 0; row < 3; ++row) {
      std::vector<Table::Cell> cells(columns, Table::Cell(1.0));
      cells[2] = Table::Cell(nan);
      if (row == 1) cells[3] = Table::Cell(nan);
      t.rows.push_back(std::move(cells));
    }
    Report r;
    r.sections = {{"one", "", {t}, {}, {}}};
    return render_report(r);
  };
  const std::string narrow = html_of(5), wide = html_of(12);
  EXPECT_NE(narrow.find(">column 2<"), std::string::npos);
  EXPECT_EQ(wide.find(">column 2<"), std::string::npos);
  for (const char* kept : {">column 1<", ">column 3<", ">column 11<"})
    EXPECT_NE(wide.find(kept), std::string::npos) << kept;
}

// What an earlier section shows is not printed again: there is a link to it.
TEST(Report, SameTableIsPrintedOnce) {
  Table masses;
  masses.title = "Masses";
  masses.columns = {{"shaft", "-", ""}, {"mass", "kg", ""}};
  masses.add({"rotor", 12.5});
  Table others = masses;
  others.rows[0][1] = 13.5;
  Report r;
  r.sections = {{"Rotor", "", {masses}, {}, {}}, {"lateral", "", {masses, others}, {}, {}}};
  const std::string html = render_report(r);
  const auto times = [&html](const std::string& what) {
    int n = 0;
    for (std::size_t at = html.find(what); at != std::string::npos; at = html.find(what, at + 1))
      ++n;
    return n;
  };
  EXPECT_EQ(times("<caption>Masses</caption>"), 2);
  EXPECT_EQ(times(">12.5</td>"), 1);
  EXPECT_EQ(times(">13.5</td>"), 1);
  EXPECT_EQ(times("Masses: as in <a href=\"#s1\">Rotor</a>"), 1);
}

TEST(Report, SameFigureInTwoStepsGetsTwoIds) {
  Report r;
  const plot::Figure f = gallery().front();
  r.sections = {{"a", "", {}, {f}, {}}, {"b", "", {}, {f}, {}}};
  const std::string html = render_report(r);
  std::set<std::string> ids;
  std::size_t figures = 0;
  for (std::size_t at = html.find(" id=\""); at != std::string::npos;
       at = html.find(" id=\"", at + 1)) {
    const auto id = html.substr(at + 5, html.find('"', at + 5) - at - 5);
    EXPECT_TRUE(ids.insert(id).second) << id;
    figures +=
        html.compare(at - 6, 6, "figure") == 0 || html.compare(at - 7, 7, "figure\"") == 0 ? 1 : 0;
  }
  EXPECT_EQ(figures, 2u);
}

TEST(Report, OneSectionAndNothingElse) {
  Report r;
  r.title = "x";
  r.sections.push_back({"only", "", {}, {}, {}});
  const std::string html = render_report(r);
  EXPECT_EQ(html.find("<nav"), std::string::npos);
  EXPECT_EQ(html.find("<details"), std::string::npos);
}

/// What a script finds in a report that a browser shows in a window so wide: "ok", or what is wrong.
std::string found_in_browser(const std::string& report, const char* script, int width) {
  TempFolder dir;
  std::string html = report;
  html.insert(html.find("<style>"),
              "<script>window.faults=[];window.onerror=(m)=>{faults.push(m)};"
              "console.error=(m)=>{faults.push(m)};window.wanted=" +
                  std::to_string(width) + "</script>");
  html.insert(html.find("</body>"), "<script>" + read_text(script) + "</script>");
  write_atomic(dir / "report.html", html);
  // in a frame: no window of a browser is as narrow as a telephone
  write_atomic(dir / "screen.html",
               "<body style=\"margin:0\"><iframe style=\"border:0\" src=\"report.html\" "
               "height=\"1000\" width=\"" +
                   std::to_string(width) +
                   "\"></iframe><script>onload=()=>document.body.append("
                   "frames[0].document.getElementById('probe'))</script></body>");
  const std::string run =
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking "
      "--disable-component-update --disable-sync --hide-scrollbars "
      "--allow-file-access-from-files --window-size=1500,1000 --user-data-dir=" +
      (dir / "profile").string() + " --dump-dom file://" + (dir / "screen.html").string() + " > " +
      (dir / "dom.html").string() + " 2>/dev/null";
  if (std::system(run.c_str()) != 0) return "chromium fails";
  const std::string dom = read_text(dir / "dom.html");
  const auto at = dom.rfind("<pre id=\"probe\">");  // the script itself names it too
  if (at == std::string::npos) return "no outcome";
  return dom.substr(at + 16, dom.find("</pre>", at) - at - 16);
}

bool browser_is_there() { return std::system("chromium --version >/dev/null 2>&1") == 0; }

// In a real browser, where there is one: no script error, the readout shows the values that were
// plotted, the wheel zooms, the legend hides a curve, dragging turns a figure in space, double
// click brings everything back. On a telephone the same of the narrow drawings.
TEST(Report, LivesInABrowser) {
  if (!browser_is_there()) GTEST_SKIP() << "no chromium";
  const std::string html = render_report(sample());
  for (const int width : {1300, 390})
    EXPECT_EQ(found_in_browser(html, "report_probe.js", width), "ok") << width;
}

// Nothing has to be moved sideways, page, table or figure; no letter is too small to be read, and none
// stands outside its figure.
TEST(Report, FitsTelephoneAndDesk) {
  if (!browser_is_there()) GTEST_SKIP() << "no chromium";
  Report r = sample();
  for (plot::Figure f : gallery())
    if (f.axes.front().kind == plot::AxesKind::space) {
      f.name += "_long";  // the script writes the titles of axes again
      f.axes.front().z.label = "z, deflection enlarged 11681 times";
      f.axes.front().space_aspect = {3, 1, 1};
      r.sections.back().figures.push_back(f);
    }
  const std::string html = render_report(r);
  for (const int width : {390, 1400})
    EXPECT_EQ(found_in_browser(html, "fit_probe.js", width), "ok") << width;
}

}  // namespace
}  // namespace whirl::io
