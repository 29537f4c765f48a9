// Formulas of a film's elements, for one number (pad_film_parts.hpp) and for several in a compiler
// vector (film_lanes.inl). Included within a namespace, after film_lanes.hpp.
using film_lanes::bubbles;
using film_lanes::entries;
using film_lanes::points;
using film_lanes::shapes;

template <class T>
struct Pair {
  T x, y;
};

/// What the film needs at an angle gamma given by (cos, sin).
template <class T>
struct AtPoint {
  Pair<T> n;
  T h, stretch;  ///< clearance, dtheta/dgamma
  T flow;        ///< h^3 dgamma/dtheta
  template <class Place>
  AtPoint(const Place& at, const Pair<T>& zeta) {
    const Pair<T> sum{zeta.x + at.b.x, zeta.y + at.b.y};
    const T re = 1.0 + at.b.x * zeta.x + at.b.y * zeta.y,
            im = at.b.x * zeta.y - at.b.y * zeta.x;  // 1 + conj(b) zeta
    const T square = re * re + im * im, inverse = 1.0 / square;
    n = {(sum.x * re + sum.y * im) * inverse, (sum.y * re - sum.x * im) * inverse};
    h = 1.0 - (at.e.x * n.x + at.e.y * n.y);
    stretch = at.spread * inverse;
    flow = h * h * h * square * at.over_spread;
  }
};

/// Oil that is alike everywhere.
struct Alike {
  static constexpr bool plain = true;
  static constexpr double edge = 0.0;
};

/// A stretch of film condensed to its two ends, for the unit sources n_x and n_y.
template <class T>
struct Condensed {
  T S00, S01, S11;       ///< loads int P_i n_j dtheta with P = 0 at both ends
  Pair<T> out_a, out_b;  ///< flow out at the ends
  T D_aa, D_ab, D_bb;    ///< stiffness: flow in at an end for a pressure there
};

template <class T>
void add_load(Condensed<T>& c, const T& x, const T& y, const T& inverse) {
  const T ix = inverse * x;
  c.S00 += ix * x;
  c.S01 += ix * y;
  c.S11 += inverse * y * y;
}

/// One element: stiffness (upper triangle by rows) and loads of its shapes, the bubbles first, then
/// the shapes of its two ends.
template <class T>
struct FilmElement {
  T A[entries] = {};
  Pair<T> B[shapes] = {};
};

/// Integrates an element of the length `along`, rad, over its points zeta, which are turned on to those
/// of the next one.
template <class T, class Place, class Medium>
FilmElement<T> integrate_element(const film_lanes::Tables& ref, const Place& at,
                                 const Medium& medium, const T& along, const T& over_along,
                                 const Pair<T>& turn, double beta, Pair<T>* zeta) {
  FilmElement<T> e;
  for (int q = 0; q < points; ++q) {
    const AtPoint<T> x(at, zeta[q]);
    const T arc = along * x.stretch;
    T flow = over_along * x.flow, leak = beta * (x.h * x.h * x.h) * arc;
    if constexpr (!Medium::plain) {
      const auto f = medium.at(x);
      flow = flow * f.along;
      leak = leak * f.across;
    }
    const T sx = arc * x.n.x, sy = arc * x.n.y;
    for (int m = 0; m < entries; ++m)
      e.A[m] += ref.stiffness[q][m] * flow + ref.mass[q][m] * leak;
    for (int i = 0; i < shapes; ++i) {
      e.B[i].x += ref.source[q][i] * sx;
      e.B[i].y += ref.source[q][i] * sy;
    }
    const Pair<T> z = zeta[q];
    zeta[q] = {z.x * turn.x - z.y * turn.y, z.x * turn.y + z.y * turn.x};
  }
  return e;
}

/// Eliminates the bubbles of an element.
template <class T>
void drop_bubbles(FilmElement<T>& e, Condensed<T>& c) {
  for (int i = 0, row = 0; i < bubbles; row += shapes - i, ++i) {
    const T inverse = 1.0 / e.A[row];
    add_load(c, e.B[i].x, e.B[i].y, inverse);
    int below = row + shapes - i;
    for (int j = 1; j < shapes - i; ++j) {
      const T factor = e.A[row + j] * inverse;
      for (int m = j; m < shapes - i; ++m)
        e.A[below++] -= factor * e.A[row + m];
      e.B[i + j].x -= factor * e.B[i].x;
      e.B[i + j].y -= factor * e.B[i].y;
    }
  }
}

/// Joins an element to what is condensed so far, and eliminates the vertex between them.
template <class T>
void append_element(const FilmElement<T>& e, bool first, Condensed<T>& c) {
  const T &ll = e.A[entries - 3], &lr = e.A[entries - 2], &rr = e.A[entries - 1];
  const Pair<T>&left = e.B[bubbles], &right = e.B[bubbles + 1];
  if (first) {
    c.D_aa = ll;
    c.D_ab = lr;
    c.D_bb = rr;
    c.out_a = left;
    c.out_b = right;
    return;
  }
  const T inverse = 1.0 / (c.D_bb + ll), x = c.out_b.x + left.x, y = c.out_b.y + left.y;
  add_load(c, x, y, inverse);
  const T back = c.D_ab * inverse, ahead = lr * inverse;
  c.out_a.x -= back * x;
  c.out_a.y -= back * y;
  c.out_b = {right.x - ahead * x, right.y - ahead * y};
  c.D_aa -= back * c.D_ab;
  c.D_bb = rr - ahead * lr;
  c.D_ab = -(back * lr);
}
