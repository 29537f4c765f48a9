#include <results/mean_loads.hpp>

#include <core/error.hpp>

#include <algorithm>
#include <limits>

namespace whirl::results {

namespace {

/// Adds the weighted load of each support or joint.
template <class Laws, class Load>
void add_loads(const Laws& laws, double weight, const Load& load, std::vector<PlaceLoad>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].force += weight * load(laws[i].force);
    if (laws[i].moment) out[i].moment += weight * load(laws[i].moment);
  }
}

/// Weighted forces of elements, and how large they are without signs.
class ElementSum {
 public:
  explicit ElementSum(std::size_t elements)
      : sum_(elements, system::ForceX<14>::Zero()),
        size_(sum_) {}
  void add(double weight, const assembly::ElementForces& here);
  bool vary() const { return apart_ > 1e-9 * largest_; }
  /// What is rounding of the single forces is nothing.
  assembly::ElementForces mean() const;

 private:
  assembly::ElementForces sum_, size_, first_;
  double largest_ = 0, apart_ = 0;
};

void ElementSum::add(double weight, const assembly::ElementForces& here) {
  if (first_.empty()) first_ = here;
  for (std::size_t k = 0; k < sum_.size(); ++k) {
    sum_[k] += weight * here[k];
    size_[k] += std::abs(weight) * here[k].cwiseAbs();
    largest_ = std::max(largest_, here[k].cwiseAbs().maxCoeff());
    apart_ = std::max(apart_, (here[k] - first_[k]).cwiseAbs().maxCoeff());
  }
}

assembly::ElementForces ElementSum::mean() const {
  if (!vary()) return first_;
  constexpr double share = 32 * std::numeric_limits<double>::epsilon();
  assembly::ElementForces out = sum_;
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = (sum_[k].array().abs() > share * size_[k].array()).select(sum_[k], 0.0);
  return out;
}

/// J, of the shafts where nothing is displaced, mean over the turn.
double undisplaced_energy(analysis::SteadySystem& running, double Omega) {
  const system::State straight = running.system().make_state();
  double out = 0;
  running.visit_revolution(straight.frames, Omega, straight.q,
                           [&](double weight, const system::Workspace& w) {
                             system::Energy e;
                             for (const auto& term : running.system().terms())
                               if (term->family() == system::Family::shaft)
                                 term->add_energy(w, w.context, e);
                             out += weight * e.elastic;
                           });
  return out;
}

}  // namespace

MeanLoads calc_mean_loads(const run::Job& job, analysis::SteadySystem& running,
                          const system::State& state, double Omega, const VecX& reactions) {
  MeanLoads out;
  out.supports.resize(job.built.support_forces.size());
  out.joints.resize(job.built.joints.size());
  ElementSum elements(job.mesh.elements.size());
  const auto reaction = [&](Index k) { return reactions[k]; };
  const bool inside = running.visit_revolution(
      state.frames, Omega, state.q, [&](double weight, const system::Workspace& w) {
        const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
        const auto load = [&](const assembly::SupportForce::Law& law) {
          return law(node, w.context, reaction);
        };
        add_loads(job.built.support_forces, weight, load, out.supports);
        add_loads(job.built.joints, weight, load, out.joints);
        elements.add(weight, assembly::calc_element_forces(job.mesh, job.built, w));
        out.elastic_energy += weight * running.system().energy(w).elastic;
      });
  if (!inside) throw run_error("R11", "the state found cannot be evaluated", {});
  out.elements = elements.mean();
  out.elements_vary = elements.vary();
  if (running.running().mean) out.elastic_energy -= undisplaced_energy(running, Omega);
  return out;
}

}  // namespace whirl::results
