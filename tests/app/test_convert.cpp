// Models of other programs: converted by the program, then run.
#include "deck_run.hpp"

#include <convert/convert.hpp>
#include <deck/deck.hpp>
#include <fmt/format.h>
#include <numbers>

using namespace whirl;
using convert::Converted;
using test::Columns;
using test::DeckRun;

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
}

// Whether it is there or not: the way to its text is told.
TEST(Convert, AWorkbookIsToBeSavedAsText) {
  for (const char* name : {"rotor.xlsx", "ROTOR.XLS", "rotor.ods"}) {
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
