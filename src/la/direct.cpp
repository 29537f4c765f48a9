#include <la/block_lu.hpp>
#include <la/direct.hpp>
#include <la/klu_solver.hpp>

namespace whirl::la {

namespace {

/// Growth of the block LU beyond which its answer (backward error about 1e-10) is left to KLU.
constexpr double growth_limit = 1e6;

template <class Scalar>
class AutomaticSolver final : public DirectSolver<Scalar> {
 public:
  AutomaticSolver(const BlockPattern& pattern, std::span<const unsigned char> active)
      : pattern_(pattern),
        active_(active.begin(), active.end()),
        block_(pattern, active) {}
  Status factor(const MCK& m, Scalar cm, Scalar cc, Scalar ck) override {
    last_ = &block_;
    const Status s = block_.factor(m, cm, cc, ck);
    if (s == Status::ok && block_.growth() <= growth_limit) return s;
    if (!klu_) klu_ = make_klu_solver<Scalar>(pattern_, active_);
    const Status general = klu_->factor(m, cm, cc, ck);
    if (general == Status::singular && s == Status::ok) return s;
    last_ = klu_.get();
    return general;
  }
  void solve(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>> b) override { last_->solve(b); }
  void solve_columns(Eigen::Ref<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> b) override {
    last_->solve_columns(b);
  }
  Index singular_unknown() const override { return last_->singular_unknown(); }
  std::string_view name() const override { return last_->name(); }
  double growth() const override { return last_->growth(); }

 private:
  const BlockPattern& pattern_;
  std::vector<unsigned char> active_;
  BlockLu<Scalar> block_;
  std::unique_ptr<DirectSolver<Scalar>> klu_;
  DirectSolver<Scalar>* last_ = &block_;
};

}  // namespace

template <class Scalar>
std::unique_ptr<DirectSolver<Scalar>> make_direct_solver(const BlockPattern& pattern,
                                                         std::span<const unsigned char> active,
                                                         SolverKind kind) {
  switch (kind) {
    case SolverKind::block: return std::make_unique<BlockLu<Scalar>>(pattern, active);
    case SolverKind::klu: return make_klu_solver<Scalar>(pattern, active);
    case SolverKind::automatic: break;
  }
  return std::make_unique<AutomaticSolver<Scalar>>(pattern, active);
}

template std::unique_ptr<DirectSolver<double>> make_direct_solver(const BlockPattern&,
                                                                  std::span<const unsigned char>,
                                                                  SolverKind);
template std::unique_ptr<DirectSolver<Complex>> make_direct_solver(const BlockPattern&,
                                                                   std::span<const unsigned char>,
                                                                   SolverKind);

}  // namespace whirl::la
