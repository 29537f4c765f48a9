// A batch holds all elements of one kind with their nodes and the precomputed slots of their
// blocks. What does not need to know the kind is compiled once for all of one shape (Elements); a
// kind adds its own formulas.
#pragma once
#include <functional>
#include <core/contract.hpp>
#include <core/rotation.hpp>
#include <la/block.hpp>
#include <system/frames.hpp>
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
  la::BlockMatrix<7> M, C,
      K;                ///< X-space tangents; empty until they are wanted (System::make_tangents)
  VecX q, v, a, loads;  ///< with the places of followers, where there are any (joints.hpp)
  Context context;
  Index outside = -1;        ///< node that left the chart (|gamma| >= pi), or -1
  std::vector<Mat3> charts;  ///< of the last evaluation: the nodes point at them
  bool on_lines = false;     ///< each at that of its line
  /// Once nodes have moved to other axes (frames.hpp): those of the last evaluation, and each node
  /// as its line's own axes see it; empty where it found no node moved or one outside its chart.
  Frames frames;
  std::vector<NodeState> own;
  std::vector<AngleTransport::At> own_carried;
  std::vector<double> kept;  ///< of the last evaluation: the nodes point at them

  Workspace() = default;
  Workspace(Workspace&&) = default;  // a copy's nodes would point into the original
  Workspace& operator=(Workspace&&) = default;

  /// The last evaluation saw moved nodes.
  bool moved() const { return !own.empty(); }
  /// The node in the line's own axes: what its angle and tilt mean to everything outside it.
  const NodeState& in_own_axes(Index node) const {
    WHIRL_EXPECTS(node >= 0 && at(node) < nodes.size());
    return moved() ? own[static_cast<std::size_t>(node)] : nodes[static_cast<std::size_t>(node)];
  }
};

/// A compliance in series with the bending of an element (a crack): moments m in axes fixed in the shaft
/// add the rotations dW/dm, M = m + stiffness dW/dm with M the moments of the element without it. What is
/// truncated to some harmonics is m, which is smooth; the rotation may switch.
struct SeriesCompliance {
  std::array<Index, 2> nodes{};
  std::size_t number = 0;  ///< in Context::kinks
  double stiffness = 0;    ///< N m/rad
  /// M at the last evaluation, N m.
  std::function<Vec2(const Workspace& w)> moment;
  struct Kink {
    Vec2 angle;  ///< dW/dm, rad
    Mat2 slope;  ///< d2W/dm2, rad/(N m)
  };
  bool by_moment = false;  ///< the law is one of m alone, at every angle
  using Law = std::function<Kink(const Vec2& m)>;
  /// As it is at the last evaluation.
  std::function<Law(const Workspace& w)> law;
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
  /// Elements have unknowns of their own that they can balance (kernels that have a relax()).
  virtual bool relaxes() const = 0;
  /// Puts them into q.
  virtual void relax(const Workspace& w, Eigen::Ref<VecX> q) const = 0;
  /// Appends compliances in series (kernels that have a series_stiffness()).
  virtual void list_series(std::vector<SeriesCompliance>& out) const = 0;
  virtual void list_couplings(std::vector<std::pair<Index, Index>>& out) const = 0;
  virtual void list_nodes(std::vector<Index>& out) const = 0;
  /// Appends the breakpoints of the time laws in the elements (kernels that have a breakpoints()).
  virtual void list_breakpoints(std::vector<double>& out) const = 0;
  /// Pairs of nodes, lower number first, whose angles the elements compare.
  virtual void list_links(std::vector<std::pair<Index, Index>>& out) const = 0;
  /// links: those of the system, sorted.
  virtual void bind_links(std::span<const std::pair<Index, Index>> links) = 0;
  /// row[i]: matrix row of node i or -1 when nothing of it is unknown.
  virtual void bind(const la::BlockPattern& p, const std::vector<Index>& row) = 0;
};

/// All elements of one kind on N nodes with W coordinates each: what does not need to know which.
template <int N, int W>
class Elements : public Term {
 public:
  explicit Elements(std::string kind) : kind_(std::move(kind)) {}
  std::string_view kind() const override { return kind_; }
  int width() const override { return W; }
  const std::vector<std::array<Index, N>>& nodes() const { return nodes_; }
  void list_couplings(std::vector<std::pair<Index, Index>>& out) const override;
  void list_nodes(std::vector<Index>& out) const override;
  void bind(const la::BlockPattern& p, const std::vector<Index>& row) override;
  void list_links(std::vector<std::pair<Index, Index>>& out) const override;
  void bind_links(std::span<const std::pair<Index, Index>> links) override;
  void add_force(Workspace& w) const override;
  void add_tangent(Workspace& w) const override;
  void add_energy(const Workspace& w, const Context& c, Energy& e) const override;
  bool sees_turning(const Context& c, std::span<const double> rate) const override;

 protected:
  /// Nodes as an element sees them. carried[a]: how node a's angle was brought to other axes, or
  /// null where it stands as it is.
  struct Seen {
    Nodes<N> x;
    std::array<const AngleTransport::At*, N> carried{};
    NodeState second;
    AngleTransport::At second_carried;
  };
  Nodes<N> gather(const Workspace& w, std::size_t i) const {
    Nodes<N> x;
    for (std::size_t a = 0; a < N; ++a)
      x[a] = &w.nodes[static_cast<std::size_t>(nodes_[i][a])];
    return x;
  }
  void see(const Workspace& w, std::size_t i, Seen& out) const;
  /// Nodes have moved, but an element still sees its own as they stand.
  bool stands(const Workspace& w, std::size_t i) const;
  void scatter(const Matrix<N * W>& tangent, std::size_t i, la::BlockMatrix<7>& into) const;
  void add_forces_moved(Workspace& w) const;
  void add_tangents_moved(Workspace& w) const;

  /// Which matrices the tangent of an element has.
  struct Parts {
    bool M, C, K;
  };
  virtual Parts parts() const = 0;
  virtual Axes axes() const = 0;
  virtual void element_force(std::size_t i, const Nodes<N>& x, const Context& c,
                             ForceX<N * W>& f) const = 0;
  virtual void element_tangent(std::size_t i, const Nodes<N>& x, const Context& c,
                               TangentX<N * W>& t) const = 0;
  virtual void element_energy(std::size_t i, const Nodes<N>& x, const Context& c,
                              Energy& e) const = 0;
  virtual Dependence element_dependence(std::size_t i, const Context& c) const = 0;
  /// The energies of all elements as they stand, where the kernel computes several at once.
  virtual bool energies_at_once(const Workspace& w, const Context& c, Energy& e) const = 0;
  /// The forces of elements first .. last - 1, where the kernel computes several at once.
  virtual bool forces_at_once(std::size_t first, std::size_t last, Workspace& w) const = 0;

  std::string kind_;
  std::vector<std::array<Index, N>> nodes_;
  std::vector<std::array<Index, N * N>> slots_;
  std::vector<Index> links_;  ///< per element, of kinds that compare their nodes' angles
};

/// Two nodes of a line as a kernel that compares their angles sees them: the higher number in the
/// axes of the lower.
std::array<NodeState, 2> seen_together(const System& system, const Workspace& w, Index first,
                                       Index second);
/// Re-expresses a node in other axes: phi becomes phi + turn.
void carry(NodeState& n, const AngleTransport::At& carried, double turn, const Mat3& axes);

extern template class Elements<1, 3>;
extern template class Elements<1, 7>;
extern template class Elements<2, 3>;
extern template class Elements<2, 7>;
extern template class Elements<3, 7>;
extern template class Elements<4, 7>;
extern template class Elements<5, 7>;
extern template class Elements<6, 7>;
extern template class Elements<7, 7>;

template <Kernel K>
class Batch final : public Elements<K::n_nodes, K::width> {
 public:
  static constexpr int N = K::n_nodes, W = K::width;
  using Base = Elements<N, W>;
  using Base::nodes_;
  explicit Batch(std::string kind) : Base(std::move(kind)) {}
  void add(const K& k, const std::array<Index, N>& nodes) {
    elements_.push_back(k);
    nodes_.push_back(nodes);
  }
  std::size_t count() const override { return elements_.size(); }
  bool inertial() const override {
    if constexpr (requires { K::inertial; })
      return K::inertial;
    else
      return false;
  }
  bool add_rigid_inertia(std::vector<RigidInertia>& of_node) const override {
    WHIRL_EXPECTS(K::n_nodes == 1 || !inertial());
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
  bool relaxes() const override {
    return requires { K::own; };
  }
  void relax(const Workspace& w, Eigen::Ref<VecX> q) const override {
    if constexpr (requires { K::own; })
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        typename Base::Seen seen;
        Base::see(w, i, seen);
        constexpr std::size_t own = K::own, first = static_cast<std::size_t>(N) - own;
        constexpr std::size_t each = own_each();
        std::array<double, own * each> values;
        const auto unknown = [&](std::size_t k) {
          return 6 * nodes_[i][first + k / each] + static_cast<Index>(k % each);
        };
        for (std::size_t k = 0; k < values.size(); ++k)
          values[k] = q[unknown(k)];
        elements_[i].relax(seen.x, w.context, values);
        for (std::size_t k = 0; k < values.size(); ++k)
          q[unknown(k)] = values[k];
      }
    else {
      (void)w;
      (void)q;
    }
  }
  void list_regions(const Workspace& w, std::vector<int>& out) const override {
    if constexpr (has_regions)
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        typename Base::Seen seen;
        Base::see(w, i, seen);
        out.push_back(elements_[i].region(seen.x));
      }
    else {
      (void)w;
      (void)out;
    }
  }
  void list_series(std::vector<SeriesCompliance>& out) const override {
    if constexpr (requires(const K& k) { k.series_stiffness(); })
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        if (!(elements_[i].series_stiffness() > 0.0)) continue;
        SeriesCompliance c;
        c.nodes = nodes_[i];
        c.number = i;
        c.stiffness = elements_[i].series_stiffness();
        c.by_moment = elements_[i].by_moment();
        c.moment = [this, i](const Workspace& w) {
          typename Base::Seen seen;
          Base::see(w, i, seen);
          return elements_[i].moment(seen.x, w.context);
        };
        c.law = [this, i](const Workspace& w) -> SeriesCompliance::Law {
          typename Base::Seen seen;
          Base::see(w, i, seen);
          return [law = elements_[i].kink_law(seen.x, w.context)](const Vec2& m) {
            const auto [angle, slope] = law(m);
            return SeriesCompliance::Kink{angle, slope};
          };
        };
        out.push_back(std::move(c));
      }
    else
      (void)out;
  }
  Family family() const override { return K::family; }
  Dependence depends(const Context& c) const override {
    Dependence all;
    for (const K& k : elements_)
      all = all | dependence_of(k, c);
    return all;
  }
  std::vector<K>& elements() { return elements_; }
  const std::vector<K>& elements() const { return elements_; }

  void list_breakpoints(std::vector<double>& out) const override {
    if constexpr (requires(const K& k) { k.breakpoints(); })
      for (const K& k : elements_)
        for (double t : k.breakpoints())
          out.push_back(t);
    else
      (void)out;
  }

 private:
  /// Unknowns of each of an element's own nodes.
  static constexpr std::size_t own_each() {
    if constexpr (requires { K::own_each; })
      return K::own_each;
    else
      return 1;
  }
  static constexpr bool has_regions = requires(const K& k, const Nodes<K::n_nodes>& x) {
    k.region(x);
  };
  typename Base::Parts parts() const override { return {K::has_M, K::has_C, K::has_K}; }
  Axes axes() const override { return axes_of<K>(); }
  void element_force(std::size_t i, const Nodes<N>& x, const Context& c,
                     ForceX<N * W>& f) const override {
    elements_[i].add_force(x, c, f);
  }
  void element_tangent(std::size_t i, const Nodes<N>& x, const Context& c,
                       TangentX<N * W>& t) const override {
    elements_[i].add_tangent(x, c, t);
  }
  void element_energy(std::size_t i, const Nodes<N>& x, const Context& c,
                      Energy& e) const override {
    elements_[i].add_energy(x, c, e);
  }
  Dependence element_dependence(std::size_t i, const Context& c) const override {
    return dependence_of(elements_[i], c);
  }
  bool energies_at_once(const Workspace& w, const Context& c, Energy& e) const override {
    if constexpr (requires {
                    K::add_energies(std::span<const K>(elements_), nodes_.data(), w.nodes.data(), c,
                                    e);
                  }) {
      K::add_energies(std::span<const K>(elements_), nodes_.data(), w.nodes.data(), c, e);
      return true;
    }
    (void)w;
    (void)c;
    (void)e;
    return false;
  }
  bool forces_at_once(std::size_t first, std::size_t last, Workspace& w) const override {
    if constexpr (requires {
                    K::add_forces(std::span<const K>(elements_), nodes_.data(), w.nodes.data(),
                                  w.context, w.force.data());
                  }) {
      const std::span<const K> some = std::span<const K>(elements_).subspan(first, last - first);
      K::add_forces(some, nodes_.data() + first, w.nodes.data(), w.context, w.force.data());
      return true;
    }
    (void)first;
    (void)last;
    (void)w;
    return false;
  }
  std::vector<K> elements_;
};

}  // namespace whirl::system
