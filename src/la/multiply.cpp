#include <la/lu_kernel.hpp>
#include <core/contract.hpp>
#include <la/multiply.hpp>
#include <la/step_products.hpp>

namespace whirl::la {

namespace {
lu::Matrix6 view(const BlockMatrix<6>& a) {
  const BlockPattern& p = a.pattern();
  return {p.size(), p.row_start().data(), p.cols().data(), a.data()};
}
}  // namespace

void multiply(const BlockMatrix<6>& a, const VecX& x, VecX& y) {
  WHIRL_EXPECTS(&x != &y);
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size());
  y.resize(x.size());
  lu::kernels().multiply_real(view(a), x.data(), y.data());
}

void multiply(const BlockMatrix<6>& a, const VecXc& x, VecXc& y) {
  WHIRL_EXPECTS(&x != &y);
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size());
  y.resize(x.size());
  lu::kernels().multiply_complex(view(a), reinterpret_cast<const double*>(x.data()),
                                 reinterpret_cast<double*>(y.data()));
}

void multiply_exact(const BlockMatrix<6>& a, const VecX& x, VecX& y) {
  WHIRL_EXPECTS(&x != &y);
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size());
  y.resize(x.size());
  lu::kernels().multiply_exact_real(view(a), x.data(), y.data());
}

void multiply_exact(const BlockMatrix<6>& a, const VecXc& x, VecXc& y) {
  WHIRL_EXPECTS(&x != &y);
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size());
  y.resize(x.size());
  lu::kernels().multiply_exact_complex(view(a), reinterpret_cast<const double*>(x.data()),
                                       reinterpret_cast<double*>(y.data()));
}

void multiply(const MCK& m, const VecXc& x, VecXc& Mx, VecXc& Cx, VecXc& Kx) {
  WHIRL_EXPECTS(x.size() == 6 * m.K.pattern().size());
  for (VecXc* y : {&Mx, &Cx, &Kx})
    y->resize(x.size());
  const double* const a[3] = {m.M.data(), m.C.data(), m.K.data()};
  double* const y[3] = {reinterpret_cast<double*>(Mx.data()), reinterpret_cast<double*>(Cx.data()),
                        reinterpret_cast<double*>(Kx.data())};
  lu::kernels().multiply_three(view(m.K), a, reinterpret_cast<const double*>(x.data()), y);
}

void add_multiply(const BlockMatrix<6>& a, double s, const Eigen::Ref<const VecX>& x,
                  Eigen::Ref<VecX> y) {
  WHIRL_EXPECTS(x.data() != y.data());
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size() && y.size() == x.size());
  const double *const values = a.data(), *const vector = x.data();
  lu::kernels().add_products(view(a), 1, &values, &vector, s, y.data());
}

void add_forces(const MCK& m, const VecX& q, const VecX& v, const VecX& a, Eigen::Ref<VecX> y) {
  WHIRL_EXPECTS(y.size() == 6 * m.K.pattern().size());
  WHIRL_EXPECTS(q.size() == y.size() && v.size() == y.size() && a.size() == y.size());
  const double* const values[] = {m.K.data(), m.C.data(), m.M.data()};
  const double* const vectors[] = {q.data(), v.data(), a.data()};
  lu::kernels().add_products(view(m.K), 3, values, vectors, 1.0, y.data());
}

void add_forces(const MCK& m, const VecX& q, const VecX& v, Eigen::Ref<VecX> y) {
  WHIRL_EXPECTS(y.size() == 6 * m.K.pattern().size());
  WHIRL_EXPECTS(q.size() == y.size() && v.size() == y.size());
  const double* const values[] = {m.K.data(), m.C.data()};
  const double* const vectors[] = {q.data(), v.data()};
  lu::kernels().add_products(view(m.K), 2, values, vectors, 1.0, y.data());
}

void multiply(const MCK& m, const StepProducts& x) {
  WHIRL_EXPECTS(x.q.size() == 6 * m.K.pattern().size() && x.v.size() == x.q.size());
  WHIRL_EXPECTS(x.bound.size() == x.q.size() && x.filter.size() == x.q.size());
  const double* const values[] = {m.K.data(), m.C.data(), m.M.data()};
  const lu::StepVectors vectors{x.q.data(),          x.v.data(),         x.stiff_of.data(),
                                x.inertia_of.data(), x.filter_of.data(), x.shift,
                                x.bound.data(),      x.rate.data(),      x.stiff.data(),
                                x.inertia.data(),    x.filter.data()};
  lu::kernels().multiply_step(view(m.K), values, vectors);
}

void add_multiply_size(const BlockMatrix<6>& a, double s, const VecX& x, VecX& y) {
  WHIRL_EXPECTS(x.size() == 6 * a.pattern().size());
  y.resize(x.size());
  lu::kernels().add_multiply_size(view(a), s, x.data(), y.data());
}

}  // namespace whirl::la
