#include <core/contract.hpp>
#include <system/system.hpp>

#include <algorithm>

namespace whirl::system {

void carry(NodeState& n, const AngleTransport::At& carried, double turn, const Mat3& axes) {
  n.t = n.d() - axes.col(0);
  n.phi += turn;
  n.dphi += carried.slope.dot(n.dd);
  n.ddphi += carried.slope.dot(n.ddd) + carried.slope_rate.dot(n.dd);
  n.chart = &axes;
}

namespace {

/// From a force in (u, d, phi^) with phi^ = phi + Omega(d) to one in (u, d, phi): f_d += f_phi^
/// dOmega/dd. W = 7.
template <int N>
void bring_back_force(const std::array<const AngleTransport::At*, N>& carried, ForceX<7 * N>& f) {
  for (int a = 0; a < N; ++a)
    if (const AngleTransport::At* at = carried[static_cast<std::size_t>(a)])
      f.template segment<3>(7 * a + 3) += f[7 * a + 6] * at->slope;
}

/// The same for tangents, by J = dX^/dX and its rates: M = J' M J, C = J' (C J + 2 M dJ/dt),
/// K = J' (K J + C dX^'/dX + M dX^''/dX) + f_phi^ d2Omega/dd2.
template <int N>
void bring_back_tangent(const std::array<const AngleTransport::At*, N>& carried,
                        const ForceX<7 * N>& f, TangentX<7 * N>& t) {
  for (int b = 0; b < N; ++b) {
    const AngleTransport::At* at = carried[static_cast<std::size_t>(b)];
    if (!at) continue;
    const int d = 7 * b + 3, phi = 7 * b + 6;
    t.K.template middleCols<3>(d) += t.K.col(phi) * at->slope.transpose() +
                                     t.C.col(phi) * at->slope_rate.transpose() +
                                     t.M.col(phi) * at->slope_accel.transpose();
    t.C.template middleCols<3>(d) +=
        t.C.col(phi) * at->slope.transpose() + 2.0 * t.M.col(phi) * at->slope_rate.transpose();
    t.M.template middleCols<3>(d) += t.M.col(phi) * at->slope.transpose();
  }
  for (int a = 0; a < N; ++a) {
    const AngleTransport::At* at = carried[static_cast<std::size_t>(a)];
    if (!at) continue;
    const int d = 7 * a + 3, phi = 7 * a + 6;
    for (Matrix<7 * N>* m : {&t.M, &t.C, &t.K})
      m->template middleRows<3>(d) += at->slope * m->row(phi);
    t.K.template block<3, 3>(d, d) += f[phi] * at->curvature;
  }
}

}  // namespace

std::array<NodeState, 2> seen_together(const System& system, const Workspace& w, Index first,
                                       Index second) {
  WHIRL_EXPECTS(at(first) < w.nodes.size() && at(second) < w.nodes.size());
  std::array<NodeState, 2> out{w.nodes[at(first)], w.nodes[at(second)]};
  if (!w.moved()) return out;
  const std::pair<Index, Index> pair = std::minmax(first, second);
  const auto links = system.links();
  const auto place = std::lower_bound(links.begin(), links.end(), pair);
  const std::size_t b = second > first ? 1 : 0;
  const Mat3& axes = *out[1 - b].chart;
  const AngleTransport::At carried =
      AngleTransport(out[b].e(), axes.col(0)).at(out[b].d(), out[b].dd, out[b].ddd);
  const bool linked = place != links.end() && *place == pair;
  const double link = linked ? w.frames.link[static_cast<std::size_t>(place - links.begin())] : 0.0;
  if (linked) carry(out[b], carried, link + carried.angle, axes);
  return out;
}

template <int N, int W>
void Elements<N, W>::list_couplings(std::vector<std::pair<Index, Index>>& out) const {
  for (const auto& n : nodes_)
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t b = a + 1; b < N; ++b)
        out.emplace_back(n[a], n[b]);
}

template <int N, int W>
void Elements<N, W>::list_nodes(std::vector<Index>& out) const {
  for (const auto& n : nodes_)
    out.insert(out.end(), n.begin(), n.end());
}

template <int N, int W>
void Elements<N, W>::bind(const la::BlockPattern& p, const std::vector<Index>& row) {
  WHIRL_EXPECTS(row.size() == at(p.size()));
  slots_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (std::size_t a = 0; a < N; ++a)
      for (std::size_t b = 0; b < N; ++b) {
        const Index ra = row[at(nodes_[i][a])], rb = row[at(nodes_[i][b])];
        slots_[i][a * N + b] = ra < 0 || rb < 0 ? -1 : p.slot(ra, rb);
      }
}

template <int N, int W>
void Elements<N, W>::list_links(std::vector<std::pair<Index, Index>>& out) const {
  if constexpr (N == 2)
    if (axes() == Axes::common)
      for (const auto& n : nodes_)
        out.push_back(std::minmax(n[0], n[1]));
}

template <int N, int W>
void Elements<N, W>::bind_links(std::span<const std::pair<Index, Index>> links) {
  WHIRL_EXPECTS(std::is_sorted(links.begin(), links.end()));
  links_.clear();
  if constexpr (N == 2)
    if (axes() == Axes::common)
      for (const auto& n : nodes_) {
        const std::pair<Index, Index> pair = std::minmax(n[0], n[1]);
        links_.push_back(std::lower_bound(links.begin(), links.end(), pair) - links.begin());
      }
}

template <int N, int W>
bool Elements<N, W>::stands(const Workspace& w, std::size_t i) const {
  WHIRL_EXPECTS(w.moved());
  const Frames& f = w.frames;
  if constexpr (N == 2)
    if (axes() == Axes::common)
      return f.same_axes(nodes_[i][0], nodes_[i][1]) && f.link[at(links_[i])] == 0.0;
  for (const Index n : nodes_[i])
    if (w.own[at(n)].chart != w.nodes[at(n)].chart) return false;
  return true;
}

template <int N, int W>
void Elements<N, W>::see(const Workspace& w, std::size_t i, Seen& out) const {
  out.x = gather(w, i);
  out.carried.fill(nullptr);
  if (axes() == Axes::any || !w.moved() || stands(w, i)) return;
  if constexpr (N == 2)
    if (axes() == Axes::common) {
      // the higher number in the axes of the lower
      const std::size_t b = nodes_[i][1] > nodes_[i][0] ? 1 : 0;
      const Mat3& axes = *out.x[1 - b]->chart;
      out.second = *out.x[b];
      const Vec3 d = out.second.d();
      const AngleTransport transport(out.second.e(), axes.col(0));
      out.second_carried = transport.at(d, out.second.dd, out.second.ddd);
      carry(out.second, out.second_carried, w.frames.link[at(links_[i])] + out.second_carried.angle,
            axes);
      out.x[b] = &out.second;
      out.carried[b] = &out.second_carried;
      return;
    }
  for (std::size_t a = 0; a < N; ++a) {
    const std::size_t n = at(nodes_[i][a]);
    if (w.own[n].chart == w.nodes[n].chart) continue;
    out.x[a] = &w.own[n];
    out.carried[a] = &w.own_carried[n];
  }
}

template <int N, int W>
void Elements<N, W>::scatter(const Matrix<N * W>& tangent, std::size_t i,
                             la::BlockMatrix<7>& into) const {
  std::size_t slot = 0;
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) {
      const Index s = slots_[i][slot++];
      if (s < 0) continue;
      into.block(s).template topLeftCorner<W, W>() += tangent.template block<W, W>(W * a, W * b);
    }
}

template <int N, int W>
void Elements<N, W>::add_force(Workspace& w) const {
  if (axes() != Axes::any && w.moved()) return add_forces_moved(w);
  if (forces_at_once(0, nodes_.size(), w)) return;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    ForceX<N* W> f = ForceX<N * W>::Zero();
    element_force(i, gather(w, i), w.context, f);
    for (std::size_t a = 0; a < N; ++a)
      w.force[at(nodes_[i][a])].template head<W>() +=
          f.template segment<W>(W * static_cast<Index>(a));
  }
}

template <int N, int W>
void Elements<N, W>::add_tangent(Workspace& w) const {
  if (axes() != Axes::any && w.moved()) return add_tangents_moved(w);
  const Parts has = parts();
  if (!has.M && !has.C && !has.K) return;
  TangentX<N * W> t;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (has.M) t.M.setZero();
    if (has.C) t.C.setZero();
    if (has.K) t.K.setZero();
    element_tangent(i, gather(w, i), w.context, t);
    if (has.M) scatter(t.M, i, w.M);
    if (has.C) scatter(t.C, i, w.C);
    if (has.K) scatter(t.K, i, w.K);
  }
}

template <int N, int W>
void Elements<N, W>::add_energy(const Workspace& w, const Context& c, Energy& e) const {
  const bool moved = axes() != Axes::any && w.moved();
  if (!moved && energies_at_once(w, c, e)) return;
  Seen seen;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (moved)
      see(w, i, seen);
    else
      seen.x = gather(w, i);
    element_energy(i, seen.x, c, e);
  }
}

template <int N, int W>
bool Elements<N, W>::sees_turning(const Context& c, std::span<const double> rate) const {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    std::array<double, N> of_nodes;
    for (std::size_t a = 0; a < N; ++a)
      of_nodes[a] = rate[at(nodes_[i][a])];
    const SeenAngle angle = element_dependence(i, c).angle;
    std::span<const double> seen(of_nodes);
    if (angle.form == SeenAngle::Form::sum)  // of two nodes at most
      seen = seen.first(std::min(seen.size(), angle.weight.size()));
    if (angle.changes(seen)) return true;
  }
  return false;
}

template <int N, int W>
void Elements<N, W>::add_forces_moved(Workspace& w) const {
  if constexpr (W == 7) {
    Seen seen;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      std::size_t last = i;
      while (last < nodes_.size() && stands(w, last))
        ++last;
      if (last > i && forces_at_once(i, last, w)) {
        i = last - 1;
        continue;
      }
      see(w, i, seen);
      ForceX<7 * N> f = ForceX<7 * N>::Zero();
      element_force(i, seen.x, w.context, f);
      bring_back_force<N>(seen.carried, f);
      for (std::size_t a = 0; a < N; ++a)
        w.force[at(nodes_[i][a])] += f.template segment<7>(7 * static_cast<Index>(a));
    }
  }
}

template <int N, int W>
void Elements<N, W>::add_tangents_moved(Workspace& w) const {
  if constexpr (W == 7) {
    Seen seen;
    TangentX<7 * N> t;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      see(w, i, seen);
      t.set_zero();
      element_tangent(i, seen.x, w.context, t);
      ForceX<7 * N> f = ForceX<7 * N>::Zero();
      element_force(i, seen.x, w.context, f);
      bring_back_tangent<N>(seen.carried, f, t);
      scatter(t.M, i, w.M);
      scatter(t.C, i, w.C);
      scatter(t.K, i, w.K);
    }
  }
}

template class Elements<1, 3>;
template class Elements<1, 7>;
template class Elements<2, 3>;
template class Elements<2, 7>;
template class Elements<3, 7>;
template class Elements<4, 7>;
template class Elements<5, 7>;
template class Elements<6, 7>;
template class Elements<7, 7>;
template class Elements<8, 7>;

}  // namespace whirl::system
