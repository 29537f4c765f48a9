// Units: dimension-checked reading of "75 um", "8e4 N/m", "12 g.mm", "2 * 35 mm + 1 in", and
// writing values back.
//
// Grammar: sums of products; '*' or '.' between units, '/' for quotients, '^' for powers,
// parentheses where wanted; a number before a unit multiplies it. After a '/' a further product
// needs parentheses ("W/(m.K)"): the short form is read differently by different people, so it is
// an error here.
// The radian is dimensionless in SI but tracked: "deg", "rpm", "rev" and "rad" are angles, a plain
// number is not. Hz means 2 pi rad/s where an angular speed is wanted and 1/s where a frequency is
// wanted.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::units {

/// Exponents of the base units m, kg, s, K, A, rad; `cycles` counts factors Hz inside (each already
/// contributes 1/s).
struct Dimension {
  enum Base { length, mass, time, temperature, current, angle };
  std::array<double, 6> exponent{};
  double cycles = 0;
  bool dimensionless() const;  ///< a plain number: all exponents zero, the angle's too
  /// Zero is the same in all its units: no temperature.
  bool plain_zero() const;
  bool operator==(const Dimension&) const = default;
};

/// A number times a unit. The unit's scale is kept as a ratio so that "75 um" is the double nearest
/// to 75e-6.
struct Quantity {
  double number = 0;        ///< what stands before the unit
  double num = 1, den = 1;  ///< scale to base units
  double offset = 0;        ///< of "degC" and "degF" used alone, K
  Dimension dimension;
  bool has_unit = false;  ///< a unit was written ("%" counts, a bare number does not)
  double value() const { return number * num / den + offset; }
};

/// What is wrong with a text and where in it (offset and length in bytes). Codes are those of
/// core/error_catalogue.
struct Problem {
  std::string code, message, hint;
  std::size_t offset = 0, length = 0;
};

/// Either a quantity or a problem.
struct Parsed {
  Quantity quantity;
  std::optional<Problem> problem;
};
Parsed parse(std::string_view text);

/// A unit expression known to be right ("N.s/m"; "" or "1" = plain number). Throws std::logic_error
/// when it is not.
Quantity unit(std::string_view text);

/// Value of `text` in the SI base units of `wanted` (not in `wanted` itself). A plain number is a
/// problem unless `wanted` is one or it is zero and no temperature. In "mm/s", "G2.5" is a balance
/// grade of ISO 21940-11.
struct Converted {
  double value = 0;
  std::optional<Problem> problem;
};
Converted convert(std::string_view text, std::string_view wanted);

/// Factor from values written in the column unit `given` to the SI base units of `wanted` (value =
/// x * num / den + offset).
struct Factor {
  double num = 1, den = 1, offset = 0;
  std::optional<Problem> problem;
  double operator()(double x) const { return x * num / den + offset; }
};
Factor factor(std::string_view given, std::string_view wanted);

/// Shortest text that reads back as exactly `value` (base units), in `unit` when that is possible,
/// else in base units.
std::string format(double value, std::string_view unit);
/// For messages: six significant digits.
std::string display(double value, std::string_view unit);
/// Shortest text of a plain double that reads back exactly.
std::string format_number(double value);

/// "a length", "a torsional stiffness", or the base units when there is no name.
std::string name_of(const Dimension& dimension);
/// "kg.m^2.s^-2"
std::string base_units(const Dimension& dimension);
/// The unit nearest in spelling (edit distance below `limit`, a change of case counting 0.2), or
/// empty.
std::string nearest_unit(std::string_view text, double limit = 3);
/// All unit names with their meaning, for the reference documentation.
struct UnitInfo {
  std::string name, meaning;
  bool prefixes;
};
std::vector<UnitInfo> unit_table();

}  // namespace whirl::units
