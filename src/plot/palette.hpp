// Colours. The eight line colours stay apart for readers with any of the common colour deficiencies
// and in grey print (after Okabe and Ito 2008, the yellow left out because it vanishes on paper);
// line styles and markers never rely on them alone.
#pragma once
#include <array>
#include <string>

namespace whirl::plot {

inline constexpr int palette_size = 8;
inline constexpr std::array<const char*, palette_size> palette_light = {
    "#0072b2", "#d55e00", "#009e73", "#aa4499", "#e69f00", "#56b4e9", "#882255", "#666666"};
inline constexpr std::array<const char*, palette_size> palette_dark = {
    "#5aa9e6", "#ff8f52", "#35c79b", "#e08fd4", "#f5c04e", "#9bd3f7", "#e0729f", "#a9a9a9"};
inline constexpr const char* ink_light = "#222222";
inline constexpr const char* grid_light = "#d9d9d9";
inline constexpr const char* paper_light = "#ffffff";

struct Rgb {
  unsigned char r, g, b;
};
/// Map of 256 colours for maps, dark blue over green to light yellow: lightness grows in equal
/// steps (Oklab), so it reads in grey as well.
const std::array<Rgb, 256>& color_map();

}  // namespace whirl::plot
