// The assembled equations of motion R(t, q, v, a) = M(q) a + f(q, v, t) of nodes and element
// batches. A System is const once built; what changes lives in State, scratch in Workspace.
#pragma once
#include <core/contract.hpp>
#include <core/law.hpp>
#include <system/batch.hpp>
#include <system/joints.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <typeindex>
#include <unordered_map>
#include <vector>

namespace whirl::system {

/// Components of a node's unknowns in q: q[6 i + c].
enum Component : int { ux = 0, uy = 1, uz = 2, spin_phi = 3, gamma2 = 4, gamma3 = 5 };
std::string_view component_name(int c);

struct NodeDef {
  Vec3 position = Vec3::Zero();  ///< reference position, m, global axes
  Index line = 0;                ///< shaft line whose chart it uses
  std::string name;              ///< for messages: "node at 0.25 m of shaft 'hp'"
  bool scalar = false;  ///< an internal unknown: component 0 alone exists, gravity does not act
  bool signal = false;  ///< a scalar that a controller stores: no coordinate of what moves
  bool rate = false;    ///< a scalar that is a spin or a temperature: its row does no work on it
  int scalars = 1;      ///< of a scalar: so many of components 0 to 2 exist
};

/// A complete state: copy it to checkpoint.
struct State {
  double t = 0;
  VecX q, v, a;
  Frames frames;
  /// Angle of a node about its line's own axes with its whole turns, rad.
  double total_phi(Index node, Index line) const;
  /// The normals of all nodes, global axes.
  std::vector<Vec3> normals() const;
};

struct Hold {
  Index unknown;
  LawPtr law;
};  ///< null law: held at zero

/// A stretch of Frames::kept and how its owner would have it in a state: the values that belong to
/// the node states of `w` (and to those kept there) into `values`.
struct Keeper {
  std::string name;  ///< of the owner, for messages
  std::size_t first = 0, count = 0;
  std::function<void(const Workspace& w, std::span<double> values)> settle;
  /// Throws an Error where values that have settled cannot be (a temperature beyond the law of an
  /// oil); null: there are no such.
  std::function<void(const Workspace& w)> check{};
  /// In time the values go towards those that have settled, by this, s; infinite: they stay.
  double time_constant = infinity;
};

class System {
 public:
  Index nodes() const { return static_cast<Index>(defs_.size()); }
  Index size() const { return 6 * nodes(); }
  Index lines() const { return static_cast<Index>(line_names_.size()); }
  const NodeDef& node(Index i) const {
    WHIRL_EXPECTS(i >= 0 && i < nodes());
    return defs_[static_cast<std::size_t>(i)];
  }
  const std::string& line_name(Index l) const {
    WHIRL_EXPECTS(l >= 0 && l < lines());
    return line_names_[static_cast<std::size_t>(l)];
  }
  const la::BlockPattern& pattern() const { return *pattern_; }
  /// 1 where q[k] is unknown, 0 where it is held.
  std::span<const unsigned char> active() const { return active_; }
  const std::vector<Hold>& holds() const { return holds_; }
  const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }
  const Vec3& gravity() const { return gravity_; }
  /// Nodes that joints carry along (joints.hpp).
  const Followers& followers() const { return followers_; }
  /// Writes places, rates and accelerations of followers into q, v, a. False outside their axes.
  bool follow(const Frames& f, Eigen::Ref<VecX> q, Eigen::Ref<VecX> v, Eigen::Ref<VecX> a) const {
    return followers_.empty() || followers_.follow(f, q, v, a);
  }
  void follow(State& s) const { follow(s.frames, s.q, s.v, s.a); }
  /// x, a small motion of the unknowns about s, gets that of followers. Scalar: double, Complex.
  template <class Scalar>
  void complete(const State& s, Eigen::Matrix<Scalar, -1, 1>& x) const {
    if (followers_.empty()) return;
    Workspace w = make_workspace();
    if (evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a)) followers_.complete(w, s.frames, x);
  }
  /// x, generalised forces on all coordinates at s, becomes that on the unknowns.
  template <class Scalar>
  void reduce(const State& s, Eigen::Matrix<Scalar, -1, 1>& x) const {
    if (followers_.empty()) return;
    Workspace w = make_workspace();
    if (evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a)) followers_.reduce(w, s.frames, x);
  }
  /// Pairs of nodes, lower number first, whose angles elements compare, sorted.
  std::span<const std::pair<Index, Index>> links() const { return links_; }
  /// The base accelerates as time goes on.
  bool base_moves() const { return varies(base_[0]) || varies(base_[1]) || varies(base_[2]); }
  /// The equations are affine in the unknowns with constant M, C, K: no rotation is unknown, and
  /// every kernel says so.
  bool linear() const { return linear_; }
  /// Terms whose force has corners (a gap closes): most scenes have none.
  bool cornered() const { return !cornered_.empty(); }
  /// The smooth piece on which every element of theirs stands, at the node states of the last
  /// evaluation.
  void list_regions(const Workspace& w, std::vector<int>& out) const;
  /// The batch of kernel type K, or null when the scene has none.
  template <Kernel K>
  const Batch<K>* batch() const {
    auto it = by_type_.find(std::type_index(typeid(K)));
    return it == by_type_.end() ? nullptr : static_cast<const Batch<K>*>(terms_[it->second].get());
  }
  template <Kernel K>
  Batch<K>* batch() {
    return const_cast<Batch<K>*>(std::as_const(*this).template batch<K>());
  }
  /// Law breakpoints of holds, base motion and elements, sorted.
  std::vector<double> breakpoints() const;
  /// Paces of the laws of holds and base motion.
  std::vector<Pace> paces() const;

  State make_state() const;
  Workspace make_workspace() const;
  /// Workspaces that only look at nodes and forces have no matrices; tangent() makes them.
  void make_tangents(Workspace& w) const;
  la::MCK make_matrices() const { return la::MCK(*pattern_); }

  /// Sets held entries of q, v, a at time t, and those of followers. phi laws are reduced by the
  /// line's whole turns.
  void impose(const Frames& f, double t, Eigen::Ref<VecX> q, Eigen::Ref<VecX> v,
              Eigen::Ref<VecX> a) const;
  /// Node states only (for probes, pictures). False when a node is outside its chart.
  /// @pre q, v, a of length size() (as in all that follow), w of make_workspace(), f of a state of
  /// this system; f must live while w is read.
  bool evaluate_nodes(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                      Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a) const {
    return evaluate_nodes(w, f, t, q, v, a, {});
  }
  /// Nodes of terms that supply or dissipate, ascending: all that exchange() reads. Empty where that
  /// are nearly all, or where those that joints carry along need the others.
  std::span<const Index> exchanging_nodes() const { return exchanging_; }
  /// Those alone; the states of all others are then unknown.
  /// @pre exchanging_nodes() is not empty, f is not moved.
  bool evaluate_exchanging(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                           Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a) const {
    return evaluate_some(w, f, t, q, v, a, exchanging_);
  }
  /// Some nodes alone, ascending; the states of all others are then unknown.
  /// @pre there are some, f is not moved, no node follows others.
  bool evaluate_some(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                     Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a,
                     std::span<const Index> nodes) const {
    WHIRL_EXPECTS(!nodes.empty() && !f.moved() && followers_.empty());
    return evaluate_nodes(w, f, t, q, v, a, nodes);
  }
  /// Some of the terms, as numbers into terms(); a null pointer means all.
  using Selection = const std::vector<std::size_t>*;
  /// r = R(t, q, v, a); held entries hold the reactions (force and torque the support exerts on the
  /// model).
  bool residual(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, Eigen::Ref<VecX> r,
                Selection only = nullptr) const;
  /// M = dR/da, C = dR/dv, K = dR/dq, exact.
  /// @pre out of make_matrices().
  bool tangent(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
               Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, la::MCK& out,
               Selection only = nullptr) const;
  /// Where the tangents of some terms stand; the other blocks are zero.
  struct Blocks {
    std::vector<Index> nodes, slots;  ///< ascending
  };
  /// Everything where joints carry tangents along.
  Blocks blocks_of(const std::vector<std::size_t>& terms) const;
  /// tangent() of some terms, these blocks alone: the others of `out` stay as they are.
  /// @pre where = blocks_of(only); the rest as of tangent().
  bool tangent_blocks(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                      Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, la::MCK& out,
                      const std::vector<std::size_t>& only, const Blocks& where) const;
  /// Some elements have internal unknowns that they balance themselves (relax() of a kernel).
  bool relaxes() const;
  /// Puts those into q, in balance at rest with everything else where it is; nothing happens where a
  /// node is outside its chart.
  void relax(Workspace& w, const Frames& f, double t, Eigen::Ref<VecX> q, Eigen::Ref<const VecX> v,
             Eigen::Ref<const VecX> a) const;
  /// Elements with something to keep (Frames::kept), in the order of their stretches.
  const std::vector<Keeper>& keepers() const { return keepers_; }
  /// What they would keep at the node states of the last evaluation; of size Frames::kept.
  /// @throws Error of an owner that finds nothing that could be kept.
  void settle_kept(const Workspace& w, std::vector<double>& values) const;
  /// Energies and powers of the elements at the node states of the last evaluation.
  /// @pre w was evaluated.
  Energy energy(const Workspace& w) const;
  /// Only what is supplied and dissipated, W: asks no element that does neither.
  Energy exchange(const Workspace& w) const;

 private:
  friend class Builder;
  /// only: empty means all.
  bool evaluate_nodes(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                      Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a,
                      std::span<const Index> only) const;
  void list_exchanging();
  Blocks every_block() const;
  void evaluate_own_axes(Workspace& w) const;
  void project_force(const Workspace& w, Eigen::Ref<VecX> r) const;
  /// What is left of the forces after joints have carried them, and the loads of joints.
  void loads_into(Workspace& w, const Frames& f, Eigen::Ref<VecX> r) const;
  Vec3 gravity_at(double t) const;
  /// W, what the change of the base's acceleration adds to the potential of the weight in it.
  double field_power(const Workspace& w) const;

  /// The derivatives of the Jacobians of some nodes, after evaluate_nodes.
  void evaluate_jacobians(Workspace& w, Eigen::Ref<const VecX> q, Eigen::Ref<const VecX> v,
                          Eigen::Ref<const VecX> a, std::span<const Index> of) const;
  /// The blocks in q-space: columns of gamma through D and its rates (node.hpp), then rows through
  /// D^T.
  void project_tangent(const Workspace& w, la::MCK& out, const Blocks& where) const;

  std::vector<NodeDef> defs_;
  std::vector<int> line_of_;     ///< per node, as the node kernel reads it
  std::vector<double> falling_;  ///< per node: 1, or 0 for scalar degrees of freedom
  std::vector<std::string> line_names_;
  std::vector<Mat3> charts_;
  std::vector<std::pair<Index, Index>> links_;
  std::vector<Hold> holds_;
  Followers followers_;
  std::vector<unsigned char> active_;
  std::unique_ptr<la::BlockPattern> pattern_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::unordered_map<std::type_index, std::size_t> by_type_;
  std::vector<std::size_t> cornered_;
  std::vector<Index> exchanging_;
  std::vector<std::size_t> all_terms_;
  Blocks everywhere_;
  std::vector<Keeper> keepers_;
  std::vector<double> kept_;  ///< at first
  bool linear_ = false;
  Vec3 gravity_ = Vec3::Zero();
  std::array<LawPtr, 3> base_;  ///< base acceleration along x, y, z; null = none
};

/// Puts a System together. Order of nodes along a shaft is the elimination order: keep it natural.
class Builder {
 public:
  /// A shaft line with its reference triad (columns e, e2, e3).
  Index add_line(std::string name, const Mat3& triad = Mat3::Identity());
  /// @pre finite position.
  Index add_node(NodeDef def);
  /// Holds component c of a node: at zero, or on a law (value, rate, acceleration all exact).
  void hold(Index node, int component, LawPtr law = nullptr);
  /// A node that a joint carries along (joints.hpp). Nothing of it that follows may be held.
  void add_follower(FollowerDef def) { followers_.push_back(std::move(def)); }
  /// A node that never moves (a ground point).
  Index add_ground(const Vec3& position, std::string name);
  void set_gravity(const Vec3& g) {
    WHIRL_EXPECTS(g.allFinite());
    system_.gravity_ = g;
  }
  void set_base_acceleration(int axis, LawPtr law) {
    WHIRL_EXPECTS(axis >= 0 && axis < 3);
    system_.base_[static_cast<std::size_t>(axis)] = std::move(law);
  }
  /// `kind` names the batch in summaries ("shaft elements"); the first call for a type decides.
  /// Returns the number of the batch in System::terms().
  template <Kernel K>
  std::size_t add(const K& k, const std::array<Index, K::n_nodes>& nodes, const char* kind) {
    WHIRL_EXPECTS(kind != nullptr);
    WHIRL_EXPECTS(std::all_of(nodes.begin(), nodes.end(),
                              [this](Index n) { return n >= 0 && n < this->nodes(); }));
    const std::type_index key(typeid(K));
    auto it = system_.by_type_.find(key);
    if (it == system_.by_type_.end()) {
      it = system_.by_type_.emplace(key, system_.terms_.size()).first;
      system_.terms_.push_back(std::make_unique<Batch<K>>(kind));
    }
    static_cast<Batch<K>&>(*system_.terms_[it->second]).add(k, nodes);
    return it->second;
  }
  /// Values that a state keeps beside its coordinates (Frames::kept), as they are at first, and who
  /// keeps them; k.first and k.count are set here. Returns where they begin.
  /// @pre k.settle.
  std::size_t keep(Keeper k, std::span<const double> at_first);
  /// Elements of a kernel type so far: the next one's place in its batch.
  template <Kernel K>
  std::size_t count() const {
    const Batch<K>* b = system_.batch<K>();
    return b ? b->count() : 0;
  }
  /// What was added so far of a kernel type, or null.
  template <Kernel K>
  const Batch<K>* batch() const {
    return system_.batch<K>();
  }
  const NodeDef& node(Index i) const { return system_.node(i); }
  Index nodes() const { return static_cast<Index>(system_.defs_.size()); }
  /// Holds every rotational unknown no element resists or loads, then freezes pattern and slots.
  System finalize();

 private:
  /// Unknowns of each node that elements and joints touch: 0, 3 (translations) or 7.
  std::vector<int> list_widths() const;
  /// Unknowns no element can touch: rotations of nodes with translational elements only, all but
  /// the first of scalars.
  void hold_untouched();
  /// Takes held unknowns and those that follow out of the active ones. Returns for each node its
  /// row of the matrices: itself, or -1 where every unknown is held.
  std::vector<Index> apply_holds();
  /// The pattern of the matrices, each element's place in it, and the pairs of nodes with angles in
  /// common.
  void freeze_pattern(const std::vector<Index>& row);
  bool is_linear() const;

  System system_;
  std::vector<Hold> holds_;
  std::vector<FollowerDef> followers_;
  Index ground_line_ = -1;
};

}  // namespace whirl::system
