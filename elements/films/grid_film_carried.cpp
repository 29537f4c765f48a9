// Films on a grid that conserve mass: ruptured nodes carry on what flows into them.
//
// Flows lack what is not dragged: past the face behind node k, downstream, goes
//   S (c h + int D/h^3 / int 1/h^3) - dP/r - lacking_k
// of which a node with film lacks nothing, and a ruptured one has no pressure. With A and b of Reynolds'
// film the balance of every node is A P + lacking_upstream - lacking_k = b_k, that of a
// complementarity problem in (P, lacking) whose matrices, a column of film or of rupture each, are all
// M-matrices but for one coupling in eight (as grid_film.hpp): one solution. It is found by exchanging
// all nodes of the wrong sign at once, and where that does not get nearer, one after the other, which
// ends (J. J. Judice, F. M. Pires, Comput. Oper. Res. 21, 1994, doi 10.1016/0305-0548(94)90106-6).
//
// Walls that part or close, W.n beside the wedge of a journal that stands, squeeze what is full. Oil
// between them and bubbles gives way, so that the content which ruptured film carries on is that of the
// momentary state. Where film lacks little of its flow, next to where it is full, the squeeze counts in
// the proportion of what is not lacking, as if the share of the oil stayed: a little is twice the
// motion over the drag, of the flow. Small motions do not feel that (it is of second order); large ones
// would have several films, or none, without it.
#include <elements/films/grid_solver.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::elements {

void GridPad::Solver::add_dragged(Dragged& to, std::size_t f, const Piece& piece) const {
  const double angle = pad_.start_ + (f < n_ ? pad_.cells_[f].from : pad_.cells_[n_ - 1].to);
  const double cos = std::cos(angle), sin = std::sin(angle);
  const Stretch x = face(f, piece.band);
  const double mean = x.s / x.r, by = std::abs(in_.source[2]) * piece.share;
  to.value += by * (in_.clearance * (1.0 - in_.e.x() * cos - in_.e.y() * sin) + mean);
  if (!slopes_) return;
  to.by += by * ((x.ds - mean * x.dr) / x.r - in_.clearance * Vec3(cos, sin, 0.0));
}

GridPad::Solver::Dragged GridPad::Solver::dragged(std::size_t f, std::size_t j) const {
  Dragged out;
  for (const Piece& piece : pieces(j))
    add_dragged(out, f, piece);
  return out;
}

GridPad::Solver::Dragged GridPad::Solver::dragged_at_side(std::size_t f) const {
  Dragged out;
  add_dragged(out, f, {bands_ - 1, pad_.side_share_});
  return out;
}

/// Of the source of node k what is not the wedge of a journal that stands.
double GridPad::Solver::squeeze(std::size_t k) const {
  return Vec2(B_[0][k], B_[1][k]).dot(motion());
}

/// The motion beside that of a journal that stands, m/s.
Vec2 GridPad::Solver::motion() const {
  const double drag = in_.source[2] * in_.clearance;
  return Vec2(in_.source[0] - drag * in_.e.y(), in_.source[1] + drag * in_.e.x());
}

/// Of the gap's flow: as little as ruptured film may lack and still feel all of the squeeze.
double GridPad::Solver::shallow() const {
  constexpr double of_motion = 2.0, rounding = 1e-10;
  const double share = of_motion * motion().norm() / std::abs(in_.source[2] * in_.clearance);
  return share > rounding ? share : 0.0;
}

/// What of the squeeze of the node behind is handed on with what k lacks: a share of that where it is
/// less than `limit_`, all of the squeeze beyond. Walls that part leave no flow where there is none.
void GridPad::Solver::add_handed_on() {
  const double least = shallow();
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j), to = downstream(k);
      const double squeezed = known(to) ? 0.0 : squeeze(to);
      const double limit =
          (squeezed < 0.0 ? std::min(1.0, least) : least) * dragged(forward() ? i + 1 : i, j).value;
      const double share = limit > 0.0 ? squeezed / limit : 0.0;
      limit_[k] = share > -1.0 ? limit : infinity;
      shared_[k] = std::max(share, -1.0);
      beyond_[k] = 0;
    }
}

/// What is handed on of what node k lacks: as much, or with the squeeze of the node behind.
double GridPad::Solver::handed_on(std::size_t k) const {
  return beyond_[k] ? 1.0 : 1.0 + shared_[k];
}

void GridPad::Solver::couple_carried() {
  for (std::size_t k = 0; k < size_; ++k) {
    if (!ruptured(k)) continue;
    entry(k, k) += 1.0;
    if (!known(downstream(k))) entry(downstream(k), k) -= handed_on(k);
  }
  // what a node lacks in which the film ends, (1 - s)/2 lost - past_front P
  for_each_parted(
      [&](std::size_t k, std::size_t to) { entry(to, k) -= handed_on(k) * past_front(k); });
  for_each_link_of_parted([&](std::size_t k, std::size_t l, std::size_t to, double by) {
    entry(to, k) += by;
    if (wet(l) && in_band(to, l)) entry(to, l) -= by;
  });
}

/// see(k, to): the film ends at k, and what it lacks goes on to node `to`.
template <class See>
void GridPad::Solver::for_each_parted(const See& see) const {
  for (std::size_t k = 0; k < size_; ++k)
    if (parted(k) && !known(downstream(k))) see(k, downstream(k));
}

/// see(k, l, to, by): as for_each_parted, with the neighbours l across the arc and the share of their
/// link that is handed on.
template <class See>
void GridPad::Solver::for_each_link_of_parted(const See& see) const {
  for_each_link_across([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    for (const auto& [own, far] : {std::pair{k, l}, std::pair{l, k}}) {
      if (!parted(own) || known(downstream(own))) continue;
      see(own, far, downstream(own), handed_on(own) * unmet(own) * by);
    }
  });
}

/// What of that is out of the band, by the pressures of the pass before.
void GridPad::Solver::find_late() {
  std::fill_n(late_.begin(), size_, 0.0);
  for_each_link_of_parted([&](std::size_t, std::size_t l, std::size_t to, double by) {
    if (wet(l) && !in_band(to, l)) late_[to] += by * P_[l];
  });
}

/// Where P_ is stands P of film, and less what ruptured nodes lack.
void GridPad::Solver::solve_carried() {
  find_late();
  clear_matrix();
  couple_film();
  couple_carried();
  factor();
  for (std::size_t k = 0; k < size_; ++k)
    P_[k] = open_[k] ? in_.edge : along_in_[k] + share(k) * across_in_[k] + late_[k];
  for (std::size_t k = 0; k < size_; ++k) {
    const std::size_t to = downstream(k);
    if (film_[k] && !parted(k)) continue;
    if (open_[k] || known(to)) continue;
    if (parted(k)) P_[to] += handed_on(k) * unmet(k) * across_in_[k];
    if (beyond_[k]) P_[to] -= squeeze(to);
  }
  solve(P_.data());
}

/// What node k lacks, its P_ that of solve_carried.
double GridPad::Solver::lacking(std::size_t k) const {
  if (open_[k]) return 0.0;
  if (!film_[k]) return std::max(0.0, -P_[k]);
  if (!may_part(k) || lost_[k] <= 0.0) return 0.0;
  const double off = 1.0 - reach(k);
  return 0.5 * lost_[k] * off * off;
}

/// Fronts where the pressures place them. False: where they were.
bool GridPad::Solver::move_fronts(double rounding) {
  bool moved = false;
  for (std::size_t k = 0; k < size_; ++k) {
    if (!film_[k] || P_[k] <= 0.0) continue;
    const double s = reach(k), off = s - reach_[k];
    moved = moved || 0.5 * lost_[k] * off * off > rounding * reach_[k];
    reach_[k] = s;
  }
  const std::array<double, most>& before = inflow_;
  std::copy_n(late_.begin(), size_, inflow_.begin());
  find_late();
  for (std::size_t k = 0; k < size_; ++k)
    moved = moved || std::abs(late_[k] - before[k]) > rounding;
  return moved;
}

/// False: it does not settle.
bool GridPad::Solver::settle_carried(double rounding) {
  constexpr int most_passes = 400, most_spare = 10;
  std::size_t fewest = size_ + 1;
  int spare = most_spare;
  for (int pass = 0; pass < most_passes; ++pass) {
    solve_carried();
    find_flows();
    const auto fills = [&](std::size_t k) {
      return film_[k] ? P_[k] > 0.0 : P_[k] + least_lacking(k) > rounding;
    };
    const auto lacks_much = [&](std::size_t k) { return lacking(k) >= limit_[k] - rounding; };
    const auto turns = [&](std::size_t k) {
      const bool some = !film_[k] || (P_[k] > 0.0 && reach(k) < 1.0);
      return some && limit_[k] > 0.0 && lacks_much(k) != (beyond_[k] != 0);
    };
    const auto wrong = [&](std::size_t k) {
      if (open_[k]) return false;
      return fills(k) != (film_[k] != 0) || turns(k);
    };
    std::size_t found = 0, last = 0;
    for (std::size_t k = 0; k < size_; ++k)
      if (wrong(k)) {
        ++found;
        last = k;
      }
    const bool nearer = found < fewest;
    if (nearer) fewest = found;
    if (found > 0) spare = nearer ? most_spare : spare - 1;
    const bool all = spare >= 0;
    for (std::size_t k = 0; k < size_ && found > 0; ++k)
      if (all ? wrong(k) : k == last) {
        const bool film = fills(k);
        if (turns(k)) beyond_[k] = lacks_much(k) ? 1 : 0;
        if (film && !film_[k]) reach_[k] = first_reach(k, -P_[k]);
        if (!film) reach_[k] = 1.0;
        if (film == (film_[k] != 0)) continue;
        film_[k] = film ? 1 : 0;
        P_[k] = 0.0;
      }
    if (!move_fronts(rounding) && found == 0) return true;
  }
  return false;
}

void GridPad::Solver::find_carried() {
  constexpr double rounding = 1e-13;  // of the largest source
  double size = 0.0;
  for (std::size_t k = 0; k < size_; ++k)
    size = std::max(size, std::abs(along_in_[k] + across_in_[k]));
  if (bands_ == 1)
    guess_film();
  else
    fill_all();
  std::fill_n(P_.begin(), size_, 0.0);
  add_handed_on();
  const bool settled = settle_carried(rounding * size);
  for (std::size_t k = 0; k < size_; ++k)
    lacking_[k] = lacking(k);
  for (std::size_t k = 0; k < size_; ++k)
    if (ruptured(k)) P_[k] = 0.0;
  if (!settled) P_[0] = nan;  // as find_film
}

/// see(i, j, k, before, behind): k ruptured in part at least, with what would be dragged past the faces
/// of its cell, in the sense of the journal.
template <class See>
void GridPad::Solver::for_each_ruptured_cell(const See& see) const {
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j);
      if (!ruptured(k) && !parted(k)) continue;
      see(i, j, k, dragged(forward() ? i : i + 1, j), dragged(forward() ? i + 1 : i, j));
    }
}

/// The node behind which the cell of k begins as ruptured; a film that forms begins full.
std::size_t GridPad::Solver::ruptured_before(std::size_t k) const {
  return ruptured(k) || !ruptured(upstream(k)) ? upstream(k) : groove;
}

/// see(i, before, behind, passed_before, passed_behind): at the side, where no pressure is, the least
/// that was dragged on the way is what there is.
template <class See>
void GridPad::Solver::for_each_cell_at_side(const See& see) const {
  Dragged before = dragged_at_side(forward() ? 0 : n_), passed = before;
  for (std::size_t step = 0; step < n_; ++step) {
    const std::size_t i = forward() ? step : n_ - 1 - step;
    const Dragged behind = dragged_at_side(forward() ? i + 1 : i);
    const Dragged next = behind.value < passed.value ? behind : passed;
    see(i, before, behind, passed, next);
    before = behind;
    passed = next;
  }
}

/// int int mu f_s/h over the part that oil wets: of a ruptured cell the mean of what passes its faces
/// over the mean of what would be dragged past them.
double GridPad::Solver::shear_carried() const {
  double out = shear_;
  for_each_ruptured_cell([&](std::size_t i, std::size_t j, std::size_t k, const Dragged& before,
                             const Dragged& behind) {
    const double full = before.value + behind.value;
    const double dry = std::min(1.0, (deficit(ruptured_before(k)) + deficit(k)) / full);
    for (const Piece& x : pieces(j))
      out -= dry * x.share * walls_[i * bands_ + x.band];
  });
  for_each_cell_at_side([&](std::size_t i, const Dragged& before, const Dragged& behind,
                            const Dragged& passed, const Dragged& next) {
    const double full = before.value + behind.value, dry = full - passed.value - next.value;
    out -= dry / full * pad_.side_share_ * walls_[i * bands_ + bands_ - 1];
  });
  return out;
}

/// From shear (of the column before a face), gaps and flows what they count of ruptured gaps. To driven
/// comes what the journal loses where oil is dragged from a ruptured node against the pressure of the
/// next one: that which is lacking is lost in filling the gap.
void GridPad::Solver::take_out_dry(std::vector<double>& shear, std::vector<double>& driven,
                                   GridField& out) const {
  const auto take = [&](std::size_t i, std::size_t band, double share) {
    shear[i + 1] -= share * walls_[i * bands_ + band];
    for (std::size_t q = 0; q < 4; ++q) {
      const Point& x = pad_.cells_[i].points[q];
      const double h =
          1.0 - in_.e.x() * x.cos - in_.e.y() * x.sin + pad_.depth(i, band)[q] / in_.clearance;
      out.gap[i] -= 0.25 * share * h;
      out.conducting[i] -= 0.25 * share / h;
    }
  };
  for_each_ruptured_cell([&](std::size_t i, std::size_t j, std::size_t k, const Dragged& before,
                             const Dragged& behind) {
    const double full = before.value + behind.value;
    const double dry = std::min(1.0, (deficit(ruptured_before(k)) + deficit(k)) / full);
    for (const Piece& x : pieces(j))
      take(i, x.band, dry * x.share);
    out.filled[forward() ? i + 1 : i] -= (forward() ? 1.0 : -1.0) * deficit(k);
    const std::size_t next = forward() ? std::min(i + 1, n_ - 1) : std::max<std::size_t>(i, 1) - 1;
    driven[next + 1] += pressure(downstream(k)) * deficit(k);
  });
  for_each_cell_at_side([&](std::size_t i, const Dragged& before, const Dragged& behind,
                            const Dragged& passed, const Dragged& next) {
    const double full = before.value + behind.value, dry = full - passed.value - next.value;
    take(i, bands_ - 1, dry / full * pad_.side_share_);
    out.filled[forward() ? i + 1 : i] -= (forward() ? 1.0 : -1.0) * (behind.value - next.value);
  });
}

/// Right side of the adjoint of the shear, and what changes it at given pressures.
void GridPad::Solver::add_shear_slopes(LoadSlopes& to) {
  adjoint(3).fill(0.0);
  std::fill_n(shear_by_lacking_.begin(), size_, 0.0);
  to.by.row(3) += dshear_.transpose();
  for_each_ruptured_cell([&](std::size_t i, std::size_t j, std::size_t k, const Dragged& before,
                             const Dragged& behind) {
    const double full = before.value + behind.value;
    const double dry = (deficit(ruptured_before(k)) + deficit(k)) / full;
    for (const Piece& x : pieces(j)) {
      const std::size_t g = i * bands_ + x.band;
      const double walls = x.share * walls_[g];
      if (dry > 1.0) {
        to.by.row(3) -= x.share * dwalls_[g].transpose();
        continue;
      }
      to.by.row(3) +=
          (walls * dry / full * (before.by + behind.by) - dry * x.share * dwalls_[g]).transpose();
      to.by_source(3, 2) += walls * dry / in_.source[2];
      for (const std::size_t n : {k, ruptured_before(k)}) {
        if (ruptured(n)) adjoint(3)[n] += walls / full;
        if (parted(n)) shear_by_lacking_[n] -= walls / full;
      }
    }
  });
  for_each_cell_at_side([&](std::size_t i, const Dragged& before, const Dragged& behind,
                            const Dragged& passed, const Dragged& next) {
    const std::size_t g = i * bands_ + bands_ - 1;
    const double full = before.value + behind.value, wet = (passed.value + next.value) / full;
    const Vec3 dwet = (passed.by + next.by - wet * (before.by + behind.by)) / full;
    to.by.row(3) += pad_.side_share_ * (walls_[g] * dwet - (1.0 - wet) * dwalls_[g]).transpose();
  });
  for (std::size_t k = 0; k < size_; ++k)
    if (parted(k)) adjoint(3)[k] -= shear_by_lacking_[k] * past_front(k);
  for_each_link_across([&](std::size_t k, std::size_t l, double by, std::size_t, std::size_t) {
    for (const auto& [own, far] : {std::pair{k, l}, std::pair{l, k}}) {
      if (!parted(own)) continue;
      const double lost = shear_by_lacking_[own] * unmet(own) * by;
      adjoint(3)[own] += lost;
      if (wet(far)) adjoint(3)[far] -= lost;
    }
  });
}

/// What changes in the squeeze that ruptured nodes hand on. @pre the adjoints are known.
void GridPad::Solver::add_slopes_of_squeeze(LoadSlopes& to) {
  const double S = in_.source[2], least = shallow();
  const Vec2 w = motion(), e = in_.e;
  for (std::size_t i = 0; i < n_; ++i)
    for (std::size_t j = 0; j < m_; ++j) {
      const std::size_t k = at(i, j), next = downstream(k);
      if (known(next) || (!ruptured(k) && !parted(k))) continue;
      const Vec2 n(B_[0][next], B_[1][next]);
      Vec2 by_motion = n;  // of the squeeze, or of the share times what k lacks
      Vec3 by_gap = Vec3::Zero();
      double by_S = 0.0;
      if (!beyond_[k] && limit_[k] > 0.0) {
        if (shared_[k] == -1.0) continue;
        const Dragged full = dragged(forward() ? i + 1 : i, j);
        // the limit goes with the motion, or with S
        const bool follows = least < 1.0 || shared_[k] >= 0.0;
        if (follows) by_motion -= n.dot(w) / w.squaredNorm() * w;
        by_motion *= lacking_[k] / limit_[k];
        by_gap = -lacking_[k] * shared_[k] / full.value * full.by;
        if (!follows) by_S = -lacking_[k] * shared_[k] / S;
      }
      // w = W - S c (e_z, -e_y)
      const Vec2 across = in_.clearance * Vec2(by_motion.y(), -by_motion.x());
      for (int load = 0; load < 4; ++load) {
        const double by = -adjoint(load)[next];
        to.by_source.row(load).head<2>() += by * by_motion.transpose();
        to.by_source(load, 2) += by * (across.dot(e) + by_S);
        to.by.row(load).head<2>() += by * S * across.transpose();
        to.by.row(load) += by * by_gap.transpose();
      }
    }
}

/// Flow past every face, out at the sides and into open recesses; inside of these, and between them and
/// a groove, that of the film before or behind.
void GridPad::Solver::add_carried_flow(GridField& out) const {
  const double sense = forward() ? 1.0 : -1.0;
  out.flow.assign(n_ + 1, 0.0);
  for (std::size_t f = 0; f <= n_; ++f)
    out.face_place.push_back(f < n_ ? pad_.cells_[f].from : pad_.cells_[n_ - 1].to);
  std::array<double, most_columns + 1> flow;
  for (std::size_t j = 0; j < m_; ++j) {
    for (std::size_t f = 0; f <= n_; ++f) {
      const std::size_t l = node(left_of(f), j), r = node(right_of(f), j);
      flow[f] = sense * (dragged(f, j).value - deficit(forward() ? l : r)) -
                along_[f * m_ + j] * (pressure(r) - pressure(l));
    }
    for (std::size_t i = 0; i < n_;) {
      std::size_t end = i;
      while (end < n_ && open_[at(end, j)])
        ++end;
      if (end == i) {
        ++i;
        continue;
      }
      // cells i to end are open
      const bool begins = i == 0, ends = end == n_;
      const double passes = begins && ends ? 0.0 : begins ? flow[end] : flow[i];
      if (!begins && !ends) out.into_open += flow[i] - flow[end];
      for (std::size_t f = begins ? 0 : i + 1; f < (ends ? n_ + 1 : end); ++f)
        flow[f] = passes;
      i = end;
    }
    for (std::size_t f = 0; f <= n_; ++f)
      out.flow[f] += flow[f];
  }
  for_each_cell_at_side([&](std::size_t i, const Dragged&, const Dragged&, const Dragged& passed,
                            const Dragged& next) {
    out.flow[forward() ? i + 1 : i] += sense * next.value;
    if (i == (forward() ? 0 : n_ - 1)) out.flow[forward() ? 0 : n_] += sense * passed.value;
    out.side += passed.value - next.value;
  });
  for (std::size_t i = 0; i < n_; ++i)
    for (const Across& x : pad_.across_) {
      const std::size_t k = at(i, x.from), l = far_node(i, x);
      const double q =
          x.conductance * sections_[i * bands_ + x.band].g * (pressure(k) - pressure(l));
      if (l == side) out.side += q;
      if (l < side && open_[l] && !open_[k]) out.into_open += q;
      if (l < side && open_[k] && !open_[l]) out.into_open -= q;
    }
}

}  // namespace whirl::elements
