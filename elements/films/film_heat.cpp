#include <elements/films/film_heat.hpp>
#include <core/contract.hpp>
#include <elements/films/turbulence.hpp>

#include <la/dense.hpp>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace whirl::elements {

double HeatSettings::viscosity_near(double T) const {
  return viscosity(std::clamp(T, coldest, hottest));
}

namespace {

/// A matrix of a band, solved without pivots: rows of the energy balance are diagonally dominant.
class Band {
 public:
  Band(Index size, Index half) : half_(half), a_(MatX::Zero(2 * half + 1, size)) {}
  double& operator()(Index i, Index j) { return a_(half_ + j - i, i); }
  /// b becomes the solution, column by column.
  void solve(MatX& b) {
    const Index n = a_.cols();
    for (Index k = 0; k < n; ++k) {
      const double inverse = 1.0 / (*this)(k, k);
      const Index last = std::min(n - 1, k + half_);
      for (Index i = k + 1; i <= last; ++i) {
        double& left = (*this)(i, k);
        if (left == 0.0) continue;
        const double factor = left * inverse;
        left = 0.0;
        for (Index j = k + 1; j <= last; ++j)
          (*this)(i, j) -= factor * (*this)(k, j);
        b.row(i) -= factor * b.row(k);
      }
    }
    for (Index k = n - 1; k >= 0; --k) {
      for (Index j = k + 1; j <= std::min(n - 1, k + half_); ++j)
        b.row(k) -= (*this)(k, j) * b.row(j);
      b.row(k) /= (*this)(k, k);
    }
  }

 private:
  Index half_;
  MatX a_;  ///< column i: row i of the matrix
};

/// What a temperature in the film or the pad depends on: the loss, the journal, the oil that
/// enters, what is behind the pad, oil that films take in at the sides.
enum Cause : Index { of_loss, of_journal, of_inlet, of_surroundings, of_sides, causes };
using Affine = Vector<causes>;

/// Thickness of a pad for what goes through it, m.
double wall_of(const HeatPad& pad, const HeatSettings& s) {
  return std::isnan(s.wall) ? pad.thickness_at_pivot : s.wall;
}

/// The energy balance of one pad.
class PadHeat {
 public:
  PadHeat(const HeatPad& pad, const HeatSettings& s)
      : film_(*pad.film),
        s_(s),
        forward_(pad.point.slip >= 0.0),
        speed_(film_.radius * std::abs(pad.point.slip)),
        N_(static_cast<Index>(s.cells)),
        J_(static_cast<Index>(s.layers)),
        wall_(wall_of(pad, s)),
        M_(wall_ > 0.0 ? static_cast<Index>(s.wall_layers) : 0),
        field_(sample_film(film_, pad.pad, pad.point, s.cells + 1)),
        edge_(J_ + 1),
        x_(MatX::Zero(N_ * (M_ + J_), causes)) {
    if (!forward_) turn_round();
    if (on_grid() && !film_.mass_conserving) empty_gaps();
    if (!on_grid()) place_fronts();
    // finer at the walls, where oil conducts badly
    for (Index j = 0; j <= J_; ++j)
      edge_[j] = 0.5 * (1.0 - std::cos(pi * static_cast<double>(j) / static_cast<double>(J_)));
    dx_ = film_.radius * std::abs(field_.theta[1] - field_.theta[0]);
    Band a(x_.rows(), M_ + J_);
    add_film(a);
    // where films begin and end between faces, these see it by the step
    if (!on_grid() && film_.mass_conserving) turn_into_heat(film_loss(film_, pad.pad, pad.point));
    if (M_ > 0) add_wall(a);
    a.solve(x_);
  }

  /// Heat capacity of what the groove gives and of what leaves at the end, W/K.
  double inflow() const { return carried_.row(0).cwiseMax(0.0).sum() + groove_.sum(); }
  double outflow() const { return carried_.row(N_).cwiseMax(0.0).sum(); }
  /// And of what films that form behind the first one take in at the sides, and what the pressure of a groove
  /// drives back into the end of the pad.
  double taken_in() const {
    return -side_.cwiseMin(0.0).sum() - carried_.row(N_).cwiseMin(0.0).sum();
  }
  double loss() const { return heat_ + gaps_; }
  /// Of the oil that leaves at the end of the pad.
  Affine outlet() const {
    Affine sum = Affine::Zero();
    double flow = 0.0;
    for (Index j = 0; j < J_; ++j) {
      const double m = std::max(0.0, carried_(N_, j));
      sum += m * cell(N_ - 1, j);
      flow += m;
    }
    if (flow > 0.0) return sum / flow;
    sum[of_sides] = 1.0;  // a groove that fills the end of the pad
    return sum;
  }
  /// Heat into the journal, W.
  Affine into_journal() const {
    Affine sum = Affine::Zero();
    for (Index i = 0; i < N_; ++i) {
      sum += journal_[i] * cell(i, J_ - 1);
      sum[of_journal] -= journal_[i];
    }
    return sum;
  }
  /// Heat into the pad, W.
  Affine into_pad() const {
    Affine sum = Affine::Zero();
    for (Index i = 0; M_ > 0 && i < N_; ++i)
      sum += conducted_[i] * (cell(i, 0) - x_.row(wall_place(i, M_ - 1)).transpose());
    return sum;
  }
  PadTemperatures temperatures(const Affine& of) const;

 private:
  Affine cell(Index i, Index j) const { return x_.row(place(i, j)).transpose(); }
  Index place(Index i, Index j) const { return i * (M_ + J_) + M_ + j; }
  Index wall_place(Index i, Index m) const { return i * (M_ + J_) + m; }
  double width(Index j) const { return edge_[j + 1] - edge_[j]; }
  void turn_round() {
    for (auto* x :
         {&field_.theta, &field_.thickness, &field_.pressure, &field_.slope, &field_.viscosity,
          &field_.flow, &field_.stream, &field_.from_groove, &field_.filled, &field_.lost,
          &field_.gap, &field_.conducting, &field_.share, &field_.wetted})
      std::reverse(x->begin(), x->end());
    std::reverse(field_.wet.begin(), field_.wet.end());
    for (auto* x :
         {&field_.slope, &field_.flow, &field_.stream, &field_.from_groove, &field_.filled})
      for (double& value : *x)
        value = -value;
  }
  bool on_grid() const { return !field_.lost.empty(); }
  /// At face i: film thickness; of recesses the mean over the length.
  double face_gap(Index i) const { return on_grid() ? field_.gap[at(i)] : field_.thickness[at(i)]; }
  double h(Index i) const { return 0.5 * (face_gap(i) + face_gap(i + 1)); }
  /// At face i: thickness times the share of the width through which oil flows.
  double flow_gap(Index i) const {
    return on_grid() ? face_gap(i) : face_gap(i) * field_.share[at(i)];
  }
  /// Share of the width that oil wets, of a cell.
  double wet(Index i) const {
    if (on_grid()) return 1.0;
    return std::abs((field_.wetted[at(i + 1)] - field_.wetted[at(i)]) /
                    (field_.theta[at(i + 1)] - field_.theta[at(i)]));
  }
  /// For conduction across the film, 1/m.
  double over_gap(Index i) const {
    if (!on_grid()) return wet(i) / h(i);
    return 0.5 * (field_.conducting[at(i)] + field_.conducting[at(i + 1)]);
  }
  /// h^2 P'/(2 eta f R) at a face, m/s: what the pressure drives back in the middle of the film, over
  /// 1/4, with which the flow is right.
  double pushed_back(Index i) const {
    const double flow = on_grid() ? field_.filled[at(i)] : field_.flow[at(i)];
    return 3.0 * speed_ - 6.0 * flow / (film_.length * flow_gap(i));
  }
  double eta(Index i) const {
    return 0.5 * (field_.viscosity[at(i)] + field_.viscosity[at(i + 1)]);
  }
  double slope(Index i) const { return 0.5 * (field_.slope[at(i)] + field_.slope[at(i + 1)]); }
  double pressure(Index i) const {
    return 0.5 * (field_.pressure[at(i)] + field_.pressure[at(i + 1)]);
  }
  TurbulentFactors<double> factors(double thickness, double viscosity) const {
    return TurbulentFactors<double>(film_.turbulent_density * speed_ * thickness / viscosity);
  }
  double conductivity(Index i) const {
    const double prandtl = eta(i) * s_.specific_heat / s_.conductivity;
    return s_.conductivity * (1.0 + prandtl * (factors(h(i), eta(i)).shear - 1.0));
  }
  void add_film(Band& a);
  void add_flows(Band& a);
  /// In layer j, of what is taken in to be dragged along; of what passes a side, which the pressure drives
  /// out, or which is taken in.
  double share_dragged(Index j) const { return edge_[j + 1] * edge_[j + 1] - edge_[j] * edge_[j]; }
  double share_beside(Index i, Index j) const {
    const auto below = [](double z) { return z * z * (3.0 - 2.0 * z); };
    return side_[i] > 0.0 ? below(edge_[j + 1]) - below(edge_[j]) : share_dragged(j);
  }
  void empty_gaps();
  void place_fronts();
  void find_sides();
  void add_loss(Index i);
  void turn_into_heat(double loss) {
    x_.col(of_loss) *= loss / heat_;
    heat_ = loss;
  }
  void add_wall(Band& a);
  void conduct(Band& a, Index p, Index q, double by) {
    a(p, p) += by;
    a(q, q) += by;
    a(p, q) -= by;
    a(q, p) -= by;
  }
  /// Heat capacity flow m from cell p to cell q.
  void carry(Band& a, Index p, Index q, double m) {
    const double on = std::max(m, 0.0), back = std::min(m, 0.0);
    a(p, p) += on;
    a(p, q) += back;
    a(q, p) -= on;
    a(q, q) -= back;
  }

  const FiniteJournal& film_;
  const HeatSettings& s_;
  bool forward_;
  double speed_, dx_ = 0;
  Index N_, J_;
  double wall_;
  Index M_;
  FilmField field_;
  VecX edge_;
  MatX x_;                  ///< right sides, then temperatures: a column a cause
  MatX carried_;            ///< rho c times the flow through face i in layer j, W/K
  VecX journal_, to_face_;  ///< conductance to the journal and to the pad, one a cell, W/K
  VecX conducted_;   ///< conductance from the film's first layer into the pad, one a cell, W/K
  VecX side_;        ///< rho c times what leaves at the sides, one a cell, W/K
  VecX groove_;      ///< and what the first film takes in from the groove where it forms
  double gaps_ = 0;  ///< loss in gaps between streams that count as full in the drag, W
  double heat_ = 0;
};

void PadHeat::add_film(Band& a) {
  journal_ = to_face_ = VecX::Zero(N_);
  add_flows(a);
  for (Index i = 0; i < N_; ++i) {
    add_loss(i);
    const double by = conductivity(i) * film_.length * dx_ * over_gap(i);
    for (Index j = 0; j + 1 < J_; ++j)
      conduct(a, place(i, j), place(i, j + 1), by / (0.5 * (width(j) + width(j + 1))));
    journal_[i] = by / (0.5 * width(J_ - 1));
    a(place(i, J_ - 1), place(i, J_ - 1)) += journal_[i];
    x_(place(i, J_ - 1), of_journal) += journal_[i];
    to_face_[i] = by / (0.5 * width(0));
  }
}

/// Films of Reynolds on a grid: what flows is the oil of the films, and of ruptured gaps the share that
/// it fills is wetted. The drag counts them as full.
void PadHeat::empty_gaps() {
  const std::size_t n = field_.flow.size();
  std::vector<double> share(n, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    if (!(field_.filled[i] > 0.0 && field_.stream[i] < field_.filled[i])) continue;
    share[i] = std::max(field_.stream[i], 0.0) / field_.filled[i];
    field_.filled[i] *= share[i];
    field_.gap[i] *= share[i];
    field_.conducting[i] *= share[i];
  }
  double left = 0.0, last = field_.lost[0];
  for (std::size_t i = 1; i < n; ++i) {
    const double here = field_.lost[i], wetted = 0.5 * (share[i - 1] + share[i]) * (here - last);
    gaps_ += std::abs(here - last - wetted);
    last = here;
    left += wetted;
    field_.lost[i] = field_.lost[0] + left;
  }
}

/// What a film takes in where it forms comes into its cell and the next, by how near it is to either.
void PadHeat::place_fronts() {
  for (Index i = 0; i + 1 < N_; ++i) {
    if (field_.wet[at(i)] || !field_.wet[at(i + 1)] || !(field_.share[at(i)] < 1.0)) continue;
    const double dry = std::min(1.0, (1.0 - wet(i)) / (1.0 - field_.share[at(i)]));
    double& flow = field_.flow[at(i + 1)];
    const double carried = std::lerp(flow, std::min(flow, field_.flow[at(i)]), dry);
    field_.share[at(i + 1)] = carried / flow;
    flow = carried;
  }
}

/// What films take in where they form: that of the first one comes from the groove.
void PadHeat::find_sides() {
  side_.resize(N_);
  groove_ = VecX::Zero(N_);
  for (Index i = 0; i < N_; ++i)
    side_[i] = carried_.row(i).sum() - carried_.row(i + 1).sum();
  if (field_.from_groove.empty()) {
    const auto wet = std::find(field_.wet.begin(), field_.wet.end(), 1);
    const Index first = std::min<Index>(N_, wet - field_.wet.begin() + 1);
    groove_.head(first) = -side_.head(first).cwiseMin(0.0);
  } else {
    const double capacity = s_.density * s_.specific_heat;
    for (Index i = 0; i < N_; ++i)
      groove_[i] = capacity * (field_.from_groove[at(i + 1)] - field_.from_groove[at(i)]);
  }
  side_ += groove_;
}

void PadHeat::add_flows(Band& a) {
  const double capacity = s_.density * s_.specific_heat * film_.length;
  carried_.resize(N_ + 1, J_);
  for (Index i = 0; i <= N_; ++i) {
    const double H = flow_gap(i), pushed = pushed_back(i);
    const auto below = [&](double z) {  // int u dzeta
      return 0.5 * speed_ * z * z - pushed * z * z * (0.5 - z / 3.0);
    };
    for (Index j = 0; j < J_; ++j)
      carried_(i, j) = capacity * H * (below(edge_[j + 1]) - below(edge_[j]));
  }
  find_sides();
  for (Index i = 0; i < N_; ++i) {
    double up = 0.0;
    for (Index j = 0; j < J_; ++j) {
      const Index p = place(i, j);
      const double side = side_[i] * share_beside(i, j), groove = groove_[i] * share_dragged(j);
      a(p, p) += std::max(side, 0.0);
      x_(p, of_sides) -= std::min(side, 0.0);
      x_(p, of_inlet) += groove;
      up += carried_(i, j) - carried_(i + 1, j) - side + groove;
      if (j + 1 < J_) carry(a, p, place(i, j + 1), up);
      if (i + 1 < N_) carry(a, p, place(i + 1, j), carried_(i + 1, j));
    }
  }
  for (Index j = 0; j < J_; ++j) {
    const Index first = place(0, j), last = place(N_ - 1, j);
    const double in = carried_(0, j);
    a(first, first) -= std::min(in, 0.0);
    x_(first, of_inlet) += std::max(in, 0.0);
    const double out = carried_(N_, j);
    a(last, last) += std::max(out, 0.0);
    x_(last, of_sides) -= std::min(out, 0.0);
  }
}

void PadHeat::add_loss(Index i) {
  const double H = h(i), viscosity = eta(i), R = film_.radius, L = film_.length;
  const TurbulentFactors<double> f = factors(H, viscosity);
  const double pushed = H * H * slope(i) / (2.0 * viscosity * f.along * R);
  const double of_flow = 12.0 / film_.source * pushed * pushed * f.along;
  // as int (1 - 2 zeta)^2 dzeta = 1/3
  const double P = pressure(i);
  const double across = 3.0 * H * H * H * H * P * P * film_.leakage /
                        (L * L * film_.source * viscosity * viscosity * f.across);
  const double unit = viscosity / H * L * dx_;
  const double dragged = speed_ * speed_ * f.shear * wet(i);
  VecX loss(J_);
  for (Index j = 0; j < J_; ++j) {
    const double z0 = edge_[j], z1 = edge_[j + 1];
    const auto odd = [](double z) { return z - z * z; };                          // int (1 - 2 z)
    const auto even = [](double z) { return std::pow(2.0 * z - 1.0, 3) / 6.0; };  // int (1 - 2 z)^2
    loss[j] = unit * (dragged * (z1 - z0) - 2.0 * speed_ * pushed * (odd(z1) - odd(z0)) +
                      (of_flow + across) * (even(z1) - even(z0)));
  }
  // on a grid the loss is known, and goes across the film as that of the mean over the length does
  if (on_grid()) loss *= std::abs(field_.lost[at(i + 1)] - field_.lost[at(i)]) / loss.sum();
  for (Index j = 0; j < J_; ++j)
    x_(place(i, j), of_loss) += loss[j];
  heat_ += loss.sum();
  if (!on_grid() && !film_.mass_conserving)
    gaps_ += unit * speed_ * speed_ * f.shear * (1.0 - wet(i));
}

void PadHeat::add_wall(Band& a) {
  const double t = wall_ / static_cast<double>(M_), L = film_.length, k = s_.wall_conductivity;
  const double across = k * L * dx_ / t, along = k * L * t / dx_;
  conducted_.resize(N_);
  const auto lose = [&](Index p, double area, double half) {
    const double by = 1.0 / (1.0 / (s_.back_coefficient * area) + half);
    a(p, p) += by;
    x_(p, of_surroundings) += by;
  };
  for (Index i = 0; i < N_; ++i) {
    for (Index m = 0; m < M_; ++m) {
      if (m + 1 < M_) conduct(a, wall_place(i, m), wall_place(i, m + 1), across);
      if (i + 1 < N_) conduct(a, wall_place(i, m), wall_place(i + 1, m), along);
      if (i == 0 || i + 1 == N_) lose(wall_place(i, m), L * t, 0.5 / along);
    }
    lose(wall_place(i, 0), L * dx_, 0.5 / across);
    conducted_[i] = 1.0 / (1.0 / to_face_[i] + 0.5 / across);
    conduct(a, wall_place(i, M_ - 1), place(i, 0), conducted_[i]);
  }
}

PadTemperatures PadHeat::temperatures(const Affine& of) const {
  const VecX T = x_ * of;
  PadTemperatures out;
  out.in = of[of_inlet];
  out.out = outlet().dot(of);
  out.to_journal = into_journal().dot(of);
  out.to_pad = into_pad().dot(of);
  out.heat = loss();
  out.film_coldest = infinity;
  out.hottest = out.film_hottest = -infinity;
  const double across =
      M_ > 0 ? s_.wall_conductivity * film_.length * dx_ * static_cast<double>(M_) / wall_ : 0.0;
  out.carried = gaps_ - groove_.sum() * out.in;
  double mean = 0.0, lean = 0.0;
  for (Index i = 0; i < N_; ++i) {
    double film = 0.0, fluidity = 0.0;
    for (Index j = 0; j < J_; ++j) {
      const double here = T[place(i, j)];
      film += width(j) * here;
      fluidity += width(j) / s_.viscosity_near(here);
      out.film_hottest = std::max(out.film_hottest, here);
      out.film_coldest = std::min(out.film_coldest, here);
    }
    double face = T[place(i, 0)];
    if (M_ > 0) {
      const double g = to_face_[i], wall = T[wall_place(i, M_ - 1)];
      face = (g * face + 2.0 * across * wall) / (g + 2.0 * across);
    }
    const double theta = 0.5 * (field_.theta[at(i)] + field_.theta[at(i + 1)]);
    if (face > out.hottest) {
      out.hottest = face;
      out.hottest_at = theta;
    }
    out.theta.push_back(theta);
    out.face.push_back(face);
    out.film.push_back(film);
    out.viscosity.push_back(1.0 / fluidity);
    for (Index m = 0; m < M_; ++m) {
      const double share = 1.0 / static_cast<double>(M_ * N_),
                   place_m = (static_cast<double>(m) + 0.5) / static_cast<double>(M_) - 0.5;
      mean += share * T[wall_place(i, m)];
      lean += share * T[wall_place(i, m)] * place_m;
    }
    for (Index j = 0; j < J_; ++j) {
      out.carried +=
          side_[i] * share_beside(i, j) * (side_[i] > 0.0 ? T[place(i, j)] : of[of_sides]);
    }
  }
  for (Index j = 0; j < J_; ++j) {
    out.carried += carried_(N_, j) * (carried_(N_, j) > 0.0 ? T[place(N_ - 1, j)] : of[of_sides]);
    out.carried -= carried_(0, j) * (carried_(0, j) > 0.0 ? out.in : T[place(0, j)]);
  }
  out.pad = M_ > 0 ? mean : of[of_surroundings];
  out.through = 12.0 * lean;  // of the straight line with that moment
  if (!forward_)
    for (auto* x : {&out.theta, &out.face, &out.film, &out.viscosity})
      std::reverse(x->begin(), x->end());
  return out;
}

/// In the order in which the oil meets them.
std::vector<std::size_t> downstream(std::span<const HeatPad> pads) {
  std::vector<std::size_t> order(pads.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto start = [&](std::size_t k) {
    const double a = pads[k].film->surface->arcs()[pads[k].pad].start;
    return a - two_pi * std::floor(a / two_pi);
  };
  const bool forward = pads[0].point.slip >= 0.0;
  std::sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
    return forward ? start(x) < start(y) : start(x) > start(y);
  });
  return order;
}

/// Everything as warm as the oil that is fed: at rest.
PadTemperatures at_rest(const HeatPad& pad, const HeatSettings& s) {
  PadTemperatures t;
  const double T = s.supply_temperature;
  t.in = t.out = t.hottest = t.film_hottest = t.film_coldest = t.pad = T;
  const JournalSurface::Arc& arc = pad.film->surface->arcs()[pad.pad];
  const double n = static_cast<double>(s.cells);
  for (std::size_t i = 0; i < s.cells; ++i)
    t.theta.push_back(arc.start + arc.length * (static_cast<double>(i) + 0.5) / n);
  t.hottest_at = t.theta.front();
  t.face.assign(s.cells, T);
  t.film = t.face;
  t.viscosity.assign(s.cells, s.viscosity_near(T));
  return t;
}

void find_growth(HeatBalance& b, std::span<const HeatPad> pads, const HeatSettings& s) {
  double bush = 0.0, inlet = 0.0;
  for (const PadTemperatures& t : b.pads) {
    bush += t.pad / static_cast<double>(b.pads.size());
    inlet += t.in / static_cast<double>(b.pads.size());
  }
  const double from = s.assembly_temperature;
  const double about = std::isnan(s.supply_flow) ? inlet : b.bath;
  const double housing = std::isnan(s.housing_temperature) ? about : s.housing_temperature;
  for (std::size_t k = 0; k < pads.size(); ++k) {
    const double R = pads[k].film->radius, clearance = pads[k].film->surface->clearance();
    const double shaft = R * s.shaft_expansion * (b.journal - from);
    const double t = pads[k].thickness_at_pivot;
    double assembled = R * s.pad_expansion * (bush - from) - shaft, own = assembled;
    if (!std::isnan(t)) {
      const double pad = s.pad_expansion * (b.pads[k].pad - from);
      assembled = (R + t) * s.housing_expansion * (housing - from) - t * pad - shaft;
      own = R * pad - shaft;
      const double wall = wall_of(pads[k], s);
      if (wall > 0.0) own += R * R * s.pad_expansion * b.pads[k].through / wall;
    }
    b.growth.push_back(assembled / clearance);
    b.pad_growth.push_back(own / clearance);
  }
}

/// What enters a pad.
struct Groove {
  double hot = 0, fresh = 0, bath = 0;  ///< shares: T_in of T_out of the pad before, T_s, T_b
  double passed = 0;                    ///< rho c times oil of the film before, W/K
};

class BearingHeat {
 public:
  BearingHeat(std::span<const HeatPad> pads, const HeatSettings& s)
      : s_(s),
        own_housing_(!std::isnan(s.housing_temperature)),
        given_(!std::isnan(s.supply_flow)),
        fed_(s.density * s.specific_heat * s.supply_flow) {
    heat_.reserve(pads.size());
    for (const std::size_t k : downstream(pads))
      heat_.emplace_back(pads[k], s);
    for (std::size_t k = 0; k < heat_.size(); ++k)
      grooves_.push_back(groove(k));
  }
  /// Pads in that order.
  HeatBalance solve();

 private:
  /// A temperature: an unknown, or known.
  struct Source {
    Index unknown = -1;
    double known = 0;
  };
  std::size_t before(std::size_t k) const { return (k + heat_.size() - 1) % heat_.size(); }
  Index journal() const { return static_cast<Index>(heat_.size()); }
  Index bath() const { return journal() + 1; }
  Source beside(Index pad) const {
    if (given_) return {bath(), 0.0};
    return s_.flooded ? Source{pad, 0.0} : Source{-1, s_.supply_temperature};
  }
  Source behind(Index pad) const {
    if (own_housing_) return {-1, s_.housing_temperature};
    return {given_ ? bath() : pad, 0.0};
  }
  Groove groove(std::size_t k) const;
  void add(Index row, double factor, const Affine& x, std::size_t pad);
  void add_bath();
  void add_flows(HeatBalance& b) const;

  const HeatSettings& s_;
  bool own_housing_, given_;
  double fed_;  ///< rho c times the supply, W/K
  std::vector<PadHeat> heat_;
  std::vector<Groove> grooves_;
  MatX A_;  ///< of what enters each pad, the journal and, where it is predicted, the bath
  VecX b_;
};

Groove BearingHeat::groove(std::size_t k) const {
  const double in = heat_[k].inflow(), out = heat_[before(k)].outflow();
  const auto part = [in](double flow) { return flow < in ? flow / in : 1.0; };
  Groove g;
  if (s_.flooded && given_) {
    g.hot = part(s_.carry_over * out);
    g.bath = 1.0 - g.hot;
  } else if (s_.flooded) {
    g.hot = s_.carry_over;
    g.fresh = 1.0 - g.hot;
  } else {
    g.hot = std::min(s_.carry_over, part(out));
    g.fresh = 1.0 - g.hot;
    if (given_) g.fresh = std::min(g.fresh, part(fed_ / static_cast<double>(heat_.size())));
    g.bath = 1.0 - g.hot - g.fresh;
  }
  g.passed = std::min(g.hot * in, out);
  return g;
}

void BearingHeat::add(Index row, double factor, const Affine& x, std::size_t pad) {
  const Index own = static_cast<Index>(pad);
  b_[row] -= factor * x[of_loss];
  A_(row, journal()) += factor * x[of_journal];
  A_(row, own) += factor * x[of_inlet];
  const auto from = [&](double by, const Source& source) {
    if (source.unknown >= 0)
      A_(row, source.unknown) += factor * by;
    else
      b_[row] -= factor * by * source.known;
  };
  from(x[of_sides], beside(own));
  from(x[of_surroundings], behind(own));
}

/// Energy of all that is within the housing.
void BearingHeat::add_bath() {
  const Index row = bath();
  A_(row, row) += 1.0;
  b_[row] += s_.supply_temperature;
  for (std::size_t k = 0; k < heat_.size(); ++k) {
    b_[row] += heat_[k].loss() / fed_;
    if (own_housing_) add(row, 1.0 / fed_, heat_[k].into_pad(), k);
  }
}

HeatBalance BearingHeat::solve() {
  const std::size_t n = heat_.size();
  const Index size = journal() + (given_ ? 2 : 1);
  A_ = MatX::Zero(size, size);
  b_ = VecX::Zero(size);
  for (std::size_t k = 0; k < n; ++k) {
    const Index row = static_cast<Index>(k);
    const Groove& g = grooves_[k];
    A_(row, row) += 1.0;
    b_[row] += g.fresh * s_.supply_temperature;
    if (given_) A_(row, bath()) -= g.bath;
    add(row, -g.hot, heat_[before(k)].outlet(), before(k));
    add(journal(), 1.0, heat_[k].into_journal(), k);
  }
  if (given_) add_bath();
  const VecX T = la::DenseLu<double>(A_).solve(b_);
  const auto value = [&](const Source& x) { return x.unknown >= 0 ? T[x.unknown] : x.known; };
  HeatBalance out;
  out.journal = T[journal()];
  if (given_) out.bath = T[bath()];
  for (std::size_t k = 0; k < n; ++k) {
    const Index own = static_cast<Index>(k);
    Affine of;
    of[of_loss] = 1.0;
    of[of_journal] = out.journal;
    of[of_inlet] = T[own];
    of[of_surroundings] = value(behind(own));
    of[of_sides] = value(beside(own));
    out.pads.push_back(heat_[k].temperatures(of));
    const double warm_sides = heat_[k].taken_in() * (of[of_sides] - s_.supply_temperature);
    out.pads[k].returned = warm_sides;
    out.pads[k].to_oil = out.pads[k].carried + warm_sides;
  }
  add_flows(out);
  return out;
}

/// What passes from pad to pad, and what does not.
void BearingHeat::add_flows(HeatBalance& b) const {
  double leaves = 0.0, warm = 0.0, returned = 0.0;
  for (std::size_t k = 0; k < heat_.size(); ++k) {
    PadTemperatures &pad = b.pads[k], &from = b.pads[before(k)];
    const double in = heat_[k].inflow(), entered = in * (pad.in - s_.supply_temperature),
                 passed = grooves_[k].passed * (from.out - s_.supply_temperature);
    pad.hot_share = in > 0.0 ? grooves_[k].passed / in : 0.0;
    if (s_.flooded || given_) pad.returned += entered - passed;
    pad.to_oil += entered;
    from.to_oil -= passed;
    pad.beyond = in + heat_[k].taken_in() - grooves_[k].passed;
    if ((s_.flooded || given_) && pad.beyond > 1e-9 * in)
      pad.beyond_at = s_.supply_temperature + pad.returned / pad.beyond;
    leaves += pad.beyond;
    returned += pad.returned;
  }
  if (!s_.flooded && !given_) return;
  for (const PadTemperatures& t : b.pads)
    warm += t.to_oil;
  b.mixed = s_.supply_temperature + warm / leaves;
  if (!given_) b.bath = s_.supply_temperature + returned / leaves;
}

HeatBalance balance_at_rest(std::span<const HeatPad> pads, const HeatSettings& s) {
  HeatBalance out;
  out.journal = s.supply_temperature;
  for (const HeatPad& p : pads)
    out.pads.push_back(at_rest(p, s));
  if (s.flooded || !std::isnan(s.supply_flow)) out.bath = out.mixed = s.supply_temperature;
  return out;
}

HeatBalance balance_on_grid(std::span<const HeatPad> pads, const HeatSettings& s) {
  HeatBalance out;
  if (pads[0].point.slip == 0.0) {
    out = balance_at_rest(pads, s);
  } else {
    HeatBalance along = BearingHeat(pads, s).solve();
    const std::vector<std::size_t> order = downstream(pads);
    out = along;
    for (std::size_t k = 0; k < order.size(); ++k)
      out.pads[order[k]] = std::move(along.pads[k]);
  }
  find_growth(out, pads, s);
  return out;
}

/// That given, or what the bath stands for.
void find_supply_flow(HeatBalance& b, const HeatSettings& s) {
  b.supply_flow = s.supply_flow;
  if (!std::isnan(s.supply_flow) || !s.flooded) return;
  constexpr double least = 0.01;  // less is what the cells leave of side flows
  double heat = 0.0, returned = 0.0;
  for (const PadTemperatures& t : b.pads) {
    heat += t.heat - (std::isnan(s.housing_temperature) ? 0.0 : t.to_pad);
    returned += t.returned;
  }
  const double warmer = b.bath - s.supply_temperature;
  if (heat > 0.0 && returned > least * heat)
    b.supply_flow = heat / (s.density * s.specific_heat * warmer);
}

/// fine + share (fine - coarse) of what stands at cells, those of `coarse` twice as wide.
void extrapolate(std::vector<double>& fine, const std::vector<double>& coarse, double share) {
  WHIRL_EXPECTS(fine.size() == 2 * coarse.size() && coarse.size() >= 2);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const double place = 0.5 * static_cast<double>(i) - 0.25;  // among the coarse ones
    const double last = static_cast<double>(coarse.size() - 2);
    const double below = std::clamp(std::floor(place), 0.0, last);
    const std::size_t k = static_cast<std::size_t>(below);
    fine[i] += share * (fine[i] - std::lerp(coarse[k], coarse[k + 1], place - below));
  }
}

void extrapolate(PadTemperatures& fine, const PadTemperatures& coarse, double share) {
  for (double PadTemperatures::*x :
       {&PadTemperatures::in, &PadTemperatures::out, &PadTemperatures::hottest,
        &PadTemperatures::film_hottest, &PadTemperatures::film_coldest, &PadTemperatures::pad,
        &PadTemperatures::through, &PadTemperatures::to_pad, &PadTemperatures::to_journal,
        &PadTemperatures::heat, &PadTemperatures::carried, &PadTemperatures::to_oil,
        &PadTemperatures::returned, &PadTemperatures::hot_share, &PadTemperatures::beyond,
        &PadTemperatures::beyond_at})
    fine.*x += share * (fine.*x - coarse.*x);
  extrapolate(fine.face, coarse.face, share);
  extrapolate(fine.film, coarse.film, share);
  const auto logarithms = [](std::vector<double> x) {
    for (double& value : x)
      value = std::log(value);
    return x;
  };
  std::vector<double> viscosity = logarithms(fine.viscosity);
  extrapolate(viscosity, logarithms(coarse.viscosity), share);
  for (std::size_t i = 0; i < viscosity.size(); ++i)
    fine.viscosity[i] = std::exp(viscosity[i]);
}

/// An error of first order goes with a share of 1, one of second order with 1/3, ..
void extrapolate(HeatBalance& fine, const HeatBalance& coarse, double share) {
  for (std::size_t k = 0; k < fine.pads.size(); ++k) {
    extrapolate(fine.pads[k], coarse.pads[k], share);
    fine.growth[k] += share * (fine.growth[k] - coarse.growth[k]);
    fine.pad_growth[k] += share * (fine.pad_growth[k] - coarse.pad_growth[k]);
  }
  for (double HeatBalance::*x : {&HeatBalance::journal, &HeatBalance::bath, &HeatBalance::mixed})
    fine.*x += share * (fine.*x - coarse.*x);
}

/// Temperatures so far apart on two grids say nothing of a third.
bool resolved(const HeatBalance& fine, const HeatBalance& coarse, double supply) {
  constexpr double most = 0.5, least = 1.0;  // of the rise; K
  for (std::size_t k = 0; k < fine.pads.size(); ++k) {
    const double hottest = fine.pads[k].film_hottest;
    if (!(std::abs(hottest - coarse.pads[k].film_hottest) <=
          most * std::abs(hottest - supply) + least))
      return false;
  }
  return true;
}

HeatSettings halved(HeatSettings s) {
  for (std::size_t* n : {&s.cells, &s.wall_layers}) {
    WHIRL_EXPECTS(*n % 2 == 0);
    *n /= 2;
  }
  return s;
}

}  // namespace

HeatSettings finer_settings(const HeatSettings& s) {
  HeatSettings fine = s;
  for (std::size_t* n : {&fine.cells, &fine.layers, &fine.wall_layers})
    *n *= 2;
  fine.grids = 3;
  return fine;
}

namespace {

HeatBalance extrapolated_balance(std::span<const HeatPad> pads, const HeatSettings& s) {
  std::vector<HeatBalance> found;
  HeatSettings grid = s;
  for (std::size_t k = 0; k < s.grids; ++k) {
    if (k > 0) grid = halved(grid);
    found.push_back(balance_on_grid(pads, grid));
    if (k > 0 && !resolved(found[k - 1], found[k], s.supply_temperature))
      return std::move(found.front());
  }
  double share = 1.0;
  for (std::size_t order = 1; order < s.grids; ++order, share = share / (2.0 + share))
    for (std::size_t k = 0; k + order < s.grids; ++k)
      extrapolate(found[k], found[k + 1], share);
  return std::move(found.front());
}

}  // namespace

HeatBalance balance_heat(std::span<const HeatPad> pads, const HeatSettings& s) {
  WHIRL_EXPECTS(!pads.empty() && s.grids >= 1 && !(s.supply_flow <= 0.0));
  HeatBalance out = extrapolated_balance(pads, s);
  find_supply_flow(out, s);
  return out;
}

void keep_heat(const HeatBalance& b, std::size_t k, const HeatPad& pad, std::span<double> values) {
  WHIRL_EXPECTS(k < b.pads.size());
  const FiniteJournal& film = *pad.film;
  WHIRL_EXPECTS(values.size() == static_cast<std::size_t>(film.kept_each()));
  const double own = film.surface->pad_clearance() / film.surface->clearance();
  values[0] = std::max(b.growth[k], least_clearance - 1.0);
  values[1] = std::max(b.pad_growth[k], least_clearance - own);
  const JournalSurface::Arc& arc = film.surface->arcs()[pad.pad];
  const std::vector<double>&theta = b.pads[k].theta, &eta = b.pads[k].viscosity;
  const std::size_t n = theta.size();
  const double first = theta[0], step = theta[1] - theta[0];
  for (int i = 0; i < film.knots; ++i) {
    const double at_knot = arc.start + arc.length * i / (film.knots - 1);
    const double x = (at_knot - first) / step;
    const std::size_t cell =
        static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, static_cast<double>(n - 2)));
    const double s = x - static_cast<double>(cell);
    values[static_cast<std::size_t>(i) + 2] = (1.0 - s) * std::log(eta[cell] / film.viscosity) +
                                              s * std::log(eta[cell + 1] / film.viscosity);
  }
}

}  // namespace whirl::elements
