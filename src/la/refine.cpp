#include <la/refine.hpp>

namespace whirl::la {

template <class Scalar>
Refinement<Scalar>::Refinement(const BlockPattern& pattern, std::span<const unsigned char> active)
    : active_(active.begin(), active.end()),
      residual_(6 * pattern.size()),
      size_(6 * pattern.size()) {}

template <class Scalar>
double Refinement<Scalar>::backward_error(const MCK& m, Scalar cm, Scalar cc, Scalar ck,
                                          const Vec& x, const Vec& b) {
  const BlockPattern& p = m.K.pattern();
  double worst = 0.0;
  for (Index i = 0; i < p.size(); ++i) {
    Eigen::Matrix<Scalar, 6, 1> r = b.template segment<6>(6 * i);
    Vector<6> s = r.cwiseAbs();
    for (Index k = p.row_start()[at(i)]; k < p.row_start()[at(i) + 1]; ++k) {
      const Index j = p.cols()[at(k)];
      for (int c = 0; c < 6; ++c) {
        if (!active_[at(6 * j + c)]) continue;
        const Scalar xc = x(6 * j + c);
        Eigen::Matrix<Scalar, 6, 1> col = Eigen::Matrix<Scalar, 6, 1>::Zero();
        if (cm != Scalar(0.0)) col += cm * m.M.block(k).col(c);
        if (cc != Scalar(0.0)) col += cc * m.C.block(k).col(c);
        if (ck != Scalar(0.0)) col += ck * m.K.block(k).col(c);
        r -= col * xc;
        s += col.cwiseAbs() * std::abs(xc);
      }
    }
    for (int c = 0; c < 6; ++c) {
      const Index u = 6 * i + c;
      residual_(u) = active_[at(u)] ? r(c) : b(u) - x(u);
      if (!active_[at(u)] || residual_(u) == Scalar(0.0)) continue;
      const double e = std::abs(r(c)) / s(c);
      if (!(e <= worst)) worst = e;
    }
  }
  return worst;
}

template <class Scalar>
void Refinement<Scalar>::correct(DirectSolver<Scalar>& solver, Vec& x) {
  solver.solve(residual_);
  x += residual_;
}

template <class Scalar>
double Refinement<Scalar>::refine(DirectSolver<Scalar>& solver, const MCK& m, Scalar cm, Scalar cc,
                                  Scalar ck, const Vec& b, Vec& x, int steps, double goal) {
  double error = backward_error(m, cm, cc, ck, x, b);
  for (int k = 0; k < steps && !(error <= goal); ++k) {
    correct(solver, x);
    error = backward_error(m, cm, cc, ck, x, b);
  }
  return error;
}

template class Refinement<double>;
template class Refinement<Complex>;

}  // namespace whirl::la
