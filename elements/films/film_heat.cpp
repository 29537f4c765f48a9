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
/// enters, the oil about the pad.
enum Cause : Index { of_loss, of_journal, of_inlet, of_surroundings, causes };
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
    // finer at the walls, where oil conducts badly
    for (Index j = 0; j <= J_; ++j)
      edge_[j] = 0.5 * (1.0 - std::cos(pi * static_cast<double>(j) / static_cast<double>(J_)));
    dx_ = film_.radius * std::abs(field_.theta[1] - field_.theta[0]);
    Band a(x_.rows(), M_ + J_);
    add_film(a);
    // where films begin and end between faces, these see it by the step
    if (conserves()) turn_into_heat(film_loss(film_, pad.pad, pad.point));
    if (M_ > 0) add_wall(a);
    a.solve(x_);
  }

  double inflow() const { return std::max(0.0, field_.flow.front()); }
  double outflow() const { return std::max(0.0, field_.flow.back()); }
  /// Of the oil that leaves at the end of the pad.
  Affine outlet() const {
    Affine sum = Affine::Zero();
    double flow = 0.0;
    for (Index j = 0; j < J_; ++j) {
      const double m = std::max(0.0, carried_(N_, j));
      sum += m * cell(N_ - 1, j);
      flow += m;
    }
    return sum / flow;
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
  PadTemperatures temperatures(const Affine& of) const;

 private:
  Affine cell(Index i, Index j) const { return x_.row(place(i, j)).transpose(); }
  Index place(Index i, Index j) const { return i * (M_ + J_) + M_ + j; }
  Index wall_place(Index i, Index m) const { return i * (M_ + J_) + m; }
  double width(Index j) const { return edge_[j + 1] - edge_[j]; }
  void turn_round() {
    for (auto* x : {&field_.theta, &field_.thickness, &field_.pressure, &field_.slope,
                    &field_.viscosity, &field_.flow, &field_.filled, &field_.lost, &field_.gap,
                    &field_.conducting, &field_.share, &field_.wetted})
      std::reverse(x->begin(), x->end());
    std::reverse(field_.wet.begin(), field_.wet.end());
    for (auto* x : {&field_.slope, &field_.flow, &field_.filled})
      for (double& value : *x)
        value = -value;
  }
  bool on_grid() const { return !field_.lost.empty(); }
  bool conserves() const { return !field_.share.empty(); }
  /// At face i: film thickness; of recesses the mean over the length.
  double face_gap(Index i) const { return on_grid() ? field_.gap[at(i)] : field_.thickness[at(i)]; }
  double h(Index i) const { return 0.5 * (face_gap(i) + face_gap(i + 1)); }
  /// At face i: thickness times the share of the width through which oil flows.
  double flow_gap(Index i) const {
    return conserves() ? face_gap(i) * field_.share[at(i)] : face_gap(i);
  }
  /// Share of the width that oil wets, of a cell.
  double wet(Index i) const {
    if (!conserves()) return 1.0;
    return std::abs((field_.wetted[at(i + 1)] - field_.wetted[at(i)]) /
                    (field_.theta[at(i + 1)] - field_.theta[at(i)]));
  }
  /// For conduction across the film, 1/m.
  double over_gap(Index i) const {
    if (!on_grid()) return wet(i) / h(i);
    return 0.5 * (field_.conducting[at(i)] + field_.conducting[at(i + 1)]);
  }
  /// h^2 P'/(2 eta f R) at a face, m/s: what the pressure drives back in the middle of the film, over
  /// 1/4; on a grid, and where mass is conserved, with which the flow is right.
  double pushed_back(Index i) const {
    const double H = face_gap(i);
    if (on_grid()) return 3.0 * speed_ - 6.0 * field_.filled[at(i)] / (film_.length * H);
    if (conserves()) return 3.0 * speed_ - 6.0 * field_.flow[at(i)] / (film_.length * flow_gap(i));
    const double viscosity = field_.viscosity[at(i)];
    return H * H * field_.slope[at(i)] /
           (2.0 * viscosity * factors(H, viscosity).along * film_.radius);
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
  VecX side_;               ///< rho c times what leaves at the sides, one a cell, W/K
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
  side_.resize(N_);
  for (Index i = 0; i < N_; ++i) {
    side_[i] = carried_.row(i).sum() - carried_.row(i + 1).sum();
    double up = 0.0;
    for (Index j = 0; j < J_; ++j) {
      const Index p = place(i, j);
      const auto share = [&](double z) { return z * z * (3.0 - 2.0 * z); };
      const double side = side_[i] * (share(edge_[j + 1]) - share(edge_[j]));
      a(p, p) += side;
      up += carried_(i, j) - carried_(i + 1, j) - side;
      if (j + 1 < J_) carry(a, p, place(i, j + 1), up);
      if (i + 1 < N_) carry(a, p, place(i + 1, j), carried_(i + 1, j));
    }
  }
  for (Index j = 0; j < J_; ++j) {
    const Index first = place(0, j), last = place(N_ - 1, j);
    const double in = carried_(0, j);
    a(first, first) -= std::min(in, 0.0);
    x_(first, of_inlet) += std::max(in, 0.0);
    a(last, last) += carried_(N_, j);  // what comes back at the end is as warm as it is there
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
}

void PadHeat::add_wall(Band& a) {
  const double t = wall_ / static_cast<double>(M_), L = film_.length, k = s_.wall_conductivity;
  const double across = k * L * dx_ / t, along = k * L * t / dx_;
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
    conduct(a, wall_place(i, M_ - 1), place(i, 0), 1.0 / (1.0 / to_face_[i] + 0.5 / across));
  }
}

PadTemperatures PadHeat::temperatures(const Affine& of) const {
  const VecX T = x_ * of;
  PadTemperatures out;
  out.in = of[of_inlet];
  out.out = outlet().dot(of);
  out.to_journal = into_journal().dot(of);
  out.heat = heat_;
  out.film_coldest = infinity;
  out.hottest = out.film_hottest = -infinity;
  const double across =
      M_ > 0 ? s_.wall_conductivity * film_.length * dx_ * static_cast<double>(M_) / wall_ : 0.0;
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
      out.to_pad += (face - wall) / (1.0 / g + 0.5 / across);
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
      const auto share = [&](double z) { return z * z * (3.0 - 2.0 * z); };
      out.carried += side_[i] * (share(edge_[j + 1]) - share(edge_[j])) * T[place(i, j)];
    }
  }
  for (Index j = 0; j < J_; ++j) {
    out.carried += carried_(N_, j) * T[place(N_ - 1, j)];
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
  const double housing = std::isnan(s.housing_temperature) ? inlet : s.housing_temperature;
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

HeatBalance balance_on_grid(std::span<const HeatPad> pads, const HeatSettings& s) {
  HeatBalance out;
  out.journal = s.supply_temperature;
  if (pads[0].point.slip == 0.0) {
    for (const HeatPad& p : pads)
      out.pads.push_back(at_rest(p, s));
    find_growth(out, pads, s);
    return out;
  }
  const std::vector<std::size_t> order = downstream(pads);
  const std::size_t n = pads.size();
  std::vector<PadHeat> heat;
  heat.reserve(n);
  for (const std::size_t k : order)
    heat.emplace_back(pads[k], s);
  // unknown: what enters each pad, and the journal
  const Index size = static_cast<Index>(n) + 1, journal = size - 1;
  MatX A = MatX::Zero(size, size);
  VecX b = VecX::Zero(size);
  const bool own_housing = !std::isnan(s.housing_temperature);
  const auto add = [&](Index row, double factor, const Affine& x, Index pad) {
    b[row] -= factor * x[of_loss];
    A(row, journal) += factor * x[of_journal];
    A(row, pad) += factor * x[of_inlet];
    if (own_housing)
      b[row] -= factor * x[of_surroundings] * s.housing_temperature;
    else
      A(row, pad) += factor * x[of_surroundings];
  };
  for (std::size_t k = 0; k < n; ++k) {
    const Index row = static_cast<Index>(k);
    const std::size_t before = (k + n - 1) % n;
    A(row, row) += 1.0;
    b[row] += (1.0 - s.carry_over) * s.supply_temperature;
    add(row, -s.carry_over, heat[before].outlet(), static_cast<Index>(before));
    add(journal, 1.0, heat[k].into_journal(), row);
  }
  const VecX T = la::DenseLu<double>(A).solve(b);
  out.journal = T[journal];
  out.pads.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    Affine of;
    of[of_loss] = 1.0;
    of[of_journal] = T[journal];
    of[of_inlet] = T[static_cast<Index>(k)];
    of[of_surroundings] = own_housing ? s.housing_temperature : of[of_inlet];
    out.pads[order[k]] = heat[k].temperatures(of);
  }
  find_growth(out, pads, s);
  return out;
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
        &PadTemperatures::heat, &PadTemperatures::carried})
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
  fine.journal += share * (fine.journal - coarse.journal);
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
  for (std::size_t* n : {&s.cells, &s.layers, &s.wall_layers}) {
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

HeatBalance balance_heat(std::span<const HeatPad> pads, const HeatSettings& s) {
  WHIRL_EXPECTS(!pads.empty() && s.grids >= 1);
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
