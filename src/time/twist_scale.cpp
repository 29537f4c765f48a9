#include <time/twist_scale.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::time {

void TwistScale::resize(std::span<const Kind> kinds, std::span<const TwistGroup> groups) {
  groups_.clear();
  std::size_t members = 0;
  for (const TwistGroup& g : groups) {
    WHIRL_EXPECTS(g.unknowns.size() == g.ratios.size());
    if (g.unknowns.size() < 2) continue;
    Group made;
    const double equal = 1.0 / static_cast<double>(g.unknowns.size());
    for (std::size_t i = 0; i < g.unknowns.size(); ++i) {
      made.members.push_back({g.unknowns[i], 1.0 / g.ratios[i], equal});
      if (kinds[at(g.unknowns[i])] == Kind::held) made.prescribed = true;
    }
    if (made.prescribed)
      for (Member& m : made.members)
        m.weight = kinds[at(m.unknown)] == Kind::held ? 1.0 : 0.0;
    members += made.members.size();
    groups_.push_back(std::move(made));
  }
  for (std::vector<double>* x : {&deviation_, &before_, &low_, &high_})
    x->assign(members, 0.0);
  swept_ = 0.0;
}

void TwistScale::reset() {
  for (std::vector<double>* x : {&deviation_, &before_, &low_, &high_})
    std::fill(x->begin(), x->end(), 0.0);
  swept_ = 0.0;
}

void TwistScale::set_inertia(CRef inertia) {
  for (Group& g : groups_) {
    double sum = 0.0;
    for (Member& m : g.members) {
      if (!g.prescribed) m.weight = std::abs(inertia[m.unknown]) / (m.per_ratio * m.per_ratio);
      sum += m.weight;
    }
    const double equal = 1.0 / static_cast<double>(g.members.size());
    for (Member& m : g.members)
      m.weight = sum > 0.0 && std::isfinite(sum) ? m.weight / sum : equal;
  }
}

double TwistScale::mean(const Group& g, CRef angles) {
  double sum = 0.0;
  for (const Member& m : g.members)
    sum += m.weight * angles[m.unknown] * m.per_ratio;
  return sum;
}

double TwistScale::size(CRef angles) const {
  double largest = 0.0;
  for (const Group& g : groups_) {
    const double middle = mean(g, angles);
    for (const Member& m : g.members)
      largest = std::max(largest, std::abs(angles[m.unknown] * m.per_ratio - middle));
  }
  return largest;
}

void TwistScale::observe(CRef q0, CRef q, bool again) {
  if (!again) before_ = deviation_;
  std::size_t k = 0;
  for (const Group& g : groups_) {
    double middle = 0.0;
    for (const Member& m : g.members)
      middle += m.weight * (q[m.unknown] - q0[m.unknown]) * m.per_ratio;
    for (const Member& m : g.members) {
      const double turned = (q[m.unknown] - q0[m.unknown]) * m.per_ratio;
      deviation_[k] = before_[k] + (turned - middle);
      low_[k] = std::min(low_[k], deviation_[k]);
      high_[k] = std::max(high_[k], deviation_[k]);
      swept_ = std::max(swept_, 0.5 * (high_[k] - low_[k]));
      ++k;
    }
  }
}

void TwistScale::save(std::vector<double>& out) const {
  out.push_back(swept_);
  for (const std::vector<double>* x : {&deviation_, &before_, &low_, &high_})
    out.insert(out.end(), x->begin(), x->end());
  for (const Group& g : groups_)
    for (const Member& m : g.members)
      out.push_back(m.weight);
}

const double* TwistScale::restore(const double* in) {
  swept_ = *in++;
  for (std::vector<double>* x : {&deviation_, &before_, &low_, &high_}) {
    std::copy_n(in, x->size(), x->begin());
    in += x->size();
  }
  for (Group& g : groups_)
    for (Member& m : g.members)
      m.weight = *in++;
  return in;
}

}  // namespace whirl::time
