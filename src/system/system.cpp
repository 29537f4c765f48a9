#include <system/system.hpp>
#include <core/contract.hpp>

#include <core/error.hpp>
#include <core/rotation.hpp>
#include <system/node_lanes.hpp>

#include <algorithm>
#include <numeric>
#include <cmath>
#include <cstddef>

namespace whirl::system {

namespace {

/// One 7x7 block in X (columns u, d, phi) to the 6x6 block in q (u, phi, gamma): y = J_i^T x J_j,
/// where gamma_column(k, r) is row r of column gamma_k. Column-major, spelled out: it runs for
/// every block of every linearisation.
template <class Column>
inline void project_block(const Mat32& Di, const double* x, double* y, Column&& gamma_column) {
  auto finish = [&](const double* col, double* out) {
    out[0] = col[0];
    out[1] = col[1];
    out[2] = col[2];
    out[3] = col[6];
    out[4] = Di(0, 0) * col[3] + Di(1, 0) * col[4] + Di(2, 0) * col[5];
    out[5] = Di(0, 1) * col[3] + Di(1, 1) * col[4] + Di(2, 1) * col[5];
  };
  for (int c = 0; c < 3; ++c)
    finish(x + 7 * c, y + 6 * c);
  finish(x + 42, y + 18);
  for (int k = 0; k < 2; ++k) {
    double col[7];
    for (int r = 0; r < 7; ++r)
      col[r] = gamma_column(k, r);
    finish(col, y + 24 + 6 * k);
  }
}
}  // namespace

std::string_view component_name(int c) {
  WHIRL_EXPECTS(c >= 0 && c < 6);
  constexpr std::string_view names[] = {"x", "y", "z", "spin", "tilt gamma2", "tilt gamma3"};
  return names[c];
}

Index Builder::add_line(std::string name, const Mat3& triad) {
  WHIRL_EXPECTS(triad.allFinite());
  WHIRL_EXPECTS((triad.transpose() * triad - Mat3::Identity()).norm() < 1e-9);
  system_.line_names_.push_back(std::move(name));
  system_.charts_.push_back(triad);
  return static_cast<Index>(system_.charts_.size()) - 1;
}

Index Builder::add_node(NodeDef def) {
  WHIRL_EXPECTS(def.position.allFinite());
  if (system_.charts_.empty()) add_line("model");
  system_.defs_.push_back(std::move(def));
  return nodes() - 1;
}

Index Builder::add_ground(const Vec3& position, std::string name) {
  // on a line of its own: its axes stay when the chart of a shaft line is moved
  if (system_.charts_.empty()) add_line("model");
  if (ground_line_ < 0) ground_line_ = add_line("ground");
  const Index n = add_node({position, ground_line_, std::move(name), false});
  for (int c = 0; c < 6; ++c)
    hold(n, c);
  return n;
}

void Builder::hold(Index node, int component, LawPtr law) {
  WHIRL_EXPECTS(node >= 0 && node < nodes());
  WHIRL_EXPECTS(component >= 0 && component < 6);
  holds_.push_back({6 * node + component, std::move(law)});
}

std::vector<int> Builder::list_widths() const {
  std::vector<int> width(at(system_.nodes()), 0);
  for (const auto& term : system_.terms_) {
    std::vector<Index> touched;
    term->list_nodes(touched);
    for (Index n : touched)
      width[at(n)] = std::max(width[at(n)], term->width());
  }
  for (const FollowerDef& f : followers_)  // what follows is touched through what it follows
    for (const Index n : {f.node, f.parent})
      width[at(n)] = 7;
  for (const FollowerDef& f : followers_)
    for (const Index n : {f.angle, f.slide})
      if (n >= 0) width[at(n)] = std::max(width[at(n)], 3);
  return width;
}

void Builder::hold_untouched() {
  System& s = system_;
  const std::vector<int> width = list_widths();
  for (Index i = 0; i < s.nodes(); ++i) {
    const int first_free = s.defs_[at(i)].scalar ? s.defs_[at(i)].scalars
                           : width[at(i)] == 7   ? 6
                           : width[at(i)] == 3   ? 3
                                                 : 0;
    for (int c = first_free; c < 6; ++c)
      s.active_[at(6 * i + c)] = 0;
  }
}

std::vector<Index> Builder::apply_holds() {
  System& s = system_;
  // A law outranks a plain hold of the same unknown; the last law wins.
  std::stable_sort(holds_.begin(), holds_.end(), [](const Hold& a, const Hold& b) {
    return a.unknown != b.unknown ? a.unknown < b.unknown : !a.law && b.law;
  });
  std::vector<LawPtr> law(at(s.size()));
  for (const Hold& h : holds_) {
    s.active_[at(h.unknown)] = 0;
    law[at(h.unknown)] = h.law;
  }
  std::vector<unsigned char> follows(at(s.size()), 0);
  for (const FollowerDef& f : followers_)
    for (Index c = 0; c < (f.pinned ? 3 : 6); ++c)
      follows[at(6 * f.node + c)] = 1;
  std::vector<Index> row(at(s.nodes()), -1);
  for (Index k = 0; k < s.size(); ++k) {
    if (s.active_[at(k)] || follows[at(k)])
      row[at(k / 6)] = k / 6;
    else
      s.holds_.push_back({k, law[at(k)]});
    if (follows[at(k)]) s.active_[at(k)] = 0;
  }
  return row;
}

void Builder::freeze_pattern(const std::vector<Index>& row) {
  System& s = system_;
  std::vector<std::pair<Index, Index>> all, kept;
  for (const auto& term : s.terms_)
    term->list_couplings(all);
  if (!followers_.empty()) {
    std::vector<Vec3> positions;
    std::vector<Mat3> axes;
    for (const NodeDef& d : s.defs_) {
      positions.push_back(d.position);
      axes.push_back(s.charts_[at(d.line)]);
    }
    s.followers_.arrange(followers_, positions, axes, all);
  }
  for (auto [i, j] : all)
    if (row[at(i)] >= 0 && row[at(j)] >= 0) kept.emplace_back(i, j);
  s.pattern_ = std::make_unique<la::BlockPattern>(s.nodes(), kept);
  for (auto& term : s.terms_) {
    term->bind(*s.pattern_, row);
    term->list_links(s.links_);
  }
  s.followers_.bind(*s.pattern_);
  std::sort(s.links_.begin(), s.links_.end());
  s.links_.erase(std::unique(s.links_.begin(), s.links_.end()), s.links_.end());
  for (auto& term : s.terms_)
    term->bind_links(s.links_);
}

bool Builder::is_linear() const {
  const System& s = system_;
  bool linear = followers_.empty();
  for (const auto& term : s.terms_)
    linear = linear && term->linear_in_displacements();
  for (Index k = 0; k < s.size(); ++k)
    if (k % 6 >= 3 && s.active_[at(k)]) linear = false;
  return linear;
}

System Builder::finalize() {
  System& s = system_;
  s.active_.assign(at(s.size()), 1);
  for (const NodeDef& d : s.defs_) {
    s.line_of_.push_back(static_cast<int>(d.line));
    s.falling_.push_back(d.scalar ? 0.0 : 1.0);
  }
  hold_untouched();
  const std::vector<Index> row = apply_holds();
  freeze_pattern(row);
  s.linear_ = is_linear();
  for (std::size_t i = 0; i < s.terms_.size(); ++i)
    if (s.terms_[i]->cornered()) s.cornered_.push_back(i);
  s.list_exchanging();
  s.all_terms_.resize(s.terms_.size());
  std::iota(s.all_terms_.begin(), s.all_terms_.end(), std::size_t{0});
  s.everywhere_ = s.every_block();
  return std::move(system_);
}

void System::list_regions(const Workspace& w, std::vector<int>& out) const {
  WHIRL_EXPECTS(w.nodes.size() == at(nodes()));
  out.clear();
  for (std::size_t i : cornered_)
    terms_[i]->list_regions(w, out);
}

std::vector<double> System::breakpoints() const {
  std::vector<double> out;
  auto take = [&](const LawPtr& l) {
    if (l)
      for (double t : l->breakpoints())
        out.push_back(t);
  };
  for (const Hold& h : holds_)
    take(h.law);
  for (const LawPtr& l : base_)
    take(l);
  for (const auto& term : terms_)
    term->list_breakpoints(out);
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<Pace> System::paces() const {
  std::vector<Pace> out;
  const auto take = [&](const LawPtr& law) {
    for (const Pace& p : paces_of(law))
      out.push_back(p);
  };
  for (const Hold& h : holds_)
    take(h.law);
  for (const LawPtr& l : base_)
    take(l);
  return out;
}

bool System::relaxes() const {
  return std::any_of(terms_.begin(), terms_.end(), [](const auto& t) { return t->relaxes(); });
}

void System::relax(Workspace& w, const Frames& f, double t, Eigen::Ref<VecX> q,
                   Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a) const {
  if (!relaxes() || !evaluate_nodes(w, f, t, q, v, a)) return;
  for (const auto& term : terms_)
    if (term->relaxes()) term->relax(w, q);
}

State System::make_state() const {
  State s;
  s.q = s.v = s.a = VecX::Zero(size());
  s.frames.chart = charts_;
  s.frames.turns.assign(charts_.size(), 0.0);
  s.frames.of_node = line_of_;
  s.frames.kept = kept_;
  if (!followers_.empty()) {
    s.frames.joint.assign(followers_.count(), 0.0);
    follow(s);
    followers_.keep_turns(s.frames, s.q);
  }
  return s;
}

std::vector<Vec3> State::normals() const {
  std::vector<Vec3> d(frames.of_node.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    const Index node = static_cast<Index>(i);
    rotation::Director o;
    rotation::director(q.segment<2>(6 * node + gamma2), o);
    d[i] = frames.axes(node) * (o.t + Vec3::UnitX());
  }
  return d;
}

double State::total_phi(Index node, Index line) const {
  WHIRL_EXPECTS(line >= 0 && at(line) < frames.turns.size());
  WHIRL_EXPECTS(node >= 0 && 6 * node < q.size());
  const double phi = q[6 * node + spin_phi];
  const double turns = two_pi * frames.turns[at(line)];
  if (!frames.moved()) return phi + turns;
  rotation::Director o;
  rotation::director(q.segment<2>(6 * node + gamma2), o);
  const Vec3 d = frames.axes(node) * (o.t + Vec3::UnitX());
  return phi + frames.own_angle(node, line, d) + turns;
}

Workspace System::make_workspace() const {
  Workspace w;
  const std::size_t n = at(nodes());
  w.nodes.resize(n);
  w.D.resize(n);
  w.D_rate.resize(n);
  w.D_accel.resize(n);
  w.director.resize(n);
  w.force.resize(n);
  w.kept = kept_;
  if (!kept_.empty())
    for (NodeState& node : w.nodes)
      node.kept = w.kept.data();
  return w;
}

void System::make_tangents(Workspace& w) const {
  for (la::BlockMatrix<7>* m : {&w.M, &w.C, &w.K})
    if (m->value_count() == 0) *m = la::BlockMatrix<7>(*pattern_);
}

void System::settle_kept(const Workspace& w, std::vector<double>& values) const {
  values.resize(kept_.size());
  for (const Keeper& k : keepers_)
    k.settle(w, std::span(values).subspan(k.first, k.count));
}

std::size_t Builder::keep(Keeper k, std::span<const double> at_first) {
  WHIRL_EXPECTS(k.settle != nullptr);
  k.first = system_.kept_.size();
  k.count = at_first.size();
  system_.keepers_.push_back(std::move(k));
  system_.kept_.insert(system_.kept_.end(), at_first.begin(), at_first.end());
  return system_.keepers_.back().first;
}

Vec3 System::gravity_at(double t) const {
  Vec3 g = gravity_;
  for (int k = 0; k < 3; ++k)
    if (base_[at(k)]) g[k] -= base_[at(k)]->at(t).f;
  return g;
}

void System::impose(const Frames& f, double t, Eigen::Ref<VecX> q, Eigen::Ref<VecX> v,
                    Eigen::Ref<VecX> a) const {
  WHIRL_EXPECTS(q.size() == size() && v.size() == size() && a.size() == size());
  WHIRL_EXPECTS(f.turns.size() == at(lines()));
  for (const Hold& h : holds_) {
    if (!h.law) {
      q[h.unknown] = v[h.unknown] = a[h.unknown] = 0.0;
      continue;
    }
    const LawValue x = h.law->at(t);
    q[h.unknown] = x.f;
    v[h.unknown] = x.df;
    a[h.unknown] = x.ddf;
    if (h.unknown % 6 == spin_phi)
      q[h.unknown] -= two_pi * f.turns[at(defs_[at(h.unknown / 6)].line)];
  }
  follow(f, q, v, a);
}

bool System::evaluate_nodes(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                            Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a,
                            std::span<const Index> only) const {
  WHIRL_EXPECTS(q.size() == size() && v.size() == size() && a.size() == size());
  WHIRL_EXPECTS(w.nodes.size() == at(nodes()) && f.of_node.size() == at(nodes()));
  static_assert(sizeof(Mat32) == 6 * sizeof(double));
  w.context.time = t;
  w.context.gravity = w.context.load * gravity_at(t);
  WHIRL_EXPECTS(f.kept.size() == kept_.size());
  for (std::size_t i = 0; i < f.kept.size(); ++i)
    w.kept[i] = f.kept_at(i, t);
  lanes::Motion m;
  m.count = only.empty() ? nodes() : static_cast<Index>(only.size());
  if (!only.empty()) m.nodes = only.data();
  if (followers_.empty()) {
    m.q = q.data();
    m.v = v.data();
    m.a = a.data();
  } else {
    w.q = q;
    w.v = v;
    w.a = a;
    if (!followers_.follow(f, w.q, w.v, w.a)) return false;
    m.q = w.q.data();
    m.v = w.v.data();
    m.a = w.a.data();
  }
  m.line = line_of_.data();
  m.axes = f.of_node.data();
  m.falling = falling_.data();
  m.chart = f.chart.data()->data();
  m.turns = f.turns.data();
  for (int k = 0; k < 3; ++k)
    m.gravity[k] = w.context.gravity[k];
  m.limit_squared = rotation::chart_limit * rotation::chart_limit;
  m.state = w.nodes.data()->u.data();
  m.D = w.D.data()->data();
  w.charts.resize(f.chart.size());
  std::copy_n(f.chart.data()->data(), 9 * f.chart.size(), w.charts.data()->data());
  if (f.moved() || !w.on_lines) {
    for (std::size_t i = 0; i < w.nodes.size(); ++i)
      w.nodes[i].chart = &w.charts[static_cast<std::size_t>(f.of_node[i])];
    w.on_lines = !f.moved();
  }
  static const lanes::Kernels& kernels = lanes::kernels();
  w.outside = m.count > 0 ? kernels.evaluate(m) : -1;
  w.own.clear();
  w.own_carried.clear();
  if (w.outside < 0 && f.moved()) {
    w.frames = f;
    evaluate_own_axes(w);
  }
  return w.outside < 0;
}

void System::list_exchanging() {
  exchanging_.clear();
  const bool carried = !followers_.empty();
  const bool all_weights = base_[0] || base_[1] || base_[2];  // field_power
  if (carried || all_weights) return;
  for (const auto& term : terms_)
    if (!term->powerless()) term->list_nodes(exchanging_);
  std::sort(exchanging_.begin(), exchanging_.end());
  exchanging_.erase(std::unique(exchanging_.begin(), exchanging_.end()), exchanging_.end());
  if (2 * exchanging_.size() > at(nodes())) exchanging_.clear();
}

void System::evaluate_own_axes(Workspace& w) const {
  const Frames& f = w.frames;
  WHIRL_EXPECTS(f.moved() && f.shift.size() == at(nodes()));
  w.own = w.nodes;
  w.own_carried.resize(w.nodes.size());
  for (std::size_t i = 0; i < w.own.size(); ++i) {
    const Index node = static_cast<Index>(i);
    if (f.of_node[i] == line_of_[i]) continue;
    const Mat3& own = w.charts[static_cast<std::size_t>(line_of_[i])];
    NodeState& n = w.own[i];
    const Vec3 d = n.d();
    w.own_carried[i] = AngleTransport(n.e(), own.col(0)).at(d, n.dd, n.ddd);
    carry(n, w.own_carried[i], f.own_angle(node, line_of_[i], d), own);
  }
}

void System::evaluate_jacobians(Workspace& w, Eigen::Ref<const VecX> q, Eigen::Ref<const VecX> v,
                                Eigen::Ref<const VecX> a, std::span<const Index> of) const {
  WHIRL_EXPECTS(w.outside < 0);
  for (const Index i : of) {
    const Mat3& E = *w.nodes[at(i)].chart;
    rotation::Director& dir = w.director[at(i)];
    rotation::director(q.segment<2>(6 * i + 4), v.segment<2>(6 * i + 4), a.segment<2>(6 * i + 4),
                       dir);
    w.D_rate[at(i)].noalias() = E * dir.D_rate;
    w.D_accel[at(i)].noalias() = E * dir.D_accel;
  }
}

void System::project_force(const Workspace& w, Eigen::Ref<VecX> r) const {
  WHIRL_EXPECTS(w.force.size() == at(nodes()));
  WHIRL_EXPECTS(r.size() == size());
  for (Index i = 0; i < nodes(); ++i) {
    const Vector<7>& f = w.force[at(i)];
    r.segment<3>(6 * i) = f.head<3>();
    r[6 * i + 3] = f[6];
    r.segment<2>(6 * i + 4).noalias() = w.D[at(i)].transpose() * f.segment<3>(3);
  }
}

void System::loads_into(Workspace& w, const Frames& f, Eigen::Ref<VecX> r) const {
  VecX& loads = w.loads;
  loads.setZero(size());
  followers_.carry_force(w, f, loads);
  project_force(w, r);
  for (std::size_t k = 0; k < followers_.count(); ++k) {
    const Index i = 6 * followers_[k].node, entries = followers_[k].pinned ? 3 : 6;
    r.segment(i, entries) = loads.segment(i, entries);
  }
}

bool System::residual(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                      Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, Eigen::Ref<VecX> r,
                      Selection only) const {
  if (!evaluate_nodes(w, f, t, q, v, a)) return false;
  for (auto& x : w.force)
    x.setZero();
  if (only)
    for (std::size_t k : *only)
      terms_[k]->add_force(w);
  else
    for (const auto& term : terms_)
      term->add_force(w);
  if (followers_.empty())
    project_force(w, r);
  else
    loads_into(w, f, r);
  return r.allFinite();
}

System::Blocks System::every_block() const {
  Blocks out;
  out.nodes.resize(at(nodes()));
  std::iota(out.nodes.begin(), out.nodes.end(), Index{0});
  out.slots.resize(at(pattern_->blocks()));
  std::iota(out.slots.begin(), out.slots.end(), Index{0});
  return out;
}

System::Blocks System::blocks_of(const std::vector<std::size_t>& terms) const {
  if (!followers_.empty()) return everywhere_;
  std::vector<unsigned char> touched(at(nodes()), 0);
  std::vector<Index> of_term;
  for (const std::size_t k : terms) {
    of_term.clear();
    terms_[k]->list_nodes(of_term);
    for (const Index i : of_term)
      touched[at(i)] = 1;
  }
  Blocks out;
  for (Index i = 0; i < nodes(); ++i) {
    if (!touched[at(i)]) continue;
    out.nodes.push_back(i);
    for (Index s = pattern_->row_start()[at(i)]; s < pattern_->row_start()[at(i) + 1]; ++s)
      if (touched[at(pattern_->cols()[at(s)])]) out.slots.push_back(s);
  }
  return out;
}

bool System::tangent(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                     Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, la::MCK& out,
                     Selection only) const {
  return tangent_blocks(w, f, t, q, v, a, out, only ? *only : all_terms_, everywhere_);
}

bool System::tangent_blocks(Workspace& w, const Frames& f, double t, Eigen::Ref<const VecX> q,
                            Eigen::Ref<const VecX> v, Eigen::Ref<const VecX> a, la::MCK& out,
                            const std::vector<std::size_t>& only, const Blocks& where) const {
  WHIRL_EXPECTS(out.M.value_count() == at(36 * pattern_->blocks()));
  WHIRL_EXPECTS(out.C.value_count() == out.M.value_count() &&
                out.K.value_count() == out.M.value_count());
  if (!evaluate_nodes(w, f, t, q, v, a)) return false;
  if (followers_.empty())
    evaluate_jacobians(w, q, v, a, where.nodes);
  else
    evaluate_jacobians(w, w.q, w.v, w.a, where.nodes);
  for (const Index i : where.nodes)
    w.force[at(i)].setZero();
  make_tangents(w);
  for (la::BlockMatrix<7>* m : {&w.M, &w.C, &w.K})
    for (const Index s : where.slots)
      m->block(s).setZero();
  for (const std::size_t k : only) {
    terms_[k]->add_force(w);
    terms_[k]->add_tangent(w);
  }
  if (!followers_.empty()) followers_.carry_tangent(w, f);
  project_tangent(w, out, where);
  return true;
}

void System::project_tangent(const Workspace& w, la::MCK& out, const Blocks& where) const {
  const auto& start = pattern_->row_start();
  const auto& cols = pattern_->cols();
  auto slot = where.slots.begin();
  for (const Index i : where.nodes) {
    const Mat32& Di = w.D[at(i)];
    for (; slot != where.slots.end() && *slot < start[at(i) + 1]; ++slot) {
      const Index s = *slot;
      const std::size_t j = at(cols[at(s)]);
      const double *M = w.M.block(s).data(), *C = w.C.block(s).data(), *K = w.K.block(s).data();
      const Mat32 &D = w.D[j], &D1 = w.D_rate[j], &D2 = w.D_accel[j];
      project_block(Di, M, out.M.block(s).data(), [&](int k, int r) {
        return D(0, k) * M[21 + r] + D(1, k) * M[28 + r] + D(2, k) * M[35 + r];
      });
      project_block(Di, C, out.C.block(s).data(), [&](int k, int r) {
        double y = 0.0;
        for (int b = 0; b < 3; ++b)
          y += D(b, k) * C[21 + 7 * b + r] + 2.0 * D1(b, k) * M[21 + 7 * b + r];
        return y;
      });
      project_block(Di, K, out.K.block(s).data(), [&](int k, int r) {
        double y = 0.0;
        for (int b = 0; b < 3; ++b)
          y += D(b, k) * K[21 + 7 * b + r] + D1(b, k) * C[21 + 7 * b + r] +
               D2(b, k) * M[21 + 7 * b + r];
        return y;
      });
    }
    out.K.block(pattern_->diagonal(i)).bottomRightCorner<2, 2>() += w.director[at(i)].curvature(
        w.nodes[at(i)].chart->transpose() * w.force[at(i)].segment<3>(3));
  }
}

Energy System::exchange(const Workspace& w) const {
  WHIRL_EXPECTS(w.nodes.size() == at(nodes()));
  Energy e;
  for (const auto& term : terms_)
    if (!term->powerless()) term->add_energy(w, w.context, e);
  e.supplied += field_power(w);
  return e;
}

Energy System::energy(const Workspace& w) const {
  WHIRL_EXPECTS(w.nodes.size() == at(nodes()));
  Energy e;
  for (const auto& term : terms_)
    term->add_energy(w, w.context, e);
  e.supplied += field_power(w);
  return e;
}

double System::field_power(const Workspace& w) const {
  if (!base_[0] && !base_[1] && !base_[2]) return 0.0;
  Context c = w.context;
  c.gravity.setZero();
  for (int k = 0; k < 3; ++k)
    if (base_[at(k)]) c.gravity[k] = -c.load * base_[at(k)]->at(c.time).df;
  Energy e;  // the potential is linear in gravity
  for (const auto& term : terms_)
    term->add_energy(w, c, e);
  return e.gravity;
}

}  // namespace whirl::system
