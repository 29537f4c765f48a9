// A batch holds all elements of one kind with their nodes and the precomputed slots of their
// blocks: one virtual call per kind and evaluation, none per element.
#pragma once
#include <core/rotation.hpp>
#include <la/block.hpp>
#include <system/kernel.hpp>
#include <system/rigid_inertia.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace whirl::system {

/// Everything an evaluation writes to; one per thread. Sized once.
struct Workspace {
  std::vector<NodeState> nodes;
  std::vector<Mat32> D, D_rate, D_accel;     ///< node Jacobians in global axes
  std::vector<rotation::Director> director;  ///< in chart axes
  std::vector<Vector<7>> force;              ///< X-space force of every node
  la::BlockMatrix<7> M, C, K;                ///< X-space tangents
  Context context;
  Index outside = -1;  ///< node that left the chart (|gamma| >= pi), or -1
};

/// All elements of one kind.
class Term {
 public:
  virtual ~Term() = default;
  virtual std::string_view kind() const = 0;
  virtual std::size_t count() const = 0;
  virtual int width() const = 0;      ///< 3: translations only; 7: rotations too
  virtual bool inertial() const = 0;  ///< nothing but rigid-body inertia
  /// The force is a polynomial of degree <= 2 in the rates (kernels that say quadratic_in_rates =
  /// true).
  virtual bool quadratic_in_rates() const = 0;
  /// Neither supplies nor dissipates (kernels that say powerless = true).
  virtual bool powerless() const = 0;
  /// At given directors and angles of its nodes the force is affine in u, u', u'' with constant
  /// coefficients (kernels that say linear_in_displacements = true).
  virtual bool linear_in_displacements() const = 0;
  /// The force has corners (kernels that have a region()).
  virtual bool cornered() const = 0;
  /// Appends, for every element of a cornered() term, on which smooth piece of its force it stands.
  virtual void list_regions(const Workspace& w, std::vector<int>& out) const = 0;
  virtual Family family() const = 0;
  /// What its forces depend on in a context, all elements together.
  virtual Dependence depends(const Context& c) const = 0;
  /// An element sees its angles as the nodes turn at these rates (any unit), one a node.
  virtual bool sees_turning(const Context& c, std::span<const double> rate) const = 0;
  /// Adds the inertia of an inertial() term to its nodes; false when it is not constant in time.
  virtual bool add_rigid_inertia(std::vector<RigidInertia>& of_node) const = 0;
  virtual void add_force(Workspace& w) const = 0;
  virtual void add_tangent(Workspace& w) const = 0;
  /// In the given context, which need not be that of the workspace.
  virtual void add_energy(const Workspace& w, const Context& c, Energy& e) const = 0;
  virtual void list_couplings(std::vector<std::pair<Index, Index>>& out) const = 0;
  virtual void list_nodes(std::vector<Index>& out) const = 0;
  /// Appends the breakpoints of the time laws in the elements (kernels that have a breakpoints()).
  virtual void list_breakpoints(std::vector<double>& out) const = 0;
  /// row[i]: matrix row of node i or -1 when nothing of it is unknown.
  virtual void bind(const la::BlockPattern& p, const std::vector<Index>& row) = 0;
};

/// Adds the blocks of an element's tangent at the slots of its node pairs (-1: nothing unknown).
template <int N, int W>
[[gnu::noinline]] void scatter(const Matrix<N * W>& tangent, const std::array<Index, N * N>& slots,
                               la::BlockMatrix<7>& into) {
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) {
      const Index s = slots[static_cast<std::size_t>(a * N + b)];
      if (s < 0) continue;
      into.block(s).template topLeftCorner<W, W>() += tangent.template block<W, W>(W * a, W * b);
    }
}
extern template void scatter<1, 3>(const Matrix<3>&, const std::array<Index, 1>&,
                                   la::BlockMatrix<7>&);
extern template void scatter<1, 7>(const Matrix<7>&, const std::array<Index, 1>&,
                                   la::BlockMatrix<7>&);
extern template void scatter<2, 3>(const Matrix<6>&, const std::array<Index, 4>&,
                                   la::BlockMatrix<7>&);
extern template void scatter<2, 7>(const Matrix<14>&, const std::array<Index, 4>&,
                                   la::BlockMatrix<7>&);

template <Kernel K>
class Batch final : public Term {
 public:
  static constexpr int N = K::n_nodes, W = K::width;
  explicit Batch(std::string kind) : kind_(std::move(kind)) {}
  void add(const K& k, const std::array<Index, N>& nodes) {
    elements_.push_back(k);
    nodes_.push_back(nodes);
  }
  std::string_view kind() const override { return kind_; }
  std::size_t count() const override { return elements_.size(); }
  int width() const override { return W; }
  bool inertial() const override {
    if constexpr (requires { K::inertial; })
      return K::inertial;
    else
      return false;
  }
  bool add_rigid_inertia(std::vector<RigidInertia>& of_node) const override {
    bool constant = true;
    if constexpr (requires(const K& k) { k.inertia(0.0); })
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        of_node[static_cast<std::size_t>(nodes_[i][0])] += elements_[i].inertia(0.0);
        if constexpr (requires(const K& k) { k.factor; })
          constant = constant && !elements_[i].factor;
      }
    else
      (void)of_node;
    return constant;
  }
  bool quadratic_in_rates() const override {
    if constexpr (requires { K::quadratic_in_rates; })
      return K::quadratic_in_rates;
    else
      return false;
  }
  bool powerless() const override {
    if constexpr (requires { K::powerless; })
      return K::powerless;
    else
      return false;
  }
  bool linear_in_displacements() const override {
    if constexpr (requires { K::linear_in_displacements; })
      return K::linear_in_displacements;
    else
      return false;
  }
  bool cornered() const override {
    if constexpr (has_regions)
      for (const K& k : elements_)
        if (k.cornered()) return true;
    return false;
  }
  void list_regions(const Workspace& w, std::vector<int>& out) const override {
    if constexpr (has_regions)
      for (std::size_t i = 0; i < elements_.size(); ++i)
        out.push_back(elements_[i].region(gather(w, i)));
    else {
      (void)w;
      (void)out;
    }
  }
  Family family() const override { return K::family; }
  Dependence depends(const Context& c) const override {
    Dependence all;
    for (const K& k : elements_)
      all = all | dependence_of(k, c);
    return all;
  }
  bool sees_turning(const Context& c, std::span<const double> rate) const override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      std::array<double, N> of_nodes;
      for (std::size_t a = 0; a < of_nodes.size(); ++a)
        of_nodes[a] = rate[static_cast<std::size_t>(nodes_[i][a])];
      if (dependence_of(elements_[i], c).angle.changes(of_nodes)) return true;
    }
    return false;
  }
  std::vector<K>& elements() { return elements_; }
  const std::vector<K>& elements() const { return elements_; }
  const std::vector<std::array<Index, N>>& nodes() const { return nodes_; }

  void add_force(Workspace& w) const override {
    if constexpr (requires {
                    K::add_forces(std::span<const K>(elements_), nodes_.data(), w.nodes.data(),
                                  w.context, w.force.data());
                  }) {
      K::add_forces(elements_, nodes_.data(), w.nodes.data(), w.context, w.force.data());
      return;
    }
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      ForceX<N* W> f = ForceX<N * W>::Zero();
      elements_[i].add_force(gather(w, i), w.context, f);
      for (int a = 0; a < N; ++a)
        w.force[static_cast<std::size_t>(nodes_[i][a])].template head<W>() +=
            f.template segment<W>(W * a);
    }
  }
  void add_tangent(Workspace& w) const override {
    if constexpr (K::has_M || K::has_C || K::has_K) {
      TangentX<N * W> t;
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        if constexpr (K::has_M) t.M.setZero();
        if constexpr (K::has_C) t.C.setZero();
        if constexpr (K::has_K) t.K.setZero();
        elements_[i].add_tangent(gather(w, i), w.context, t);
        if constexpr (K::has_M) scatter<N, W>(t.M, slots_[i], w.M);
        if constexpr (K::has_C) scatter<N, W>(t.C, slots_[i], w.C);
        if constexpr (K::has_K) scatter<N, W>(t.K, slots_[i], w.K);
      }
    }
  }
  void add_energy(const Workspace& w, const Context& c, Energy& e) const override {
    for (std::size_t i = 0; i < elements_.size(); ++i)
      elements_[i].add_energy(gather(w, i), c, e);
  }
  void list_couplings(std::vector<std::pair<Index, Index>>& out) const override {
    if constexpr (N > 1)
      for (const auto& n : nodes_)
        for (int a = 0; a < N; ++a)
          for (int b = a + 1; b < N; ++b)
            out.emplace_back(n[a], n[b]);
  }
  void list_nodes(std::vector<Index>& out) const override {
    for (const auto& n : nodes_)
      out.insert(out.end(), n.begin(), n.end());
  }
  void list_breakpoints(std::vector<double>& out) const override {
    if constexpr (requires(const K& k) { k.breakpoints(); })
      for (const K& k : elements_)
        for (double t : k.breakpoints())
          out.push_back(t);
    else
      (void)out;
  }
  void bind(const la::BlockPattern& p, const std::vector<Index>& row) override {
    slots_.resize(elements_.size());
    for (std::size_t i = 0; i < elements_.size(); ++i)
      for (int a = 0; a < N; ++a)
        for (int b = 0; b < N; ++b) {
          const Index ra = row[static_cast<std::size_t>(nodes_[i][a])],
                      rb = row[static_cast<std::size_t>(nodes_[i][b])];
          slots_[i][static_cast<std::size_t>(a * N + b)] = ra < 0 || rb < 0 ? -1 : p.slot(ra, rb);
        }
  }

 private:
  static constexpr bool has_regions = requires(const K& k, const Nodes<K::n_nodes>& x) {
    k.region(x);
  };
  Nodes<N> gather(const Workspace& w, std::size_t i) const {
    Nodes<N> x;
    for (int a = 0; a < N; ++a)
      x[a] = &w.nodes[static_cast<std::size_t>(nodes_[i][a])];
    return x;
  }
  std::string kind_;
  std::vector<K> elements_;
  std::vector<std::array<Index, N>> nodes_;
  std::vector<std::array<Index, N * N>> slots_;
};

}  // namespace whirl::system
