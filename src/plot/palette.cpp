#include <plot/palette.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {
namespace {

struct Lab {
  double L, a, b;
};

// Oklab to sRGB, B. Ottosson 2020.
Rgb to_rgb(const Lab& c) {
  const double l = std::pow(c.L + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.L - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.L - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  const auto gamma = [](double x) {
    x = std::clamp(x, 0.0, 1.0);
    const double v = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
    return static_cast<unsigned char>(std::lround(255 * v));
  };
  return {gamma(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          gamma(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          gamma(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

const std::array<Rgb, 256>& color_map() {
  static const auto map = [] {
    // (a, b) at equal steps of lightness from 0.18 to 0.95: indigo, blue, teal, green, yellow.
    constexpr std::array<std::array<double, 2>, 6> ab = {{{0.03, -0.09},
                                                          {0.00, -0.12},
                                                          {-0.06, -0.06},
                                                          {-0.11, 0.03},
                                                          {-0.09, 0.13},
                                                          {-0.03, 0.15}}};
    std::array<Rgb, 256> m{};
    for (std::size_t k = 0; k < 256; ++k) {
      const double t = static_cast<double>(k) / 255, x = t * (ab.size() - 1);
      const auto i = std::min(static_cast<std::size_t>(x), ab.size() - 2);
      const double f = x - static_cast<double>(i);
      m[k] = to_rgb({0.18 + 0.77 * t, ab[i][0] + f * (ab[i + 1][0] - ab[i][0]),
                     ab[i][1] + f * (ab[i + 1][1] - ab[i][1])});
    }
    return m;
  }();
  return map;
}

}  // namespace whirl::plot
