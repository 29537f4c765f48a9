// Stretches of film condensed to their ends (pad_film.hpp), several of their elements at a time: one
// compiler vector holds the same quantity of four elements (two on a baseline machine). Compiled once
// per instruction set and chosen at run time, as the shaft's kernels are
// (elements/shaft/shaft_lanes.hpp). The formulas are those of one element, in film_condense.inl. Only
// plain data crosses this interface.
#pragma once

namespace whirl::elements::film_lanes {

inline constexpr int order = 4;            ///< of the elements
inline constexpr int bubbles = order - 1;  ///< shapes that vanish at both ends
inline constexpr int shapes = order + 1;   ///< bubbles, then the left and the right vertex
/// Gauss points: one more than the order asks for halves the elements that a given error takes.
inline constexpr int points = order + 1;
inline constexpr int entries = shapes * (shapes + 1) / 2;

/// Products of two shapes (upper triangle by rows), of their slopes; shapes; all times the weight of
/// the point.
struct Tables {
  double mass[points][entries], stiffness[points][entries], source[points][shapes];
};

/// A stretch of film in Sommerfeld's angle. Every number is a value and N slopes of it.
template <int N>
struct Stretch {
  double e[2][1 + N], b[2][1 + N];           ///< of the journal, and of the map
  double spread[1 + N], over_spread[1 + N];  ///< 1 - |b|^2 and its inverse
  double width[1 + N], over_width[1 + N];    ///< of an element, rad
  double turn[2][1 + N];                     ///< (cos, sin) of the width
  double first[points][2][1 + N];            ///< (cos, sin) of the points of the first element
  double beta;                               ///< leakage at the sides
  int count;                                 ///< elements
};
/// The stretch as Condensed has it.
template <int N>
struct Ends {
  double S00[1 + N], S01[1 + N], S11[1 + N];
  double out_a[2][1 + N], out_b[2][1 + N];
  double D_aa[1 + N], D_ab[1 + N], D_bb[1 + N];
};

struct Kernels {
  const char* isa;
  void (*condense)(const Tables&, const Stretch<0>&, Ends<0>&);
  void (*condense_with_slopes)(const Tables&, const Stretch<4>&, Ends<4>&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::elements::film_lanes
