// Numbers and text as they go into SVG and HTML.
#pragma once
#include <string>
#include <string_view>

namespace whirl {

/// &, <, >, " escaped; control characters and broken UTF-8 replaced, so the result is well-formed
/// XML text.
std::string escape(std::string_view text);
/// Appends x with at most `decimals` digits after the point, no trailing zeros ("12.5", "-3").
void append_number(std::string& out, double x, int decimals = 2);
std::string number_text(double x, int decimals = 2);
/// x with `digits` significant digits, plain or like 1.2×10⁻⁷, whichever an engineer would write.
std::string readable(double x, int digits = 4);
/// "×10⁻⁶" without the sign of multiplication: "10⁻⁶".
std::string power_of_ten(int exponent);
/// Width of a line of text in px at a font size, for a Helvetica-like face; an estimate, good to
/// some per cent.
double text_width(std::string_view utf8, double font_size);
/// Letters of any script, digits, '.', '-' and '_' of a name in UTF-8, the rest as '_': good for files,
/// anchors and ids.
/// Never empty, never starts with '.'.
std::string safe_name(std::string_view name);
/// The same without '.', for what an extension follows.
std::string safe_stem(std::string_view name);
/// "a disk", "an unbalance"
std::string with_article(std::string_view noun);
std::string base64(std::string_view bytes);

}  // namespace whirl
