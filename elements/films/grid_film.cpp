#include <elements/films/grid_film.hpp>
#include <elements/films/grid_solver.hpp>
#include <elements/films/pad_film.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <elements/films/turbulence.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::elements {

namespace {

[[noreturn]] void recess_fault(const char* what) {
  throw run_error("E84", std::string("journal bearing: ") + what);
}

/// How many cells each stretch between stops has: by its share of `cells`, at least `fewest`, in all no
/// more than `most`.
std::vector<int> shared_out(const std::vector<double>& stops, int cells, int fewest, int most) {
  const double length = stops.back() - stops.front();
  std::vector<int> numbers;
  int sum = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k) {
    const double share = (stops[k + 1] - stops[k]) / length;
    numbers.push_back(std::max(fewest, static_cast<int>(std::lround(cells * share))));
    sum += numbers.back();
  }
  for (; sum > most; --sum)
    --*std::max_element(numbers.begin(), numbers.end());
  if (*std::min_element(numbers.begin(), numbers.end()) < 1)
    recess_fault("too many recesses on one pad for its grid");
  return numbers;
}

/// Edges of cells along the arc.
std::vector<double> columns_between(const std::vector<double>& stops, int cells) {
  const std::vector<int> numbers = shared_out(stops, cells, 2, GridPad::most_columns);
  std::vector<double> out{stops.front()};
  for (std::size_t k = 0; k + 1 < stops.size(); ++k)
    for (int i = 1; i <= numbers[k]; ++i)
      out.push_back(stops[k] + (stops[k + 1] - stops[k]) * i / numbers[k]);
  return out;
}

/// Elements along the axis from the middle to the side: two at least beside a recess, where films may
/// end within a short way.
std::vector<double> elements_between(const std::vector<double>& stops, int elements) {
  const int fewest = stops.size() == 2 ? 1 : std::max(2, (2 * elements + 1) / 3);
  const std::vector<int> numbers = shared_out(stops, elements, fewest, GridPad::most_rows / 2);
  std::vector<double> out{stops.front()};
  for (std::size_t k = 0; k + 1 < stops.size(); ++k)
    for (int i = 1; i <= numbers[k]; ++i)
      out.push_back(stops[k] + (stops[k + 1] - stops[k]) * i / numbers[k]);
  return out;
}

void check_recesses(const std::vector<Recess>& recesses, double arc) {
  for (const Recess& r : recesses) {
    if (!(r.from >= 0 && r.to > r.from && r.to <= arc + 1e-9))
      recess_fault("a recess lies beyond its pad, or is empty");
    if (!(r.depth_from >= 0 && r.depth_to >= 0)) recess_fault("the depth of a recess is negative");
    if (!(r.width > 0 && r.width <= 1))
      recess_fault("the width of a recess must be positive and at most the length");
    for (const Recess& other : recesses)
      if (&other != &r && other.from < r.to - 1e-9 && r.from < other.to - 1e-9)
        recess_fault("recesses of a pad overlap");
  }
}

}  // namespace

std::vector<double> distinct_places(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const auto same = [](double a, double b) { return b - a < 1e-9; };
  x.erase(std::unique(x.begin(), x.end(), same), x.end());
  return x;
}

GridPad::GridPad(double start, double arc, bool round, double ratio, int columns, int rows,
                 const std::vector<Recess>& recesses)
    : start_(start),
      arc_(arc),
      ratio_(ratio),
      recesses_(recesses),
      round_(round) {
  WHIRL_EXPECTS(arc > 0.0 && arc <= two_pi * (1 + 1e-12) && ratio > 0.0);
  WHIRL_EXPECTS(columns >= 8 && columns <= most_columns && rows >= 2 && rows <= most_even_rows);
  check_recesses(recesses, arc);
  std::vector<double> along{0.0, arc}, across{0.0, 1.0};
  for (const Recess& r : recesses) {
    along.push_back(r.from);
    along.push_back(std::min(r.to, arc));
    across.push_back(r.width);
  }
  const std::vector<double> edges = columns_between(distinct_places(along), columns);
  const std::vector<double> widths = distinct_places(across),
                            elements = elements_between(widths, (rows + 1) / 2);
  bands_ = widths.size() - 1;
  if (bands_ > most_bands || (round && bands_ > 1))
    recess_fault("too many recesses on one pad for its grid");
  // of a cell's halves, in units of a half
  const double first = 0.5 - 0.5 / std::sqrt(3.0), second = 0.5 + 0.5 / std::sqrt(3.0);
  const double gauss[4] = {first, second, 1.0 + first, 1.0 + second};
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    Cell cell;
    cell.from = edges[i];
    cell.to = edges[i + 1];
    const double a = start + cell.from, b = start + cell.to, half = 0.5 * (b - a);
    cell.normal = Vec2(std::sin(b) - std::sin(a), std::cos(a) - std::cos(b));
    for (std::size_t q = 0; q < 4; ++q) {
      const double angle = a + half * gauss[q];
      cell.points[q] = {std::cos(angle), std::sin(angle), 0.5 * half};
    }
    cells_.push_back(cell);
    for (std::size_t g = 0; g < bands_; ++g) {
      const double middle = 0.5 * (widths[g] + widths[g + 1]);
      std::array<double, 4> depth{0, 0, 0, 0};
      unsigned char open = 0;
      for (const Recess& r : recesses) {
        if (middle > r.width || cell.from < r.from - 1e-9 || cell.to > r.to + 1e-9) continue;
        open = r.open ? 1 : 0;
        for (std::size_t q = 0; q < 4; ++q) {
          const double at = cell.from + half * gauss[q];
          depth[q] = r.depth_from + (r.depth_to - r.depth_from) * (at - r.from) / (r.to - r.from);
        }
      }
      depth_.push_back(depth);
      open_.push_back(open);
    }
  }
  mark_steps();
  add_rows(elements, widths);
}

void GridPad::mark_steps() {
  stepped_.assign(open_.size(), 0);
  // depths at two Gauss points of a half, carried on to its end
  const auto beyond = [](double inner, double outer) {
    return outer + (outer - inner) * 0.5 * (std::sqrt(3.0) - 1.0);
  };
  const auto depth_at = [&](std::size_t n, bool end) {
    if (open_[n]) return 0.0;
    const std::array<double, 4>& d = depth_[n];
    return end ? beyond(d[2], d[3]) : beyond(d[1], d[0]);
  };
  const auto compare = [&](std::size_t l, std::size_t r) {
    const double before = depth_at(l, true), behind = depth_at(r, false);
    if (std::abs(before - behind) > 1e-9 * std::max(before, behind)) stepped_[l] = stepped_[r] = 1;
  };
  for (std::size_t n = bands_; n < open_.size(); ++n)
    compare(n - bands_, n);
  for (std::size_t g = 0; round_ && g < bands_; ++g)
    compare(open_.size() - bands_ + g, g);
}

/// Quadratic elements: a parabola is exact, and what is conducted from node to node is symmetric.
void GridPad::add_rows(const std::vector<double>& elements, const std::vector<double>& widths) {
  rows_.resize(2 * (elements.size() - 1));
  for (std::size_t e = 0; e + 1 < elements.size(); ++e) {
    const double width = elements[e + 1] - elements[e], middle = elements[e] + 0.5 * width;
    std::size_t band = 0;
    while (middle > widths[band + 1])
      ++band;
    band_shares_[band] += width;
    const std::size_t nodes[3] = {2 * e, 2 * e + 1, 2 * e + 2};
    rows_[nodes[0]].profile = 1.0 - elements[e] * elements[e];
    rows_[nodes[1]].profile = 1.0 - middle * middle;
    const double shares[3] = {width / 6.0, 4.0 * width / 6.0, width / 6.0};
    for (std::size_t k = 0; k < 3; ++k)  // the side itself has no pressure
      if (nodes[k] < rows_.size())
        rows_[nodes[k]].pieces.push_back({band, shares[k]});
      else
        side_share_ = shares[k];
    // of both halves of the length, each width/2 wide
    const double unit = 4.0 * ratio_ * ratio_ / (3.0 * width);
    across_.push_back({nodes[0], nodes[1], band, 8.0 * unit});
    across_.push_back({nodes[1], nodes[2], band, 8.0 * unit});
    across_.push_back({nodes[0], nodes[2], band, -unit});
  }
}

/// At the points of cell i, over that of reference.
std::array<double, 4> GridPad::Solver::viscosity(std::size_t i) const {
  std::array<double, 4> mu{1.0, 1.0, 1.0, 1.0};
  if (in_.log_viscosity.empty()) return mu;
  const Cell& cell = pad_.cells_[i];
  const double first = 0.25 - 0.25 / std::sqrt(3.0), second = 0.25 + 0.25 / std::sqrt(3.0);
  const double shares[4] = {first, second, 0.5 + first, 0.5 + second};
  for (std::size_t q = 0; q < 4; ++q) {
    double slope = 0.0;
    const double place = std::lerp(cell.from, cell.to, shares[q]) / pad_.arc_;
    mu[q] = std::exp(log_viscosity_at(in_.log_viscosity, place, slope));
  }
  return mu;
}

void GridPad::Solver::add_resistance(std::size_t i, std::size_t g,
                                     const std::array<double, 4>& mu) {
  const Cell& cell = pad_.cells_[i];
  const std::array<double, 4>& depth = pad_.depth(i, g);
  const bool open = pad_.open(i, g);
  const double share = pad_.band_shares_[g];
  Section section{0.0, Vec3::Zero()};
  double walls = 0.0;
  Vec3 dwalls = Vec3::Zero();
  for (std::size_t half = 0; half < 2; ++half) {
    Half sum;
    sum.clear();
    for (std::size_t q = 2 * half; q < 2 * half + 2; ++q) {
      const Point& x = cell.points[q];
      const Vec3 dh(-x.cos, -x.sin, 0.0);
      const double D = open ? 0.0 : depth[q];
      const double h = 1.0 - in_.e.x() * x.cos - in_.e.y() * x.sin + D / in_.clearance;
      const double cube = h * h * h;
      double along = 1.0, across = 1.0, wall = 1.0, d_along = 0.0, d_across = 0.0, d_wall = 0.0;
      if (in_.reynolds > 0.0) {
        const TurbulentFactors<Dual<1>> f(Dual<1>::variable(in_.reynolds * h / mu[q], 0));
        along = f.along.v;
        across = f.across.v;
        wall = f.shear.v;
        d_along = f.along.g[0];
        d_across = f.across.g[0];
        d_wall = f.shear.g[0];
      }
      const double r = x.weight * mu[q] * along / cube;
      sum.r += r;
      sum.s += D * r;
      sum.square += D * D * r;
      section.g += x.weight * cube / (mu[q] * across);
      walls += open ? 0.0 : x.weight * mu[q] * wall / h;
      if (!slopes_) continue;
      Vec3 d_arg = in_.reynolds / mu[q] * dh;  // of reynolds h/mu
      d_arg[2] = h / mu[q];
      const Vec3 dr = x.weight * mu[q] / cube * (d_along * d_arg - 3.0 * along / h * dh);
      sum.dr += dr;
      sum.ds += D * dr;
      sum.dsquare += D * D * dr;
      section.dg += x.weight / mu[q] *
                    (3.0 * h * h / across * dh - cube * d_across / (across * across) * d_arg);
      if (!open) dwalls += x.weight * mu[q] / h * (d_wall * d_arg - wall / h * dh);
    }
    half_cells_[(2 * i + half) * bands_ + g] = sum;
  }
  sections_[i * bands_ + g] = section;
  walls_[i * bands_ + g] = walls;
  dwalls_[i * bands_ + g] = dwalls;
  shear_ += share * walls;
  dshear_ += share * dwalls;
}

void GridPad::Solver::number_columns() {
  for (std::size_t i = 0; i < n_; ++i)
    place_[i] = !pad_.round_ ? i : 2 * i < n_ ? 2 * i : 2 * (n_ - 1 - i) + 1;
}

/// Conductance of a whole cell along the arc, 1/int 1/(a h^3), with its slopes.
double GridPad::Solver::own(std::size_t i, std::size_t j, Vec3* slope) const {
  double sum = 0.0;
  for (const Piece& x : pieces(j)) {
    const Half &a = half_cells_[2 * i * bands_ + x.band],
               &b = half_cells_[(2 * i + 1) * bands_ + x.band];
    const double r = a.r + b.r;
    sum += x.share / r;
    if (slope != nullptr) *slope -= x.share / (r * r) * (a.dr + b.dr);
  }
  return sum;
}

void GridPad::Solver::add_conductances() {
  for (std::size_t f = 0; f < faces(); ++f) {
    std::array<double, most_bands> own;
    for (std::size_t g = 0; g < bands_; ++g)
      own[g] = 1.0 / face(f, g).r;
    for (std::size_t j = 0; j < m_; ++j) {
      double sum = 0.0;
      for (const Piece& x : pieces(j))
        sum += x.share * own[x.band];
      along_[f * m_ + j] = sum;
    }
  }
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j)
      own_[at(i, j)] = own(i, j);
}

void GridPad::Solver::add_sources() {
  for (auto& B : B_)
    std::fill_n(B.begin(), size_, 0.0);
  std::fill_n(open_.begin(), size_, static_cast<unsigned char>(0));
  std::fill_n(stepped_.begin(), size_, static_cast<unsigned char>(0));
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j)
      for (const Piece& x : pieces(j)) {
        const std::size_t k = at(i, j);
        B_[0][k] += x.share * pad_.cells_[i].normal.x();
        B_[1][k] += x.share * pad_.cells_[i].normal.y();
        if (pad_.open(i, x.band)) open_[k] = 1;
        if (pad_.stepped(i, x.band)) stepped_[k] = 1;
      }
  for (std::size_t f = 0; f < faces(); ++f)
    for (std::size_t g = 0; g < bands_; ++g) {
      const Stretch x = face(f, g);
      if (x.s == 0.0) continue;
      for (std::size_t j = 0; j < m_; ++j)
        for (const Piece& piece : pieces(j)) {
          if (piece.band != g) continue;
          const double carried = piece.share * x.s / x.r;
          if (left_of(f) != groove) B_[2][at(left_of(f), j)] -= carried;
          if (right_of(f) != groove) B_[2][at(right_of(f), j)] += carried;
        }
    }
  for (std::size_t k = 0; k < size_; ++k)
    across_in_[k] = B_[0][k] * in_.source[0] + B_[1][k] * in_.source[1] + B_[2][k] * in_.source[2];
  std::fill_n(along_in_.begin(), size_, 0.0);
  const auto from_known = [&](std::array<double, most>& to) {
    return [&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
      const auto level = [&](std::size_t n) { return n == side ? 0.0 : in_.edge; };
      if (known(k) && !known(l)) to[l] += by * level(k);
      if (known(l) && !known(k)) to[k] += by * level(l);
    };
  };
  for_each_link_along(from_known(along_in_));
  for_each_link_across(from_known(across_in_));
}

void GridPad::Solver::couple(std::size_t k, std::size_t l, double by_k, double by_l) {
  if (wet(k)) entry(k, k) += by_k;
  if (wet(l)) entry(l, l) += by_l;
  if (known(k) || known(l)) return;
  // ruptured film keeps what flows into it where mass is conserved
  if (wet(k) && (wet(l) || carries_)) entry(l, k) -= by_l;
  if (wet(l) && (wet(k) || carries_)) entry(k, l) -= by_k;
}

void GridPad::Solver::couple_film() {
  for_each_link_along([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    couple(k, l, by, by);
  });
  for_each_link_across([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    couple(k, l, share(k) * by, share(l) * by);
  });
  for (std::size_t k = 0; k < size_; ++k)
    if (film_[k]) entry(k, k) += past_front(k);
}

/// The matrix of the nodes with film in two triangles; open recesses stand apart, as do dry nodes that
/// carry nothing on.
void GridPad::Solver::factor() {
  for (std::size_t k = 0; k < size_; ++k) {
    if (!film_[k] && (!carries_ || open_[k])) {
      entry(k, k) = 1.0;
      continue;
    }
    const double inverse = 1.0 / entry(k, k);
    const std::size_t end = std::min(size_, k + half_ + 1);
    const double* pivot = &entry(k, k);
    for (std::size_t i = k + 1; i < end; ++i) {
      double* row = &entry(i, k);
      if (row[0] == 0.0) continue;
      const double by = row[0] *= inverse;
      for (std::size_t c = 1; c < end - k; ++c)
        row[c] -= by * pivot[c];
    }
  }
}

void GridPad::Solver::solve(double* x) const {
  for (std::size_t k = 0; k < size_; ++k) {
    const std::size_t from = k > half_ ? k - half_ : 0;
    const double* row = &a_[k * (2 * half_ + 1) + half_ - (k - from)];
    double sum = x[k];
    for (std::size_t c = from; c < k; ++c)
      sum -= row[c - from] * x[c];
    x[k] = sum;
  }
  for (std::size_t k = size_; k-- > 0;) {
    const std::size_t end = std::min(size_, k + half_ + 1);
    const double* row = &a_[k * (2 * half_ + 1) + half_];
    double sum = x[k];
    for (std::size_t c = k + 1; c < end; ++c)
      sum -= row[c - k] * x[c];
    x[k] = sum / row[0];
  }
}

void GridPad::Solver::solve_transposed(double* x) const {
  for (std::size_t k = 0; k < size_; ++k) {
    const std::size_t end = std::min(size_, k + half_ + 1);
    const double* row = &a_[k * (2 * half_ + 1) + half_];
    const double own = x[k] /= row[0];
    for (std::size_t c = k + 1; c < end; ++c)
      x[c] -= row[c - k] * own;
  }
  for (std::size_t k = size_; k-- > 0;) {
    const std::size_t from = k > half_ ? k - half_ : 0;
    const double* row = &a_[k * (2 * half_ + 1) + half_ - (k - from)];
    const double own = x[k];
    for (std::size_t c = from; c < k; ++c)
      x[c] -= row[c - from] * own;
  }
}

/// What nodes get along the arc and lose across it, at the last pressures.
void GridPad::Solver::find_flows() {
  std::copy_n(along_in_.begin(), size_, inflow_.begin());
  for (std::size_t k = 0; k < size_; ++k)
    lost_[k] = -across_in_[k];
  for_each_link_along([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    if (known(k) || known(l)) return;
    if (film_[l]) inflow_[k] += by * P_[l];
    if (film_[k]) inflow_[l] += by * P_[k];
  });
  for_each_link_across([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    const auto of = [&](std::size_t n) { return wet(n) ? P_[n] : 0.0; };
    if (!known(k)) lost_[k] += by * (of(k) - of(l));
    if (!known(l)) lost_[l] += by * (of(l) - of(k));
  });
}

/// Of the distance of two nodes, how far the film reaches beyond node k.
double GridPad::Solver::reach(std::size_t k) const {
  if (!may_part(k) || lost_[k] <= 0.0) return 1.0;
  return std::clamp(std::sqrt(2.0 * own_[k] * std::max(P_[k], 0.0) / lost_[k]), least_reach, 1.0);
}

/// As reach, of a dry node that lacks too little: what it will be with the neighbours' pressures.
double GridPad::Solver::first_reach(std::size_t k, double lacking) const {
  if (!may_part(k) || lost_[k] <= 0.0) return 1.0;
  const double given = 1.0 - lacking / lost_[k];  // 1/2 + s + s^2/2
  return std::clamp(std::sqrt(2.0 * std::max(given, 0.0)) - 1.0, least_reach, 1.0);
}

/// What a dry node next to the film would lack at least.
double GridPad::Solver::least_lacking(std::size_t k) const {
  return may_part(k) ? 0.5 * std::max(lost_[k], 0.0) : 0.0;
}

/// Film where the pressures found are positive, and where a dry node would have to swallow more than
/// `least`; fronts where those pressures place them. False: nothing changed.
bool GridPad::Solver::take_film(double least, bool may_form) {
  find_flows();
  bool changed = false;
  for (std::size_t k = 0; k < size_; ++k) {
    if (open_[k]) continue;
    if (film_[k]) {
      const double s = reach(k), off = s - reach_[k];
      changed = changed || P_[k] <= 0.0 || 0.5 * lost_[k] * off * off > least * reach_[k];
      film_[k] = P_[k] > 0.0;
      reach_[k] = film_[k] ? s : 1.0;
      continue;
    }
    if (!may_form || inflow_[k] - lost_[k] + least_lacking(k) <= least) continue;
    film_[k] = 1;
    reach_[k] = first_reach(k, lost_[k] - inflow_[k]);
    changed = true;
  }
  return changed;
}

/// P with the film and its fronts where they are taken to be.
void GridPad::Solver::solve_film() {
  clear_matrix();
  couple_film();
  factor();
  for (std::size_t k = 0; k < size_; ++k)
    P_[k] = film_[k] ? along_in_[k] + share(k) * across_in_[k] : open_[k] ? in_.edge : 0.0;
  solve(P_.data());
}

namespace {

/// One profile of the pressure along the axis in each column, positive: Gauss along the arc, a circle
/// opened at `first`, and policy iteration.
class ProfileFilm {
 public:
  struct Column {
    double source = 0.0, across = 0.0, p = 0.0, pivot = 0.0;
    bool film = true;
  };
  std::array<Column, GridPad::most_columns> columns;
  std::array<double, GridPad::most_columns + 1> along{};  ///< between a column and the one before

  explicit ProfileFilm(std::size_t number) : n_(number) {}
  /// Where most is swallowed.
  void open_circle() {
    along[n_] = along[0];
    for (std::size_t i = 1; i < n_; ++i)
      if (columns[i].source < columns[first_].source) first_ = i;
  }
  void settle() {
    constexpr int most_passes = 60;
    for (int pass = 0; pass < most_passes; ++pass) {
      solve();
      if (!take_film()) return;
    }
  }

 private:
  std::size_t number_of(std::size_t step) const { return (first_ + step) % n_; }
  void solve() {
    double pivot = infinity, carried = 0.0;  // of the column before
    for (std::size_t step = 0; step < n_; ++step) {
      const std::size_t i = number_of(step);
      Column& own = columns[i];
      const double share = along[i] / pivot;
      own.pivot = along[i] + along[i + 1] + own.across - share * along[i];
      own.p = own.source + share * carried;
      pivot = own.film ? own.pivot : infinity;
      carried = own.film ? own.p : 0.0;
    }
    double behind = 0.0;
    for (std::size_t step = n_; step-- > 0;) {
      const std::size_t i = number_of(step);
      Column& own = columns[i];
      own.p = own.film ? (own.p + along[i + 1] * behind) / own.pivot : 0.0;
      behind = own.p;
    }
  }
  bool take_film() {
    bool changed = false;
    double before = 0.0;
    for (std::size_t step = 0; step < n_; ++step) {
      const std::size_t i = number_of(step);
      const double next = step + 1 < n_ ? columns[number_of(step + 1)].p : 0.0;
      Column& own = columns[i];
      const bool now =
          own.film ? own.p > 0.0 : own.source + along[i] * before + along[i + 1] * next > 0.0;
      before = own.p;
      changed = changed || now != own.film;
      own.film = now;
    }
    return changed;
  }

  std::size_t n_, first_ = 0;
};

}  // namespace

/// Film of one profile along the axis, to begin with: it takes a few passes where full films would take
/// twenty. (Not beside recesses, whose films it leaves too small.)
void GridPad::Solver::guess_film() {
  ProfileFilm guess(n_);
  const auto profile = [&](std::size_t k, std::size_t j) {
    return open_[k] ? 0.0 : pad_.rows_[j].profile;
  };
  for (std::size_t i = 0; i < n_; ++i) {
    ProfileFilm::Column& own = guess.columns[i];
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j);
      own.source += profile(k, j) * (along_in_[k] + across_in_[k]);
    }
    for (const Across& x : pad_.across_) {
      const double far = x.to < m_ ? profile(at(i, x.to), x.to) : 0.0;
      const double step = profile(at(i, x.from), x.from) - far;
      own.across += x.conductance * sections_[i * bands_ + x.band].g * step * step;
    }
  }
  for (std::size_t f = 0; f < faces(); ++f) {
    const std::size_t l = left_of(f), r = right_of(f);
    for (std::size_t j = 0; j < m_; ++j) {
      const double before = l == groove ? 0.0 : profile(at(l, j), j),
                   behind = r == groove ? 0.0 : profile(at(r, j), j);
      guess.along[f] += along_[f * m_ + j] * std::max(before * before, behind * behind);
    }
  }
  if (pad_.round_) guess.open_circle();
  guess.settle();
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j);
      film_[k] = guess.columns[i].film && !open_[k] ? 1 : 0;
      reach_[k] = 1.0;
    }
}

void GridPad::Solver::fill_all() {
  for (std::size_t k = 0; k < size_; ++k) {
    film_[k] = open_[k] ? 0 : 1;
    reach_[k] = 1.0;
  }
}

void GridPad::Solver::find_film() {
  // a film grows by a node a pass, so one that was guessed too small is begun again with all; should it
  // not settle, it may only shrink from some pass on
  constexpr int most_passes = 200, again = 12, free_passes = 72;
  constexpr double rounding = 1e-13;  // of the largest source
  double size = 0.0;
  for (std::size_t k = 0; k < size_; ++k)
    size = std::max(size, std::abs(along_in_[k] + across_in_[k]));
  const bool guessed = pad_.recesses_.empty();
  if (guessed)
    guess_film();
  else
    fill_all();
  for (int pass = 0; pass < most_passes; ++pass) {
    if (guessed && pass == again) fill_all();
    solve_film();
    if (take_film(rounding * size, pass < free_passes)) continue;
    for (std::size_t k = 0; k < size_; ++k)
      lacking_[k] = lacking(k);
    return;
  }
  P_[0] = nan;  // never seen; without a film that settles there is no force
}

void GridPad::Solver::loads(GridLoad& out) const {
  out = {};
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j)
      for (const Piece& x : pieces(j))
        out.z.head<2>() += x.share * (P_[at(i, j)] - in_.edge) * pad_.cells_[i].normal;
  const Vec2 wedge = in_.source.head<2>() - motion();
  for (std::size_t i = 0; i < n_; ++i) {
    const Cell& cell = pad_.cells_[i];
    out.z.head<2>() -= pad_.side_share_ * in_.edge * cell.normal;  // nothing stands at the side
    out.normal += in_.source.head<2>().dot(cell.normal);
    for (std::size_t j = 0; j < m_; ++j) {
      if (!open_[at(i, j)]) continue;  // what is open gives and takes at one pressure
      for (const Piece& x : pieces(j))
        out.normal -= x.share * wedge.dot(cell.normal);
    }
  }
  for (std::size_t f = 0; f < faces(); ++f)
    for (std::size_t g = 0; g < bands_; ++g) {
      const std::size_t l = left_of(f), r = right_of(f);
      const Stretch x = face(f, g);
      if (x.s == 0.0) continue;
      // int D P' with P' = (S D - q)/(a h^3)
      const double spread = in_.source[2] * (x.square - x.s * x.s / x.r);
      for (std::size_t j = 0; j < m_; ++j)
        for (const Piece& piece : pieces(j)) {
          if (piece.band != g) continue;
          const double along = piece.share * x.s / x.r;
          out.z[2] += along * (pressure(node(r, j)) - pressure(node(l, j))) + piece.share * spread;
          if (l == groove) out.normal += along * in_.source[2];
          if (r == groove) out.normal -= along * in_.source[2];
        }
    }
  for_each_link([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    if (l == side) return;
    if (known(k) && !known(l)) out.fed += by * (pressure(k) - pressure(l));
    if (known(l) && !known(k)) out.fed += by * (pressure(l) - pressure(k));
  });
  out.shear = carries_ ? shear_carried() : shear_;
  if (!carries_) return;
  for (std::size_t k = 0; k < size_; ++k)
    if (!open_[k] && known(downstream(k))) out.fed += deficit(k);  // that does not come back
}

/// What a load feels of what node k lacks: at the node itself, and where that is handed on.
double GridPad::Solver::lacked(int load, std::size_t k) {
  double sum = adjoint(load)[k];
  if (!carries_) return sum;
  const std::size_t to = downstream(k);
  if (!known(to)) sum -= handed_on(k) * adjoint(load)[to];
  return load == 3 ? sum + shear_by_lacking_[k] : sum;
}

/// What it feels of what the node gets across the arc.
double GridPad::Solver::across(int load, std::size_t k) {
  return parted(k) ? adjoint(load)[k] - unmet(k) * lacked(load, k) : adjoint(load)[k];
}

void GridPad::Solver::slopes(GridSlopes& out) {
  if (carries_) half_ = m_ + late_band;
  clear_matrix();
  couple_film();
  LoadSlopes to;
  for (int k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < size_; ++c)
      adjoint(k)[c] = film_[c] ? B_[static_cast<std::size_t>(k)][c] : 0.0;
  if (carries_) {
    couple_carried();
    add_shear_slopes(to);
  }
  factor();
  for (int k = 0; k < (carries_ ? 4 : 3); ++k) {
    solve_transposed(adjoint(k).data());
    for (std::size_t l = 0; l < 3; ++l)
      for (std::size_t c = 0; c < size_; ++c)
        to.by_source(k, static_cast<Index>(l)) += across(k, c) * B_[l][c];
  }
  if (carries_) add_slopes_of_squeeze(to);
  add_slopes_of_flows(to);
  out.by_source = to.by_source.topRows<3>();
  out.by_e = to.by.topLeftCorner<3, 2>();
  out.by_reynolds = to.by.col(2).head<3>();
  out.shear_by_source = to.by_source.row(3).transpose();
  out.shear_by_e = (carries_ ? Vec3(to.by.row(3).transpose()) : dshear_).head<2>();
  out.shear_by_reynolds = carries_ ? to.by(3, 2) : dshear_[2];
}

/// What e and the Reynolds number change in the flows between nodes.
void GridPad::Solver::add_slopes_of_flows(LoadSlopes& to) {
  const int loads = carries_ ? 4 : 3;
  const double S = in_.source[2];
  const auto value = [&](int k, std::size_t c) { return c >= side ? 0.0 : adjoint(k)[c]; };
  const auto crossed = [&](int k, std::size_t c) { return c >= side ? 0.0 : across(k, c); };
  for (std::size_t f = 0; f < faces(); ++f)
    for (std::size_t g = 0; g < bands_; ++g) {
      const Stretch x = face(f, g);
      const double mean = x.s / x.r;
      const Vec3 dmean = x.ds - mean * x.dr;
      const Vec3 dspread = x.dsquare - 2.0 * mean * x.ds + mean * mean * x.dr;
      for (std::size_t j = 0; j < m_; ++j)
        for (const Piece& piece : pieces(j)) {
          if (piece.band != g) continue;
          const std::size_t l = node(left_of(f), j), r = node(right_of(f), j);
          const double step = pressure(r) - pressure(l), q = (S * x.s - step) / x.r;
          const Vec3 dq = piece.share / x.r * (S * x.ds - q * x.dr);
          for (int k = 0; k < loads; ++k)
            to.by.row(k) += (value(k, r) - value(k, l)) * dq.transpose();
          to.by.row(2) += piece.share * (step / x.r * dmean + S * dspread).transpose();
          to.by_source(2, 2) += piece.share * (x.square - mean * x.s);
        }
    }
  for (std::size_t i = 0; i < n_; ++i)
    for (const Across& x : pad_.across_) {
      const std::size_t k = at(i, x.from), l = far_node(i, x);
      const Vec3 dq =
          (pressure(k) - pressure(l)) * x.conductance * sections_[i * bands_ + x.band].dg;
      for (int row = 0; row < loads; ++row)
        to.by.row(row) += (crossed(row, l) - crossed(row, k)) * dq.transpose();
    }
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j);
      if (past_front(k) == 0.0) continue;
      Vec3 down = Vec3::Zero();
      own(i, j, &down);
      const Vec3 dq = P_[k] * past_front(k) / own_[k] * down;
      for (int row = 0; row < loads; ++row)
        to.by.row(row) -= lacked(row, k) * dq.transpose();
    }
}

GridField GridPad::Solver::field() const {
  GridField out;
  out.thinnest = infinity;
  for (std::size_t i = 0; i < n_; ++i) {
    const Cell& cell = pad_.cells_[i];
    double mean = 0.0, most_there = 0.0;
    for (std::size_t j = 0; j < m_; ++j) {
      const double P = P_[at(i, j)];
      for (const Piece& x : pieces(j))
        mean += x.share * P;
      most_there = std::max(most_there, P);
      if (P <= out.highest) continue;
      out.highest = P;
      out.highest_at = 0.5 * (cell.from + cell.to);
    }
    out.place.push_back(0.5 * (cell.from + cell.to));
    out.mean.push_back(mean);
    out.largest.push_back(most_there);
    out.wet.push_back(most_there > 0.0 ? 1 : 0);
    bool shown = false;
    for (std::size_t g = 0; g < bands_; ++g) {
      if (pad_.open(i, g)) continue;
      double thickness = 0.0;
      for (std::size_t q = 0; q < 4; ++q) {
        const Point& x = cell.points[q];
        const double h =
            1.0 - in_.e.x() * x.cos - in_.e.y() * x.sin + pad_.depth(i, g)[q] / in_.clearance;
        thickness += 0.25 * h;
        if (h >= out.thinnest) continue;
        out.thinnest = h;
        out.thinnest_at = cell.from + (static_cast<double>(q) + 0.5) / 4.0 * (cell.to - cell.from);
      }
      if (!shown) out.thickness.push_back(thickness);
      shown = true;
    }
    if (!shown) out.thickness.push_back(0.0);
  }
  if (carries_)
    add_carried_flow(out);
  else
    add_flow(out);
  add_heat(out);
  return out;
}

/// What the flow between two neighbours along the arc lacks where one is dry.
double GridPad::Solver::lacking_past(std::size_t l, std::size_t r) const {
  if (wet(l) == wet(r)) return 0.0;
  return wet(l) ? deficit(l) : -deficit(r);
}

/// Past the faces of a row, and what tells how long its films are.
struct GridPad::Solver::RowFlow {
  using Faces = std::array<double, most_columns + 1>;
  Faces flow;                 ///< NaN: no film
  Faces stream, from_groove;  ///< as of GridField
  Faces covered;              ///< of the way between the nodes beside it, where a film ends there
  Faces pressure, resistance, width;  ///< mean and int 1/(a h^3) between the nodes beside it, rad
  std::array<bool, most_columns + 1> in_track;
  double least;  ///< of what is dragged
  double first;  ///< of what is dragged, that at the groove
};

void GridPad::Solver::find_row(std::size_t j, std::size_t band, bool at_side,
                               const std::vector<double>& places, RowFlow& row) const {
  const double S = in_.source[2];
  row.least = infinity;
  const auto half = [&](std::size_t cell) {
    return cell == groove ? 0.0 : 0.5 * (pad_.cells_[cell].to - pad_.cells_[cell].from);
  };
  for (std::size_t f = 0; f <= n_; ++f) {
    const std::size_t own = pad_.round_ && f == n_ ? 0 : f;
    const std::size_t l = node(left_of(own), j), r = node(right_of(own), j);
    const double angle = pad_.start_ + places[f];
    const double circle = 1.0 - in_.e.x() * std::cos(angle) - in_.e.y() * std::sin(angle);
    const Stretch x = face(own, band);
    row.in_track[f] = (l < side && open_[l]) || (r < side && open_[r]);
    row.pressure[f] = 0.5 * (pressure(l) + pressure(r));
    row.resistance[f] = x.r;
    row.width[f] = half(left_of(own)) + half(right_of(own));
    row.covered[f] = (wet(l) ? reach_[l] : 1.0) * (wet(r) ? reach_[r] : 1.0);
    row.flow[f] = nan;
    const double dragged = S * (in_.clearance * circle + x.s / x.r);
    if (f == (forward() ? 0 : n_)) row.first = dragged;
    if (row.in_track[f]) continue;
    const double pushed = at_side ? 0.0 : (pressure(r) - pressure(l)) / x.r;
    if (std::abs(dragged) < std::abs(row.least)) row.least = dragged;
    if (row.pressure[f] > 0.0)
      row.flow[f] = dragged - pushed - (at_side ? 0.0 : lacking_past(l, r) / row_share(j));
  }
  if (!std::isfinite(row.least)) row.least = 0.0;  // all of it a track
}

/// Share of what a film forms with that it takes in (film_field.hpp), by the length l that a film of its
/// pressure has where the gap is widest: int P dtheta = S c |e| (1/h^3) l^4/72.
double GridPad::Solver::taken_in(double pressure, double resistance, double width) const {
  const double unit = std::abs(in_.source[2]) * in_.clearance * in_.e.norm() * resistance / width;
  const double short_film = PadFilm::short_film * pad_.arc_;
  const double square = std::sqrt(72.0 * pressure / unit) / (short_film * short_film);
  return square < 1.0 ? square : 1.0;
}

/// Downstream: a film that forms takes in what it lacks, and after it flows what left it.
void GridPad::Solver::join_films(RowFlow& row) const {
  const bool forward = in_.source[2] >= 0.0;
  const auto at_face = [&](std::size_t step) { return forward ? step : n_ - step; };
  const auto film = [&](std::size_t step) {
    return step <= n_ && !std::isnan(row.flow[at_face(step)]);
  };
  double carried = row.least, stream = pad_.round_ ? row.least : row.first, given = 0.0;
  bool first = true;
  for (std::size_t step = 0; step <= n_;) {
    if (!film(step)) {
      const std::size_t f = at_face(step++);
      row.flow[f] = carried;
      row.stream[f] = stream;
      row.from_groove[f] = given;
      continue;
    }
    double pressure = 0.0, resistance = 0.0, width = 0.0;
    std::size_t end = step;
    for (; film(end); ++end) {
      const std::size_t f = at_face(end);
      pressure += row.pressure[f] * row.width[f];
      resistance += row.resistance[f];
      width += row.width[f];
    }
    const bool forms = step > 0 && !pad_.round_ && !row.in_track[at_face(step - 1)];
    const double taken = forms ? taken_in(pressure, resistance, width) : 1.0;
    const auto joined = [&](double comes, double flow) {
      return (forward ? comes < flow : comes > flow) ? std::lerp(comes, flow, taken) : flow;
    };
    const double begins = row.flow[at_face(step)], more = joined(stream, begins) - stream;
    for (std::size_t k = step; k < end; ++k) {
      const std::size_t f = at_face(k);
      const double covered = forms && k == step ? row.covered[f] : 1.0;
      row.stream[f] = std::lerp(stream, joined(stream, row.flow[f]), covered);
      row.from_groove[f] =
          given + (first && (forward ? more > 0.0 : more < 0.0) ? covered * more : 0.0);
      row.flow[f] = joined(carried, row.flow[f]);
    }
    stream = row.stream[at_face(end - 1)];
    given = row.from_groove[at_face(end - 1)];
    // what the first film begins with comes from the groove
    for (std::size_t k = 0; first && k < step; ++k)
      row.flow[at_face(k)] = row.flow[at_face(step)];
    first = false;
    carried = row.flow[at_face(end - 1)];
    step = end;
  }
}

/// Flow past every face. Where no film is, a row carries what left the film before it, or what the next
/// one begins with.
void GridPad::Solver::add_flow(GridField& out) const {
  for_each_link([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    const double q = by * (pressure(k) - pressure(l));
    if (l == side) out.side += q;
    if (k >= side || l >= side) return;
    if (open_[l] && !open_[k]) out.into_open += q;
    if (open_[k] && !open_[l]) out.into_open -= q;
  });
  for (auto* x : {&out.flow, &out.stream, &out.from_groove})
    x->assign(n_ + 1, 0.0);
  for (std::size_t f = 0; f <= n_; ++f)
    out.face_place.push_back(f < n_ ? pad_.cells_[f].from : pad_.cells_[n_ - 1].to);
  RowFlow row;
  const auto add_row = [&](std::size_t j, std::size_t band, double share, bool at_side) {
    find_row(j, band, at_side, out.face_place, row);
    join_films(row);
    for (std::size_t f = 0; f <= n_; ++f) {
      out.flow[f] += share * row.flow[f];
      out.stream[f] += share * row.stream[f];
      out.from_groove[f] += share * row.from_groove[f];
    }
  };
  for (std::size_t j = 0; j < m_; ++j)
    for (const Piece& piece : pieces(j))
      add_row(j, piece.band, piece.share, false);
  // the side itself drags along what the film beside it has, and lets go of the rest
  add_row(m_ - 1, bands_ - 1, pad_.side_share_, true);
  out.side += pad_.side_share_ * (row.flow[0] - row.flow[n_]);
}

/// What a heat balance of the mean over the length needs, ruptured gaps filled: they count so in the
/// drag, but for films that conserve mass.
void GridPad::Solver::add_heat(GridField& out) const {
  const double S = in_.source[2];
  std::vector<double> driven(n_ + 1, 0.0), shear(n_ + 1, 0.0);  // of the column before a face
  out.filled.assign(n_ + 1, 0.0);
  for (std::size_t f = 0; f <= n_; ++f) {
    const std::size_t own = pad_.round_ && f == n_ ? 0 : f, l = left_of(own), r = right_of(own);
    const double angle = pad_.start_ + out.face_place[f];
    const double circle = 1.0 - in_.e.x() * std::cos(angle) - in_.e.y() * std::sin(angle);
    const auto add = [&](std::size_t band, double share, double before, double behind) {
      if ((l != groove && pad_.open(l, band)) || (r != groove && pad_.open(r, band))) return;
      const Stretch x = face(own, band);
      out.filled[f] += share * (S * (in_.clearance * circle + x.s / x.r) + (before - behind) / x.r);
      const double heat = share * (S * S * (x.square - x.s * x.s / x.r) +
                                   (before - behind) * (before - behind) / x.r);
      // half to the column on either side; what has none on one goes to the other
      const bool first = f == 0 && !pad_.round_, last = f == n_ && !pad_.round_;
      if (f > 0) driven[f] += last ? heat : 0.5 * heat;
      if (f < n_) driven[f + 1] += first ? heat : 0.5 * heat;
    };
    for (std::size_t j = 0; j < m_; ++j) {
      for (const Piece& piece : pieces(j))
        add(piece.band, piece.share, pressure(node(l, j)), pressure(node(r, j)));
    }
    // at the side itself the pressure is nowhere any: what is dragged along
    const Stretch x = face(own, bands_ - 1);
    out.filled[f] += pad_.side_share_ * S * (in_.clearance * circle + x.s / x.r);
  }
  for (std::size_t i = 0; i < n_; ++i) {
    for (const Across& x : pad_.across_) {
      const double dP = pressure(at(i, x.from)) - pressure(far_node(i, x));
      driven[i + 1] += x.conductance * sections_[i * bands_ + x.band].g * dP * dP;
    }
    const std::array<double, 4> mu = viscosity(i);
    double gap = 0.0, conducting = 0.0;
    for (std::size_t g = 0; g < bands_; ++g) {
      if (pad_.open(i, g)) continue;
      for (std::size_t q = 0; q < 4; ++q) {
        const Point& x = pad_.cells_[i].points[q];
        const double share = pad_.band_shares_[g];
        const double h =
            1.0 - in_.e.x() * x.cos - in_.e.y() * x.sin + pad_.depth(i, g)[q] / in_.clearance;
        const double wall =
            in_.reynolds > 0.0 ? TurbulentFactors<double>(in_.reynolds * h / mu[q]).shear : 1.0;
        gap += 0.25 * share * h;
        conducting += 0.25 * share / h;
        shear[i + 1] += share * x.weight * mu[q] * wall / h;
      }
    }
    out.gap.push_back(gap);
    out.conducting.push_back(conducting);
  }
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j)
      driven[i + 1] -= pressure(at(i, j)) * deficit(at(i, j));
  if (carries_) take_out_dry(shear, driven, out);
  for (std::size_t f = 0; f < n_; ++f) {
    driven[f + 1] += driven[f];
    shear[f + 1] += shear[f];
  }
  out.driven = std::move(driven);
  out.shear = std::move(shear);
}

void GridPad::load(const GridDrive& in, GridLoad& out) const {
  const Solver solver(*this, in, false);
  solver.loads(out);
}

void GridPad::load(const GridDrive& in, GridLoad& out, GridSlopes& slopes) const {
  Solver solver(*this, in, true);
  solver.loads(out);
  solver.slopes(slopes);
}

GridField GridPad::field(const GridDrive& in) const {
  const Solver solver(*this, in, false);
  return solver.field();
}

}  // namespace whirl::elements
