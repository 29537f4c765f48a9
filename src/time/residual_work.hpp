// Work that the residual of a collocation step's interpolant does on its rates, of a problem with
// constant matrices. See residual_work.cpp.
#pragma once
#include <time/affine.hpp>
#include <time/tableau.hpp>

#include <array>
#include <optional>

namespace whirl::time {

class ResidualWork {
 public:
  /// The problem and its affine face; both must outlive this.
  ResidualWork(const Tableau& tableau, Problem& problem, AffineProblem& affine);

  /// An accepted step.
  struct Step {
    double t0, t0_low, h;  ///< it began at t0 + t0_low, s
    const VecX &v0, &a0;   ///< rates and accelerations there
    const VecX* start;     ///< residual at (q0, v0, a0); null: zero
    const MatX& stages;    ///< accelerations, a column a stage
  };
  /// Integral of v . R dt over the step, N m, or nothing where R is not known between the stages.
  std::optional<double> of(const Step& step);
  /// The same where the products are known: stiff = K alpha, alpha the leading coefficient of the
  /// accelerations' polynomial, first = R(0) of the interpolant. `start` is not read.
  std::optional<double> of(const Step& step, const VecX& stiff, const VecX& first);

 private:
  static constexpr std::size_t points = 8;  ///< of the quadrature: exact to the fifteenth degree
  using AtPoints = std::array<double, points>;
  void multiply(const Step& step);
  double of_products(const Step& step, double scale, const VecX& stiff, const VecX& first);
  double of_loads(const Step& step, std::span<const Index> entries);

  const Tableau& tab_;
  Problem& problem_;
  AffineProblem& affine_;
  AtPoints theta_{}, weight_{};
  std::array<AtPoints, Tableau::max_stages + 1> lagrange_{};  ///< on 0, c_1 .. c_s
  std::array<Tableau::Basis, points> basis_{};
  // integrals of phi and of l_0, alone and with the integrals of the stages' polynomials
  double phi_ = 0.0, l0_ = 0.0;
  Tableau::Vec phi_rate_{}, l0_rate_{};
  VecX works_;  ///< 1 or 0 of AffineProblem::works()
  VecX combined_, stiff_, first_, working_stiff_, working_first_;  // scratch
  MatX at_nodes_;
  VecX at_point_;
};

}  // namespace whirl::time
