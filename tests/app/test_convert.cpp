// Models of other programs: converted by the program, then run.
#include "../io/temp_folder.hpp"
#include "deck_run.hpp"
#include "write_workbook.hpp"

#include <convert/convert.hpp>
#include <deck/deck.hpp>
#include <fmt/format.h>
#include <numbers>

using namespace whirl;
using convert::Converted;
using test::Columns;
using test::DeckRun;
namespace fs = std::filesystem;

namespace {

std::string ross_shaft(int n, double L, double od, const std::string& more = "") {
  return fmt::format(
      "\"ShaftElement_s {0}\": {{\"L\": {1}, \"idl\": 0.0, \"odl\": {2}, \"idr\": 0.0, \"odr\": "
      "{2}, "
      "\"material\": {{\"name\": \"Steel\", \"rho\": 7810.0, \"E\": 211e9, \"G_s\": 81.2e9}}, "
      "\"n\": {0}{3}}}",
      n, L, od, more);
}

/// The rotor of ROSS's documentation (rotor_example), as its files are written.
std::string ross_example() {
  std::string s = "{\"ross_version\": \"2.3.0\", \"parameters\": {\"rated_w\": null}";
  for (int n = 0; n < 6; ++n)
    s += ",\n" + ross_shaft(n, 0.25, 0.05);
  for (const int n : {2, 4})
    s += fmt::format(
        ",\n\"DiskElement_Disk {0}\": {{\"n\": {0}, \"m\": 32.58972765304033, \"Id\": "
        "0.17808928257067666, \"Ip\": 0.32956362089137037, \"tag\": null}}",
        n);
  for (const int n : {0, 6})
    s += fmt::format(
        ",\n\"BearingElement_Bearing {0}\": {{\"n\": {0}, \"n_link\": null, \"frequency\": "
        "null, \"kxx\": [1e6], \"kyy\": [0.8e6], \"cxx\": [0], \"tag\": \"Bearing {0}\"}}",
        n);
  return s + "}\n";
}

bool says(const Converted& c, const std::string& what) {
  for (const Diagnostic& d : c.left_out)
    if ((d.where.entity + d.message).find(what) != std::string::npos) return true;
  return false;
}

std::string refusal(const std::string& json) {
  try {
    convert::convert_ross_json(json, "rotor.json");
  } catch (const Error& e) {
    return e.diagnostics().front().code + " " + e.what();
  }
  return "taken";
}

}  // namespace

TEST(Convert, RossExampleHasItsPublishedFrequencies) {
  const Converted c = convert::convert_ross_json(ross_example(), "rotor.json");
  EXPECT_TRUE(c.left_out.empty());
  const DeckRun run(c.text);
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns modes(run.folder / "r" / "modes_modes.csv");
  const std::size_t frequency = modes.column("frequency [Hz]");
  // rad/s, printed by Rotor.run_modal(speed=0) in ROSS's documentation; 6 elements there
  EXPECT_NEAR(2 * std::numbers::pi * modes.rows[0][frequency], 91.79655318, 2e-4);
  EXPECT_NEAR(2 * std::numbers::pi * modes.rows[1][frequency], 96.28899977, 2e-4);
}

// A hollow cone of a material without G_s and a cylinder of another; ROSS's x and y are y and z here.
TEST(Convert, EveryNumberOfARossRotorArrives) {
  const std::string json = R"({"ross_version": "2.3.0", "parameters": {"rated_w": null},
"ShaftElement_s 0": {"L": 0.3, "idl": 0.01, "odl": 0.06, "idr": 0.02, "odr": 0.04, "n": 0,
  "material": {"name": "Bronze", "rho": 8800.0, "E": 1.1e11, "Poisson": 0.375}},
"ShaftElement_s 1": {"L": 0.2, "idl": 0.0, "odl": 0.05, "idr": 0.0, "odr": 0.05, "n": 1,
  "material": {"name": "Steel", "rho": 7810.0, "E": 2.11e11, "G_s": 8.12e10}},
"DiskElement_d": {"n": 1, "m": 12.0, "Id": 0.07, "Ip": 0.11, "tag": "wheel"},
"BearingElement_b": {"n": 0, "n_link": null, "frequency": null, "kxx": [1e6], "kyy": [2e6],
  "kxy": [3e5], "kyx": [-4e5], "cxx": [10.0], "cyy": [20.0], "cxy": [3.0], "cyx": [-4.0],
  "tag": "left"},
"BearingElement_c": {"n": 2, "n_link": null, "frequency": null, "kxx": [5e6], "cxx": [50.0],
  "tag": "right"}})";
  const Converted c = convert::convert_ross_json(json, "rotor.json");
  const auto deck = deck::read_deck_text(c.text, "d.toml");
  ASSERT_TRUE(deck.ok()) << deck.report() << c.text;
  const model::Model& m = deck.model;
  ASSERT_EQ(m.shafts.size(), 1u);
  ASSERT_EQ(m.shafts[0].sections.size(), 2u);
  const model::Section &cone = m.shafts[0].sections[0], &rod = m.shafts[0].sections[1];
  EXPECT_NEAR(cone.length, 0.3, 1e-12);
  EXPECT_NEAR(cone.od_l, 0.06, 1e-12);
  EXPECT_NEAR(cone.od_r, 0.04, 1e-12);
  EXPECT_NEAR(cone.id_l, 0.01, 1e-12);
  EXPECT_NEAR(cone.id_r, 0.02, 1e-12);
  EXPECT_NEAR(rod.length, 0.2, 1e-12);
  EXPECT_NEAR(rod.od_l, 0.05, 1e-12);
  EXPECT_NEAR(rod.id_r, 0, 1e-12);
  const model::Material &bronze = m.materials.at(cone.material),
                        &steel = m.materials.at(rod.material);
  EXPECT_NEAR(bronze.E, 1.1e11, 1);
  EXPECT_NEAR(bronze.rho, 8800, 1e-9);
  EXPECT_NEAR(bronze.G, 1.1e11 / 2.75, 1e3);  // E/(2 (1 + nu))
  EXPECT_NEAR(steel.E, 2.11e11, 1);
  EXPECT_NEAR(steel.G, 8.12e10, 1e3);
  EXPECT_NEAR(steel.rho, 7810, 1e-9);
  ASSERT_EQ(m.disks.size(), 1u);
  EXPECT_NEAR(m.disks[0].at.s, 0.3, 1e-12);
  EXPECT_NEAR(m.disks[0].mass, 12, 1e-12);
  EXPECT_NEAR(m.disks[0].Id, 0.07, 1e-12);
  EXPECT_NEAR(m.disks[0].Ip, 0.11, 1e-12);
  std::size_t found = 0;
  for (const model::Bearing& b : m.bearings) {
    const auto* linear = std::get_if<model::LinearBearing>(&b.law);
    if (!linear || b.name.find("thrust") != std::string::npos) continue;
    ++found;
    const bool left = b.at.s < 0.1;
    EXPECT_NEAR(b.at.s, left ? 0 : 0.5, 1e-12);
    const auto block = [](const Matrix<6>& x) { return Mat2(x.block<2, 2>(1, 1)); };
    const Mat2 K = left ? Mat2{{1e6, 3e5}, {-4e5, 2e6}} : Mat2{{5e6, 0}, {0, 5e6}},
               C = left ? Mat2{{10, 3}, {-4, 20}} : Mat2{{50, 0}, {0, 50}};
    EXPECT_NEAR((block(linear->K) - K).norm(), 0, 1e-6) << b.name;
    EXPECT_NEAR((block(linear->C) - C).norm(), 0, 1e-9) << b.name;
  }
  EXPECT_EQ(found, 2u) << c.text;
}

// Its tables of letters know nothing of some that may stand in quotes alone.
TEST(Convert, TomlThatNoLibraryMayReadIsRefused) {
  for (const std::string text : {"length \u00b7m = 1\n", "\u00e9 = 1\n", "a = \x01\n"})
    try {
      convert::convert_ross_toml(text, "rotor.toml");
      FAIL() << text;
    } catch (const Error& e) {
      EXPECT_EQ(e.diagnostics().front().code, "E03") << text;
      EXPECT_EQ(e.diagnostics().front().where.line, 1) << text;
    }
}

TEST(Convert, TomlAndJsonOfOneRotorGiveOneDeck) {
  const std::string toml = R"(ross_version = "2.3.0"
[parameters]
rated_w = 100.0
["ShaftElement_s 0"]
L = 0.25
idl = 0.0
odl = 0.05
idr = 0.0
odr = 0.04
n = 0
["BearingElement_b"]
n = 1
kxx = [ 1e6,]
kyy = [ 2e6,]
kxy = [ 3e5,]
kyx = [ -3e5,]
kzz = [ 4e5,]
cxx = [ 10.0,]
["ShaftElement_s 0".material]
name = "steel"
rho = 7810.0
E = 2.11e11
G_s = 8.12e10
)";
  const std::string json = R"({"ross_version": "2.3.0", "parameters": {"rated_w": 100.0},
"ShaftElement_s 0": {"L": 0.25, "idl": 0.0, "odl": 0.05, "idr": 0.0, "odr": 0.04, "n": 0,
 "material": {"name": "steel", "rho": 7810.0, "E": 2.11e11, "G_s": 8.12e10}},
"BearingElement_b": {"n": 1, "kxx": [1e6], "kyy": [2e6], "kxy": [3e5], "kyx": [-3e5], "kzz": [4e5],
 "cxx": [10.0]}})";
  const Converted a = convert::convert_ross_toml(toml, "r"),
                  b = convert::convert_ross_json(json, "r");
  EXPECT_EQ(a.text, b.text);
  // x, y, z of ROSS are y, z, x; cyy follows cxx
  const deck::Deck read = deck::read_deck_text(a.text);
  ASSERT_TRUE(read.ok()) << read.report();
  for (const char* line : {"kyy = \"1000000 N/m\"", "kzz = \"2000000 N/m\"", "kyz = \"300000 N/m\"",
                           "kzy = \"-300000 N/m\"", "kxx = \"400000 N/m\"", "cyy = \"10 N.s/m\"",
                           "czz = \"10 N.s/m\"", "od_r[mm]"})
    EXPECT_NE(a.text.find(line), std::string::npos) << line << "\n" << a.text;
}

TEST(Convert, LayersBecomeSleevesAndSums) {
  const auto layer = [](const char* tag, double id, double od, double E, double rho) {
    return fmt::format(
        "\"ShaftElement_{}\": {{\"n\": 0, \"L\": 0.5, \"idl\": {}, \"odl\": {}, "
        "\"material\": {{\"name\": \"{}\", \"rho\": {}, \"E\": {}, \"G_s\": {}}}}}",
        tag, id, od, tag, rho, E, E / 2.6);
  };
  const std::string soft =
      "{" + layer("core", 0, 0.05, 2e11, 7800) + "," + layer("sleeve", 0.05, 0.08, 2e4, 7800) + "}";
  EXPECT_NE(
      convert::convert_ross_json(soft, "r").text.find("[\"s0\", 500.0, 80.0, 0.0, 50.0, 0.0]"),
      std::string::npos);
  const std::string two = "{" + layer("core", 0, 0.05, 2e11, 7800) + "," +
                          layer("sleeve", 0.05, 0.08, 7e10, 2700) + "}";
  const Converted c = convert::convert_ross_json(two, "r");
  EXPECT_TRUE(says(c, "layers of different materials"));
  const deck::Deck read = deck::read_deck_text(c.text);
  ASSERT_TRUE(read.ok()) << read.report();
  const double pi = std::numbers::pi;
  const double EI =
      pi / 64 * (2e11 * std::pow(0.05, 4) + 7e10 * (std::pow(0.08, 4) - std::pow(0.05, 4)));
  ASSERT_TRUE(read.model.shafts[0].sections[0].constants);
  EXPECT_NEAR(read.model.shafts[0].sections[0].constants->EI / EI, 1, 1e-11);
}

// One after the other the layers of an element would make the rotor longer.
TEST(Convert, LayersInRowsOfAStationTableAreRefused) {
  for (const char* text :
       {"Element,Layer,Length [mm],OD [mm],ID [mm]\n1,1,100,50,0\n1,2,100,80,50\n"
        "2,1,200,60,0\n",
        "Element,Length [mm],OD [mm],ID [mm]\n1,100,50,0\n1,100,80,50\n"})
    EXPECT_THROW(convert::convert_csv(text, "x.csv"), Error) << text;
  EXPECT_NO_THROW(convert::convert_csv(
      "Element,Layer,Length [mm],OD [mm],ID [mm]\n1,1,100,50,0\n2,1,100,80,50\n", "x.csv"));
}

TEST(Convert, PedestalsAndTablesOfRoss) {
  const std::string json =
      "{" + ross_shaft(0, 0.5, 0.05) + "," + ross_shaft(1, 0.5, 0.05) +
      R"(,"BearingElement_pads": {"n": 0, "n_link": 3, "frequency": [200.0, 100.0],
 "kxx": [2e7, 1e7], "kyy": [2e7, 1e7], "cxx": [2e4, 1e4]},
"BearingElement_ground": {"n": 3, "kxx": [1e8], "kyy": [2e8], "cxx": [5.0]},
"PointMass_p": {"n": 3, "m": 12.0, "tag": "p"},
"BearingElement_right": {"n": 2, "kxx": [1e7]}})";
  const Converted c = convert::convert_ross_json(json, "r");
  const deck::Deck read = deck::read_deck_text(c.text);
  ASSERT_TRUE(read.ok()) << read.report();
  ASSERT_EQ(read.model.bearings.size(), 2u);
  ASSERT_TRUE(read.model.bearings[0].pedestal);
  EXPECT_DOUBLE_EQ(read.model.bearings[0].pedestal->mass, 12.0);
  EXPECT_NE(c.text.find("[100.0, 10000000.0, 10000000.0, 10000.0, 10000.0]"), std::string::npos)
      << c.text;
  EXPECT_TRUE(says(c, "its last row holds"));
}

// What ties the mass of a pedestal to the ground may be several elements, and some of them have mass.
TEST(Convert, APedestalHasAllThatTiesItToTheGround) {
  const std::string shaft = "{" + ross_shaft(0, 0.5, 0.05) + "," + ross_shaft(1, 0.5, 0.05);
  const std::string right = R"(,"BearingElement_right": {"n": 2, "kxx": [1e7]}})";
  const std::string left = R"(,"BearingElement_left": {"n": 0, "n_link": 3, "kxx": [2e7]})";
  const Converted c = convert::convert_ross_json(
      shaft + left +
          R"(,"BearingElement_springs": {"n": 3, "kxx": [1e8], "kyy": [2e8], "kxy": [3e6]},
"BearingElement_dampers": {"n": 3, "kxx": [1e6], "kyy": [0], "cxx": [5e4], "cyy": [6e4], "mxx": [7], "myy": [7]},
"PointMass_p": {"n": 3, "m": 12.0}, "PointMass_q": {"n": 3, "m": 1.0},
"BearingElement_beside": {"n": 8, "kxx": [1e8]})" +
          right,
      "r");
  const deck::Deck read = deck::read_deck_text(c.text);
  ASSERT_TRUE(read.ok()) << read.report() << c.text;
  const auto& pedestal = read.model.bearings.at(0).pedestal;
  ASSERT_TRUE(pedestal);
  EXPECT_DOUBLE_EQ(pedestal->mass, 20.0);
  EXPECT_DOUBLE_EQ(pedestal->K(1, 1), 1.01e8);
  EXPECT_DOUBLE_EQ(pedestal->K(2, 2), 2e8);
  EXPECT_DOUBLE_EQ(pedestal->K(1, 2), 3e6);
  EXPECT_DOUBLE_EQ(pedestal->C(1, 1), 5e4);
  EXPECT_DOUBLE_EQ(pedestal->C(2, 2), 6e4);
  EXPECT_TRUE(says(c, "node 8, which no bearing ties to the shaft"));

  const std::string shared =
      R"(,"BearingElement_inner": {"n": 1, "n_link": 3, "kxx": [2e7]}, "BearingElement_g": {"n": 3, "kxx": [1e8]})";
  EXPECT_NE(refusal(shaft + left + shared + right).find("carries another element too"),
            std::string::npos);
}

TEST(Convert, WhatIsNotTakenIsSaid) {
  const std::string json =
      "{" + ross_shaft(0, 0.5, 0.05, ", \"axial_force\": 1000.0, \"gyroscopic\": false") +
      R"(,"TiltingPad_t": {"n": 0, "kxx": [1e7]}, "BearingElement_b": {"n": 1, "kxx": [1e7]},
"GearElement_g": {"n": 1, "m": 5.0, "Id": 0.1, "Ip": 0.2}, "Probe_p": {"n": 1}})";
  const Converted c = convert::convert_ross_json(json, "r");
  for (const char* what : {"axial force 1000 N", "gyroscopic", "TiltingPad", "without its mesh",
                           "class Probe is not taken over"})
    EXPECT_TRUE(says(c, what)) << what;
  EXPECT_NE(c.text.find("without its mesh"), std::string::npos)
      << "said at the head of the deck too";
}

TEST(Convert, RefusesWhatMakesNoShaft) {
  EXPECT_EQ(refusal("{}"), "E42 there is no ShaftElement in it");
  EXPECT_EQ(refusal("{" + ross_shaft(0, 0.5, 0.05) + "," + ross_shaft(2, 0.5, 0.05) + "}"),
            "E42 there is no shaft element at node 1");
  EXPECT_EQ(refusal("{" + ross_shaft(0, 0.5, 0.05) +
                    ",\"DiskElement_d\": {\"n\": 7, \"m\": 1, \"Id\": 1, \"Ip\": 2}}"),
            "E42 node 7 is not on the shaft, which ends at node 1");
  EXPECT_EQ(refusal("{\"ShaftElement_1\": {\"n\": 0, \"L\": \"long\"}}"),
            "E42 ShaftElement '1': 'L' is text, not a number");
  EXPECT_EQ(refusal("{" + ross_shaft(0, -0.5, 0.05) + "}"),
            "E42 ShaftElement 's 0': its length 'L' is not positive");
  std::string tube = "{" + ross_shaft(0, 0.5, 0.05) + "}";
  tube.replace(tube.find("\"idl\": 0.0"), 10, "\"idl\": 0.1");
  EXPECT_EQ(refusal(tube),
            "E42 ShaftElement 's 0': an inner diameter is not less than the outer one");
  std::string soft = "{" + ross_shaft(0, 0.5, 0.05) + "}";
  soft.replace(soft.find("211e9"), 5, "-2e11");
  EXPECT_EQ(refusal(soft), "E42 ShaftElement 's 0': rho, E or G_s of its material is not positive");
  EXPECT_EQ(refusal("[1, 2"), "E92 this is not JSON");
  EXPECT_EQ(refusal("{\"L\": [1, -1e730]}"), "E92 the number -1e730 is beyond what a double holds");
  EXPECT_EQ(refusal(std::string(100000, '[') + std::string(100000, ']')),
            "E92 nested more than 256 deep");
}

// Whether it is there or not: the way to a workbook that is read is told.
TEST(Convert, OldWorkbooksAreToBeSavedAnew) {
  for (const char* name : {"ROTOR.XLS", "rotor.ods"}) {
    try {
      convert::convert_file(name);
      ADD_FAILURE() << name;
    } catch (const Error& e) {
      const std::string said = e.diagnostics().front().hint;
      EXPECT_NE(said.find("CSV"), std::string::npos) << said;
      EXPECT_NE(said.find("soffice"), std::string::npos) << said;
      EXPECT_NE(said.find(name), std::string::npos) << said;
    }
  }
}

namespace {

// As spreadsheets write them: shared and own texts, a number with its rounding, a formula with its
// value, a gap, an empty row, a text with marks of how it is pronounced.
const char* const shaft_rows =
    "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>2</v></c></row>"
    "<row r=\"3\"><c r=\"A3\" t=\"s\"><v>0</v></c><c r=\"B3\" t=\"s\"><v>1</v></c>"
    "<c r=\"C3\" t=\"inlineStr\"><is><t>ID (mm)</t></is></c>"
    "<c r=\"D3\" t=\"inlineStr\"><is><t>Mass (kg)</t></is></c></row>"
    "<row r=\"4\"><c r=\"A4\"><v>250.10000000000002</v></c><c r=\"B4\"><f>2*25</f><v>50</v></c>"
    "<c r=\"D4\"><v>1.5</v></c></row>"
    "<row r=\"6\"><c r=\"A6\"><v>100</v></c><c r=\"B6\"><v>60</v></c><c "
    "r=\"C6\"><v>10</v></c></row>";
const char* const shaft_texts =
    "<si><t>Length (mm)</t></si><si><r><t>OD </t></r><r><t>(mm)</t></r><rPh sb=\"0\" "
    "eb=\"1\"><t>odee</t></rPh></si><si><t>Pump P-101, \"A\"</t></si>";

std::string refused_workbook(const std::map<std::string, std::string>& parts,
                             const std::string& sheet = {}) {
  const io::TempFolder folder;
  test::write_workbook(folder.path() / "rotor.xlsx", parts);
  try {
    convert::convert_file(folder.path() / "rotor.xlsx", sheet);
  } catch (const Error& e) {
    return e.diagnostics().front().code + " " + e.what();
  }
  return "taken";
}

}  // namespace

TEST(Convert, AWorkbookIsWhatItsSheetIsAsText) {
  const io::TempFolder folder;
  test::write_workbook(folder.path() / "rotor.xlsx", test::workbook_of(shaft_rows, shaft_texts));
  const Converted book = convert::convert_file(folder.path() / "rotor.xlsx");
  const Converted text = convert::convert_csv(
      "Length (mm),OD (mm),ID (mm),Mass (kg)\n250.1,50,,1.5\n100,60,10\n", "rotor.xlsx");
  EXPECT_TRUE(says(book, "\"Pump P-101, \"\"A\"\"\" above the titles is left out"));
  // but for what is said at its head
  const auto model = [](const std::string& deck) { return deck.substr(deck.find("[[shaft]]")); };
  EXPECT_EQ(model(book.text), model(text.text));
  EXPECT_TRUE(deck::read_deck_text(book.text, "deck.toml").ok());
}

TEST(Convert, ASheetOfAWorkbookIsNamed) {
  auto parts =
      test::workbook_of("<row><c t=\"inlineStr\"><is><t>a</t></is></c></row>", shaft_texts);
  parts["xl/workbook.xml"] =
      "<x:workbook xmlns:x=\"x\" xmlns:r=\"r\"><x:sheets><x:sheet name=\"Notes\" state=\"hidden\" "
      "r:id=\"rId1\"/><x:sheet name=\"Empty\" r:id=\"rId3\"/><x:sheet name=\"Shaft &amp; disks\" "
      "r:id=\"rId2\"/></x:sheets></x:workbook>";
  parts["xl/_rels/workbook.xml.rels"] =
      "<Relationships><Relationship Id=\"rId1\" Target=\"worksheets/sheet1.xml\"/><Relationship "
      "Id=\"rId2\" Target=\"/xl/worksheets/sheet2.xml\"/><Relationship Id=\"rId3\" "
      "Target=\"worksheets/sheet3.xml\"/></Relationships>";
  parts["xl/worksheets/sheet2.xml"] =
      std::string("<worksheet><sheetData>") + shaft_rows + "</sheetData></worksheet>";
  parts["xl/worksheets/sheet3.xml"] = "<worksheet><sheetData/></worksheet>";
  const io::TempFolder folder;
  const auto file = folder.path() / "rotor.xlsx";
  test::write_workbook(file, parts);
  const Converted first = convert::convert_file(file);
  EXPECT_TRUE(says(first, "sheet 'Shaft & disks' is read, 'Notes', 'Empty' are not"));
  EXPECT_EQ(convert::convert_file(file, "Shaft & disks").text.substr(0, 40),
            first.text.substr(0, 40));
  EXPECT_EQ(refused_workbook(parts, "Shaft"), "E42 it has no sheet 'Shaft'");
  EXPECT_EQ(refused_workbook(parts, "Empty"), "E42 the table is empty");
}

TEST(Convert, ADamagedWorkbookIsRefused) {
  const auto good = test::workbook_of(shaft_rows, shaft_texts);
  const auto with = [&good](const char* part, const std::string& text) {
    auto parts = good;
    parts[part] = text;
    return refused_workbook(parts);
  };
  EXPECT_EQ(refused_workbook({{"word/document.xml", "<w/>"}}),
            "E42 it is not a workbook of the kind .xlsx");
  EXPECT_EQ(with("xl/workbook.xml", "<workbook>"), "E42 its list of sheets is damaged");
  EXPECT_EQ(with("xl/sharedStrings.xml", "<sst><si></sst>"), "E42 its texts are damaged");
  for (const char* rows : {"<row r=\"1\"><c", "<row r=\"0\"><c r=\"A1\"><v>1</v></c></row>",
                           "<row r=\"1\"><c r=\"XFE1\"><v>1</v></c></row>",
                           "<row r=\"1\"><c r=\"A1\" t=\"s\"><v>7</v></c></row>"})
    EXPECT_EQ(refused_workbook(test::workbook_of(rows, shaft_texts)),
              "E42 its sheet 'Sheet1' is damaged")
        << rows;
  EXPECT_EQ(refused_workbook(test::workbook_of("", "")), "E42 it has no sheet with cells");
  // not a zipped file at all, and one that ends early
  const io::TempFolder folder;
  const auto file = folder.path() / "rotor.xlsx";
  test::write_workbook(file, good);
  for (const std::uintmax_t bytes :
       {std::uintmax_t{0}, std::uintmax_t{100}, fs::file_size(file) - 30}) {
    fs::resize_file(file, bytes);
    EXPECT_THROW(convert::convert_file(file), Error) << bytes;
    test::write_workbook(file, good);
  }
  EXPECT_EQ(convert::convert_file(file).is_table, false);
}

TEST(Convert, StationsOfASpreadsheet) {
  const Converted c = convert::convert_csv(
      "Station;Length (in);OD (in);ID (in);Weight (lb);Ip (lb.in^2);It (lb.in^2);Remark\n"
      "1;10;2;0;;;;drive end\n2;20;3;1;50;400;250;disk\n3;0;;;5;10;6;coupling\n",
      "rotor.csv");
  const deck::Deck read = deck::read_deck_text(c.text);
  ASSERT_TRUE(read.ok()) << read.report() << c.text;
  const model::Shaft& shaft = read.model.shafts.at(0);
  EXPECT_NEAR(shaft.length(), 30 * 0.0254, 1e-12);
  ASSERT_EQ(read.model.disks.size(), 2u);
  EXPECT_NEAR(read.model.disks[0].at.s, 0.254, 1e-12);
  EXPECT_NEAR(read.model.disks[1].at.s, 0.762, 1e-12);
  EXPECT_TRUE(says(c, "no bearings"));
  EXPECT_TRUE(says(c, "of steel"));
}

TEST(Convert, CoefficientsOfASpreadsheet) {
  const Converted c = convert::convert_csv(
      "RPM,Kxx [lb/in],Kxy [lb/in],Cyy [lb-s/in],Power [hp]\n"
      "2000,100,20,3,1\n1000,50,10,2,0.5\n",
      "pads.csv");
  EXPECT_TRUE(c.is_table);
  EXPECT_TRUE(says(c, "'Power [hp]' is left out"));
  std::istringstream lines(c.text);
  std::string title, first;
  std::getline(lines, title);
  std::getline(lines, first);
  EXPECT_EQ(title, "speed[rpm],kyy[N/m],kyz[N/m],czz[N.s/m]");
  // 1 lbf/in = 175.126835246477 N/m
  EXPECT_EQ(first.substr(0, 18), "1000,8756.34176232");
}

TEST(Convert, CoefficientsKeepTheirFrequencies) {
  const Converted c = convert::convert_csv(
      "speed[rpm],frequency[Hz],Kxx[N/m]\n3000,50,4\n1000,100,2\n3000,100,5\n1000,50,1\n", "h.csv");
  EXPECT_EQ(c.text,
            "speed[rpm],frequency[Hz],kyy[N/m]\n1000,50,1\n1000,100,2\n3000,50,4\n3000,100,5\n");
}

TEST(Convert, FrequenciesWithoutSpeedsAreSaidToBeSynchronous) {
  const Converted c = convert::convert_csv("frequency[Hz],Kxx[N/m]\n50,4\n", "h.csv");
  EXPECT_EQ(c.text, "speed[rpm],kyy[N/m]\n3000,4\n");
  EXPECT_TRUE(says(c, "every frequency is taken for that of the rotation"));
  EXPECT_FALSE(says(convert::convert_csv("speed[rpm],Kxx[N/m]\n50,4\n", "h.csv"), "frequency"));
}

TEST(Convert, TablesOfThisProgramAreNamed) {
  try {
    convert::convert_csv("speed[rpm],kyy[N/m],kyz[N/m],kzy[N/m],kzz[N/m]\n1000,1,2,3,4\n", "e.csv");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(e.diagnostics().front().message.find("'kyz[N/m]' is a title of this program's own"),
              std::string::npos)
        << e.diagnostics().front().message;
    EXPECT_NE(e.diagnostics().front().hint.find("file = \"e.csv\""), std::string::npos);
  }
}

TEST(Convert, ColumnsWithoutUnitsAreRefused) {
  try {
    convert::convert_csv("Length,OD [mm]\n1,2\n", "x.csv");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().message, "the column 'Length' has no unit");
  }
}

TEST(Convert, ColumnsOfMassAreNotDroppedForASpelling) {
  try {
    convert::convert_csv("Length [mm],OD [mm],Mass [stone]\n1,2,3\n", "x.csv");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().message, "the unit of column 'Mass [stone]' is none of kg");
  }
}

// A rotor of another material than its table says is another rotor.
TEST(Convert, MaterialsOfATableAreItsOwn) {
  const auto material = [](const char* text) {
    const deck::Deck read = deck::read_deck_text(convert::convert_csv(text, "x.csv").text);
    EXPECT_TRUE(read.ok()) << read.report();
    return read.model.materials.at(read.model.shafts.at(0).sections.at(0).material);
  };
  EXPECT_NEAR(material("Length [mm],OD [mm],Material\n500,50,Aluminium\n").E, 68.3e9, 1e3);
  EXPECT_NEAR(material("Length [mm],OD [mm],Material\n500,50,stainless steel\n").rho, 7900, 1e-9);
  EXPECT_NEAR(
      material("Length [mm],OD [mm],Material,E [GPa],Density [kg/m3]\n500,50,A,70,2700\n").E, 70e9,
      1e3);
  for (const char* unknown : {"Length [mm],OD [mm],E [GPa]\n500,50,70\n",
                              "Length [mm],OD [mm],Density [kg/m3]\n500,50,1\n",
                              "Length [mm],OD [mm],Material\n500,50,wood\n",
                              "Length [mm],OD [mm],E [GPa],Density [kg/m3]\n500,50,,2700\n"})
    EXPECT_THROW(convert::convert_csv(unknown, "x.csv"), Error) << unknown;
}

TEST(Convert, ABoreWithoutStiffnessIsTaken) {
  const Converted c = convert::convert_csv(
      "Length [mm],OD [mm],ID [mm],Stiffness ID [mm]\n500,50,10,20\n", "x.csv");
  EXPECT_NE(c.text.find("500.0, 50.0, 10.0, 50.0, 10.0, 50.0, 20.0"), std::string::npos) << c.text;
}
