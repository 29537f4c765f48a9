// Units: the values are the definitions of the units, so they are compared exactly unless a product
// of roundings is named.
#include <core/types.hpp>
#include <core/units.hpp>
#include <core/units_table.hpp>
#include <gtest/gtest.h>
#include <cmath>
#include <map>
#include <random>

using namespace whirl;

namespace {
struct Good {
  const char* text;
  const char* wanted;
  double value;
};
struct Bad {
  const char* text;
  const char* wanted;
  const char* code;
  const char* message;
  const char* hint;
};
}  // namespace

TEST(Units, Values) {
  const Good table[] = {
      {"75 um", "m", 75e-6},
      {"75um", "m", 75e-6},
      {"75 \xC2\xB5m", "m", 75e-6},
      {"75 \xCE\xBCm", "mm", 75e-6},
      {"80 mm", "m", 0.08},
      {"1.14 m", "mm", 1.14},
      {"9000 rpm", "rad/s", 9000 * two_pi / 60},
      {"9 krpm", "rpm", 9000 * two_pi / 60},
      {"50 rad/s", "rpm", 50},
      {"50 Hz", "rad/s", 50 * two_pi},
      {"50 Hz", "Hz", 50},
      {"3000 rpm", "Hz", 50},
      {"3000 cpm", "rad/s", 3000 * two_pi / 60},
      {"50 Hz/s", "rad/s^2", 50 * two_pi},
      {"50 Hz", "1/s", 50},
      {"0.5 1/s", "1/s", 0.5},
      {"0.5 /s", "1/s", 0.5},
      {"0.5 s^-1", "1/s", 0.5},
      {"10 rev/s", "rad/s", 10 * two_pi},
      {"2e-5 s", "s", 2e-5},
      {"12 g.mm", "kg.m", 12e-6},
      {"12 g*mm", "kg.m", 12e-6},
      {"12 g\xC2\xB7mm", "kg.m", 12e-6},
      {"12 g mm", "kg.m", 12e-6},
      {"8e4 N/m", "N/m", 8e4},
      {"2.5e8 N/m", "N/mm", 2.5e8},
      {"180 N/mm", "N/m", 180e3},
      {"180 N.m", "N.m", 180},
      {"500 N.m", "N.m/rad", 500},
      {"1.2e5 N.m/rad", "N.m/rad", 1.2e5},
      {"1 N.m/deg", "N.m/rad", 180 / pi},
      {"2e-5 N.m.s^2", "N.m.s^2/rad^2", 2e-5},
      {"0.019 Pa.s", "Pa.s", 0.019},
      {"19 cP", "Pa.s", 0.019},
      {"2 kg.m^2", "kg.m^2", 2},
      {"2 kg.m2", "kg.m^2", 2},
      {"2 kg m\xC2\xB2", "kg.m^2", 2},
      {"30 deg", "rad", pi / 6},
      {"30\xC2\xB0", "rad", pi / 6},
      {"2.5 mm/s", "m/s", 2.5e-3},
      {"5 %", "", 0.05},
      {"0.25", "", 0.25},
      {"-5 mm", "m", -5e-3},
      {"+5 mm", "m", 5e-3},
      {"\xE2\x88\x92"
       "5 mm",
       "m", -5e-3},
      {"40 degC", "degC", 313.15},
      {"-40 degF", "degC", 233.15},
      {"7850 kg/m^3", "kg/m^3", 7850},
      {"7.85 g/cm^3", "kg/m^3", 7850},
      {"210 GPa", "Pa", 210e9},
      {"1 in", "m", 0.0254},
      {"2 ft", "m", 0.6096},
      {"3 mil", "m", 76.2e-6},
      {"1 lbm", "kg", 0.45359237},
      {"1 lbf", "N", 4.4482216152605},
      {"16 oz.in", "kg.m", 0.45359237 * 0.0254},
      {"16 ozf.in", "N.m", 4.4482216152605 * 0.0254},
      {"46 cSt", "m^2/s", 46e-6},
      {"3 St", "m^2/s", 3e-4},
      {"1 psi", "Pa", 6894.757293168361},
      {"30e6 psi", "Pa", 30e6 * 6894.757293168361},
      {"1 reyn", "Pa.s", 6894.757293168361},
      {"1 slug", "kg", 14.593902937206364},
      {"1 hp", "W", 745.6998715822702},
      {"1 hp", "N.m/s", 745.6998715822702},
      {"1 gn", "m/s^2", 9.80665},
      {"2*35 mm + 1 in", "m", 0.0954},
      {"2 * (75 um)", "m", 150e-6},
      {"(75 um)/2", "m", 37.5e-6},
      {"(75 um)/(3 mm)", "", 0.025},
      {"10 mm - 2 mm", "m", 8e-3},
      {"8e9 N/m^1.5", "N/m^1.5", 8e9},
      {"1e10 N/m^(10/9)", "N/m^(10/9)", 1e10},
      {"9.80665 m/s/s", "m/s^2", 9.80665},
      {"9.80665 m s^-2", "m/s^2", 9.80665},
      {".5 mm", "m", 0.5e-3},
      {"1.2E5 N.m", "N.m", 1.2e5},
  };
  for (const auto& g : table) {
    const auto c = units::convert(g.text, g.wanted);
    ASSERT_FALSE(c.problem) << g.text << ": " << c.problem->message;
    // four roundings at most: the number, two scales, the quotient
    EXPECT_NEAR(c.value, g.value, 4 * 1.2e-16 * std::abs(g.value)) << g.text;
  }
}

// Every unit of the table by what it is defined as; one that is added needs its line here.
TEST(Units, EveryUnitOfTheTableIsWhatItIsDefinedAs) {
  struct Definition {
    const char* si;
    double value;  ///< of "1 <unit>"
  };
  const double inch = 0.0254, foot = 12 * inch, pound = 0.45359237, gravity = 9.80665;
  const double pound_force = pound * gravity;
  const std::map<std::string, Definition> definitions = {
      {"m", {"m", 1}},
      {"in", {"m", inch}},
      {"inch", {"m", inch}},
      {"ft", {"m", foot}},
      {"mil", {"m", inch / 1000}},
      {"thou", {"m", inch / 1000}},
      {"L", {"m^3", 0.1 * 0.1 * 0.1}},
      {"kg", {"kg", 1}},
      {"g", {"kg", 1e-3}},
      {"t", {"kg", 1e3}},
      {"lbm", {"kg", pound}},
      {"oz", {"kg", pound / 16}},
      {"slug", {"kg", pound_force / foot}},
      {"s", {"s", 1}},
      {"min", {"s", 60}},
      {"h", {"s", 60 * 60}},
      {"day", {"s", 24 * 60 * 60}},
      {"rad", {"rad", 1}},
      {"deg", {"rad", two_pi / 360}},
      {"rev", {"rad", two_pi}},
      {"turn", {"rad", two_pi}},
      {"rpm", {"rad/s", two_pi / 60}},
      {"Hz", {"1/s", 1}},
      {"cpm", {"1/s", 1.0 / 60}},
      {"N", {"kg.m/s^2", 1}},
      {"kgf", {"N", gravity}},
      {"lbf", {"N", pound_force}},
      {"ozf", {"N", pound_force / 16}},
      {"Pa", {"N/m^2", 1}},
      {"bar", {"Pa", 1e5}},
      {"atm", {"Pa", 101325}},
      {"psi", {"Pa", pound_force / (inch * inch)}},
      {"ksi", {"Pa", 1000 * pound_force / (inch * inch)}},
      {"J", {"N.m", 1}},
      {"W", {"N.m/s", 1}},
      {"hp", {"W", 550 * foot * pound_force}},
      {"P", {"Pa.s", 0.1}},
      {"reyn", {"Pa.s", pound_force / (inch * inch)}},
      {"St", {"m^2/s", 0.01 * 0.01}},
      {"gn", {"m/s^2", gravity}},
      {"K", {"K", 1}},
      {"degC", {"degC", 1 + 273.15}},
      {"degF", {"degC", (1 - 32) / 1.8 + 273.15}},
      {"A", {"A", 1}},
      {"V", {"W/A", 1}},
      {"Ohm", {"V/A", 1}},
      {"%", {"", 0.01}},
      {"ppm", {"", 1e-6}},
  };
  const std::map<char, double> prefixes = {{'n', 1e-9}, {'u', 1e-6}, {'m', 1e-3}, {'c', 1e-2},
                                           {'d', 1e-1}, {'k', 1e3},  {'M', 1e6},  {'G', 1e9}};
  for (const units::Entry& unit : units::entries()) {
    const auto known = definitions.find(unit.name);
    ASSERT_NE(known, definitions.end()) << unit.name << ": what is it defined as?";
    const auto expect = [&](const std::string& name, double value) {
      const auto c = units::convert("1 " + name, known->second.si);
      ASSERT_FALSE(c.problem) << name << ": " << c.problem->message;
      // products and quotients of four factors at most
      EXPECT_NEAR(c.value, value, 8 * 1.2e-16 * value) << name;
    };
    expect(unit.name, known->second.value);
    for (const char prefix : std::string(unit.prefixes)) {
      ASSERT_TRUE(prefixes.contains(prefix)) << unit.name << ": " << prefix;
      expect(prefix + std::string(unit.name), prefixes.at(prefix) * known->second.value);
    }
  }
  EXPECT_EQ(definitions.size(), units::entries().size());
}

TEST(Units, DecimalLiteralsAreExact) {
  // "75 um" must be the same double as 75e-6: division by an exact power of ten is correctly
  // rounded.
  EXPECT_EQ(units::convert("75 um", "m").value, 75e-6);
  EXPECT_EQ(units::convert("0.1 mm", "m").value, 1e-4);
  EXPECT_EQ(units::convert("12 g.mm", "kg.m").value, 12e-6);
  EXPECT_EQ(units::convert("38.5 kg", "kg").value, 38.5);
  EXPECT_EQ(units::convert("7.3 kN/mm", "N/m").value, 7.3e6);
}

TEST(Units, ABalanceGradeIsAVelocity) {
  EXPECT_EQ(units::convert("G2.5", "mm/s").value, 2.5e-3);
  EXPECT_EQ(units::convert("G 6.3", "mm/s").value, 6.3e-3);
  EXPECT_EQ(units::convert("G2.5", "N").problem->code, "E09");
  EXPECT_TRUE(units::convert("G2.5.1", "mm/s").problem);
}

TEST(Units, ZeroNeedsNoUnitButForTemperatures) {
  for (const char* wanted : {"m", "N.m/rad", "rpm", "Hz", "kg.m^2", "deg", ""}) {
    const units::Converted c = units::convert("0", wanted);
    EXPECT_FALSE(c.problem) << wanted;
    EXPECT_EQ(c.value, 0.0) << wanted;
  }
  EXPECT_EQ(units::convert("0.0", "mm").value, 0.0);
  EXPECT_EQ(units::convert("0", "degC").problem->code, "E07");
  EXPECT_EQ(units::convert("0", "K").problem->code, "E07");
  EXPECT_EQ(units::convert("0 kg", "m").problem->code, "E08");
}

TEST(Units, Problems) {
  const Bad table[] = {
      {"75", "m", "E07", "\"75\" has no unit where a length is needed",
       "write the unit, for example \"75 m\""},
      {"0.5", "1/s", "E07", "\"0.5\" has no unit where a rate (1/s) is needed",
       "write the unit, for example \"0.5 1/s\""},
      {"0.5", "rad", "E07", "\"0.5\" has no unit where an angle is needed",
       "write the unit, for example \"0.5 rad\""},
      {"75 kg", "mm", "E08", "\"75 kg\" is a mass where a length is needed",
       "write it in mm or another unit of the same kind"},
      {"157 mm 5", "m", "E10", "\"157 mm 5\" cannot be read as a quantity: unexpected '5'",
       "a quantity is a number and a unit, such as \"75 um\" or \"8e4 N/m\""},
      {"3 g", "m/s^2", "E08", "\"3 g\" is a mass where an acceleration is needed",
       "g is a gram; gn is the acceleration of gravity, 9.80665 m/s^2"},
      {"157 1/s", "rpm", "E08", "\"157 1/s\" is a rate (1/s) where an angular speed is needed",
       "say what turns: write it in rad/s, Hz or rpm"},
      {"157 /s", "rpm", "E08", "\"157 /s\" is a rate (1/s) where an angular speed is needed",
       "say what turns: write it in rad/s, Hz or rpm"},
      {"5 deg", "", "E08", "\"5 deg\" is an angle where a plain number is needed",
       "this value has no unit: write a plain number"},
      {"5 N.m/rad", "N.m", "E08",
       "\"5 N.m/rad\" is a torsional stiffness where a torque, moment or energy is needed",
       "write it in N.m or another unit of the same kind"},
      {"5 rad/s", "1/s", "E08", "\"5 rad/s\" is an angular speed where a rate (1/s) is needed",
       "write it in 1/s or another unit of the same kind"},
      {"16 oz.in", "N.m", "E08",
       "\"16 oz.in\" is an unbalance (mass times length) where a torque, moment or energy is "
       "needed",
       "write it in N.m or another unit of the same kind"},
      {"5 Nm", "N.m", "E09", "unknown unit 'Nm' in \"5 Nm\"", "write a point between units: 'N.m'"},
      {"5 RPM", "rpm", "E09", "unknown unit 'RPM' in \"5 RPM\"", "did you mean 'rpm'?"},
      {"5 KN", "N", "E09", "unknown unit 'KN' in \"5 KN\"", "did you mean 'kN'?"},
      {"5 lb", "kg", "E09", "unknown unit 'lb' in \"5 lb\"",
       "say which: 'lbm' is the mass, 'lbf' the force"},
      {"5 furlong", "m", "E09", "unknown unit 'furlong' in \"5 furlong\"", ""},
      {"3,000 rpm", "rpm", "E12", "\"3,000 rpm\" has a comma inside a number",
       "write \"3000 rpm\" for thousands, \"3.000 rpm\" for a decimal point"},
      {"0,019 Pa.s", "Pa.s", "E12", "\"0,019 Pa.s\" has a comma inside a number",
       "write a decimal point (\"0.019 Pa.s\") and no thousands separator"},
      {"1 W/m.K", "W/(m.K)", "E10",
       "\"1 W/m.K\" can be read in two ways: a product follows the '/'",
       "write the whole denominator in parentheses, such as \"W/(m.K)\""},
      {"1/2 m", "m", "E10", "\"1/2 m\" can be read in two ways: a product follows the '/'",
       "write the whole denominator in parentheses, such as \"W/(m.K)\""},
      {"nan m", "m", "E13", "\"nan m\" is not a finite number",
       "leave the key out where no limit is meant"},
      {"-inf", "m", "E13", "\"-inf\" is not a finite number",
       "leave the key out where no limit is meant"},
      {"1e999 m", "m", "E13", "\"1e999 m\" has a number beyond the range of double precision", ""},
      {"1e300 GN", "N", "E13", "\"1e300 GN\" is not a finite number",
       "the value overflows double precision"},
      {"1/0", "", "E13", "\"1/0\" is not a finite number", "the value overflows double precision"},
      {"", "m", "E10", "the text is empty where a quantity is expected", ""},
      {"5 mm +", "m", "E10", "\"5 mm +\" ends where a number or a unit is expected", ""},
      {"(5 mm", "m", "E10", "\"(5 mm\" has a parenthesis that is not closed", ""},
      {"5 mm + 2 s", "m", "E08", "\"5 mm + 2 s\" adds a length and a time", ""},
      {"5 mm $", "m", "E10", "\"5 mm $\" cannot be read as a quantity: unexpected '$'",
       "a quantity is a number and a unit, such as \"75 um\" or \"8e4 N/m\""},
      {"40 degC/m", "K/m", "E10",
       "\"40 degC/m\" calculates with degC or degF, whose zero is not the zero of temperature",
       "write \"40 degC\" alone, or calculate in K"},
      {"10 degC", "K", "E10",
       "\"10 degC\" is a temperature where a difference of temperatures is needed",
       "write it in K, which is as large as a degree Celsius"},
      {"18 degF", "K", "E10",
       "\"18 degF\" is a temperature where a difference of temperatures is needed",
       "write it in K: a degree Fahrenheit is 5/9 K"},
      {"5 m^1000", "m", "E10", "\"5 m^1000\" has an exponent beyond 100", ""},
  };
  for (const auto& b : table) {
    const auto c = units::convert(b.text, b.wanted);
    ASSERT_TRUE(c.problem) << b.text;
    EXPECT_EQ(c.problem->code, b.code) << b.text;
    EXPECT_EQ(c.problem->message, b.message) << b.text;
    EXPECT_EQ(c.problem->hint, b.hint) << b.text;
  }
}

TEST(Units, DeepParenthesesAreRefused) {
  const auto c = units::convert(std::string(500, '(') + "1 m" + std::string(400, ')'), "m");
  ASSERT_TRUE(c.problem);
  EXPECT_EQ(c.problem->code, "E10");
}

TEST(Units, ProblemsPointAtTheirPlace) {
  const auto c = units::convert("5 N/furlong", "N/m");
  ASSERT_TRUE(c.problem);
  EXPECT_EQ(c.problem->offset, 4u);
  EXPECT_EQ(c.problem->length, 7u);
}

TEST(Units, Factors) {
  EXPECT_EQ(units::factor("mm", "m")(80), 0.08);
  EXPECT_EQ(units::factor("N/m", "N/m")(8e4), 8e4);
  EXPECT_NEAR(units::factor("rpm", "rad/s")(60), two_pi, 1e-15);  // one rounding of 2 pi 60/60
  EXPECT_EQ(units::factor("-", "")(3), 3);
  EXPECT_EQ(units::factor("%", "")(3), 0.03);
  EXPECT_EQ(units::factor("1/s", "1/s")(3), 3);
  EXPECT_EQ(units::factor("", "m").problem->code, "E07");
  EXPECT_EQ(units::factor("kg", "m").problem->code, "E08");
  const auto f = units::factor("furl", "m");
  EXPECT_EQ(f.problem->code, "E09");
  EXPECT_EQ(f.problem->message, "unknown unit 'furl'");
  EXPECT_EQ(f.problem->offset, 0u);
}

TEST(Units, FormatReadsBackExactly) {
  EXPECT_EQ(units::format(75e-6, "um"), "75 um");
  EXPECT_EQ(units::format(9000 * two_pi / 60, "rpm"), "9000 rpm");
  EXPECT_EQ(units::format(0.25, ""), "0.25");
  EXPECT_EQ(units::format(0.5, "1/s"), "0.5 1/s");
  EXPECT_EQ(units::format(0, "N/m"), "0 N/m");
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(-10, 10);
  std::uniform_int_distribution<int> exponent(-18, 18);
  for (const char* unit :
       {"mm", "rpm", "deg", "N.m/rad", "g.mm", "psi", "GPa", "kg.m^2", "1/s", "%", ""}) {
    for (int k = 0; k < 2000; ++k) {
      const double v = mantissa(random) * std::pow(10.0, exponent(random));
      const std::string s = units::format(v, unit);
      const auto c = units::convert(s, unit);
      ASSERT_FALSE(c.problem) << s;
      ASSERT_EQ(c.value, v) << s;
    }
  }
}

TEST(Units, EveryUnitReadsAndHasAName) {
  for (const auto& u : units::unit_table()) {
    const auto p = units::parse("1 " + u.name);
    EXPECT_FALSE(p.problem) << u.name;
    EXPECT_FALSE(u.meaning.empty());
  }
}

TEST(Units, BaseUnitsInTheirUsualOrder) {
  EXPECT_EQ(units::base_units({{1, 1, 1, 1, 1, 1}, 0}), "kg.m.rad.s.K.A");
  EXPECT_EQ(units::base_units({{2, 1, -2, 0, 0, -1}, 0}), "kg.m^2.rad^-1.s^-2");  // N m/rad
  EXPECT_EQ(units::base_units({{0, 0, 0, -1, 0.5, 0}, 0}), "K^-1.A^0.5");
  EXPECT_EQ(units::base_units({}), "");
}
