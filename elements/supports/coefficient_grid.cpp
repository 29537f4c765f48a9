#include <elements/supports/coefficient_grid.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <elements/supports/monotone_slopes.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

/// The interval of x around a value (inside), and the four cubic (or two linear) weights of value
/// and slope at its ends with derivatives.
struct Hermite {
  std::size_t i = 0;
  double value[4] = {1, 0, 0, 0}, rate[4] = {0, 0, 0, 0};  // f_i, f_i+1, f'_i, f'_i+1
  Hermite(const std::vector<double>& x, double at, bool cubic) {
    if (x.size() < 2) return;
    i = std::clamp<std::size_t>(
            static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), at) - x.begin()), 1,
            x.size() - 1) -
        1;
    const double h = x[i + 1] - x[i], u = (at - x[i]) / h;
    if (!cubic) {
      value[0] = 1 - u;
      value[1] = u;
      rate[0] = -1 / h;
      rate[1] = 1 / h;
      return;
    }
    value[0] = (1 + 2 * u) * (1 - u) * (1 - u);
    value[1] = u * u * (3 - 2 * u);
    value[2] = h * u * (1 - u) * (1 - u);
    value[3] = -h * u * u * (1 - u);
    rate[0] = -6 * u * (1 - u) / h;
    rate[1] = -rate[0];
    rate[2] = (1 - u) * (1 - 3 * u);
    rate[3] = u * (3 * u - 2);
  }
};

/// Three-point derivatives of rows y at x, one-sided at the ends.
template <class Row>
std::vector<Row> differences(const std::vector<double>& x, const std::vector<Row>& y) {
  const std::size_t n = x.size();
  std::vector<Row> d(n, Row::Zero());
  if (n < 2) return d;
  const auto chord = [&](std::size_t i) { return Row((y[i + 1] - y[i]) / (x[i + 1] - x[i])); };
  if (n == 2) return {chord(0), chord(0)};
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
    d[i] = (h1 * chord(i - 1) + h0 * chord(i)) / (h0 + h1);
  }
  d[0] = 2 * chord(0) - d[1];
  d[n - 1] = 2 * chord(n - 2) - d[n - 2];
  return d;
}

}  // namespace

template <int N>
CoefficientGrid<N>::CoefficientGrid(std::vector<double> spin, std::vector<double> frequency,
                                    const std::vector<Values>& rows, Between between,
                                    Outside outside)
    : spin_(std::move(spin)),
      frequency_(std::move(frequency)),
      between_(between),
      outside_(outside) {
  const auto fail = [](const char* what) {
    throw run_error("E81", std::string("bearing table: ") + what);
  };
  if (spin_.empty() || frequency_.empty()) fail("it has no rows");
  if (rows.size() != spin_.size() * frequency_.size())
    fail("every speed needs a row for every frequency");
  for (std::size_t i = 1; i < spin_.size(); ++i)
    if (!(spin_[i] > spin_[i - 1])) fail("speeds must increase from row to row");
  for (std::size_t i = 0; i < frequency_.size(); ++i)
    if (!(frequency_[i] > (i ? frequency_[i - 1] : -1e-300)))
      fail("frequencies must increase from row to row and not be negative");
  for (const Values& v : rows) {
    Node n{};
    n.f = v.row();
    if (!n.f.isFinite().all()) fail("a coefficient is not finite");
    n.f_s = n.f_w = n.f_sw = Row::Zero();
    has_mass_ = has_mass_ || !v.M.isZero(0.0);
    nodes_.push_back(n);
  }
  if (between_ == Between::linear) return;
  const std::size_t S = spin_.size(), W = frequency_.size();
  std::vector<Row> line;
  const auto along_spin = [&](std::size_t j, auto read, auto slopes, auto write) {
    line.clear();
    for (std::size_t i = 0; i < S; ++i)
      line.push_back(read(nodes_[i * W + j]));
    const auto d = slopes(spin_, line);
    for (std::size_t i = 0; i < S; ++i)
      write(nodes_[i * W + j], d[i]);
  };
  const auto along_frequency = [&](std::size_t i, auto read, auto slopes, auto write) {
    line.clear();
    for (std::size_t j = 0; j < W; ++j)
      line.push_back(read(nodes_[i * W + j]));
    const auto d = slopes(frequency_, line);
    for (std::size_t j = 0; j < W; ++j)
      write(nodes_[i * W + j], d[j]);
  };
  const auto value = [](const Node& n) { return n.f; };
  for (std::size_t j = 0; j < W; ++j)
    along_spin(j, value, monotone_slopes<Row>, [](Node& n, const Row& d) { n.f_s = d; });
  for (std::size_t i = 0; i < S; ++i)
    along_frequency(i, value, monotone_slopes<Row>, [](Node& n, const Row& d) { n.f_w = d; });
  for (std::size_t i = 0; i < S; ++i)
    along_frequency(
        i, [](const Node& n) { return n.f_s; }, differences<Row>,
        [](Node& n, const Row& d) { n.f_sw += 0.5 * d; });
  for (std::size_t j = 0; j < W; ++j)
    along_spin(
        j, [](const Node& n) { return n.f_w; }, differences<Row>,
        [](Node& n, const Row& d) { n.f_sw += 0.5 * d; });
}

template <int N>
void CoefficientGrid<N>::at(double s, double w, Values& v, Values& ds, Values& dw) const {
  WHIRL_EXPECTS(!nodes_.empty());
  const double s_in = std::clamp(s, spin_.front(), spin_.back()),
               w_in = std::clamp(w, frequency_.front(), frequency_.back());
  const bool cubic = between_ == Between::monotone_cubic;
  const Hermite a(spin_, s_in, cubic), b(frequency_, w_in, cubic);
  Row x[3] = {Row::Zero(), Row::Zero(), Row::Zero()};
  for (std::size_t p = 0; p < 2 && a.i + p < spin_.size(); ++p)
    for (std::size_t q = 0; q < 2 && b.i + q < frequency_.size(); ++q) {
      const Node& n = node(a.i + p, b.i + q);
      const auto sum = [&](const double* l, const double* r) {
        return Row((l[p] * r[q]) * n.f + (l[2 + p] * r[q]) * n.f_s + (l[p] * r[2 + q]) * n.f_w +
                   (l[2 + p] * r[2 + q]) * n.f_sw);
      };
      x[0] += sum(a.value, b.value);
      x[1] += sum(a.rate, b.value);
      x[2] += sum(a.value, b.rate);
    }
  if (outside_ == Outside::undefined) {
    // beyond the end by rounding is at the end, as in CoefficientTable
    const auto beyond = [](double asked, double inside, const std::vector<double>& grid) {
      return std::abs(asked - inside) >
             1e-9 * std::max(std::abs(grid.front()), std::abs(grid.back()));
    };
    if (beyond(s, s_in, spin_) || beyond(w, w_in, frequency_))
      for (Row& r : x)
        r.setConstant(nan);
  } else {
    if (s != s_in) x[1].setZero();  // held
    if (w != w_in) x[2].setZero();
  }
  v.set(x[0]);
  ds.set(x[1]);
  dw.set(x[2]);
}

template <int N>
bool CoefficientGrid<N>::resists(int motion) const {
  WHIRL_EXPECTS(motion >= 0 && motion < N);
  return std::any_of(nodes_.begin(), nodes_.end(), [motion](const Node& n) {
    return (Values::stiffness(n.f, motion) != 0.0).any();
  });
}

template <int N>
bool CoefficientGrid<N>::damps(int motion) const {
  WHIRL_EXPECTS(motion >= 0 && motion < N);
  return std::any_of(nodes_.begin(), nodes_.end(), [motion](const Node& n) {
    return (Values::damping(n.f, motion) != 0.0).any();
  });
}

template <int N>
void CoefficientGrid<N>::at(double s, double asked, Values& v, Values& dv) const {
  Values dw;
  if (!std::isnan(asked)) return at(s, asked, v, dv, dw);
  const double w = std::clamp(std::abs(s), frequency_.front(), frequency_.back());
  at(s, w, v, dv, dw);
  if (w != std::abs(s)) return;
  const double along = s < 0 ? -1.0 : 1.0;
  dv.K += along * dw.K;
  dv.C += along * dw.C;
  dv.M += along * dw.M;
}

template class CoefficientGrid<2>;
template class CoefficientGrid<6>;

}  // namespace whirl::elements
