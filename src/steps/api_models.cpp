#include <steps/api_models.hpp>
#include <core/text.hpp>

#include <results/frequency.hpp>
#include <results/support_coefficients.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace whirl::steps {

namespace {

Error report_error(const model::Step& step, const std::string& message, const std::string& hint) {
  Diagnostic d{Diagnostic::Severity::error, "E70", fmt::format("step '{}': {}", step.name, message),
               hint, step.where};
  return Error(Exit::deck, {std::move(d)});
}

bool drives_whirl(const model::BearingLaw& law) {
  return std::holds_alternative<model::AnnularSeal>(law) ||
         std::holds_alternative<model::CrossCoupling>(law);
}

/// Carries the shaft laterally to the ground.
bool carries(const model::Bearing& b) {
  if (b.to || drives_whirl(b.law)) return false;
  const model::SupportTraits t = model::traits_of(b.law);
  const model::Directions& held = *t.held;
  return held[1] && held[2] && !*t.gap;
}

std::vector<std::size_t> named_bearings(const model::Model& m, const model::Step& step,
                                        const std::vector<std::string>& names, const char* key) {
  std::vector<std::size_t> out;
  for (const std::string& name : names) {
    const auto found = std::find_if(m.bearings.begin(), m.bearings.end(),
                                    [&](const model::Bearing& b) { return b.name == name; });
    if (found == m.bearings.end())
      throw report_error(
          step, fmt::format("'{}' names bearing '{}', which the deck does not have", key, name),
          "names of bearings as in the deck");
    out.push_back(static_cast<std::size_t>(found - m.bearings.begin()));
  }
  return out;
}

void find_journals(ApiMachine& a, const model::Step& step, const model::ApiLateralStep& law) {
  const model::Model& m = a.model;
  a.seals = named_bearings(m, step, law.seals, "seals");
  for (std::size_t i = 0; i < m.bearings.size() && law.seals.empty(); ++i)
    if (drives_whirl(m.bearings[i].law)) a.seals.push_back(i);
  const auto is_seal = [&](std::size_t i) {
    return std::find(a.seals.begin(), a.seals.end(), i) != a.seals.end();
  };
  a.journals = named_bearings(m, step, law.bearings, "bearings");
  for (std::size_t i = 0; i < m.bearings.size() && law.bearings.empty(); ++i)
    if (carries(m.bearings[i]) && !is_seal(i)) a.journals.push_back(i);
  if (a.journals.empty())
    throw report_error(step, "no bearing carries the rotor laterally to the ground",
                       "name the journal bearings in 'bearings'");
  for (const std::size_t i : a.journals) {
    if (is_seal(i))
      throw report_error(step,
                         fmt::format("'{}' is a journal bearing and a seal", m.bearings[i].name),
                         "name it in 'bearings' or in 'seals'");
    if (m.bearings[i].to)
      throw report_error(
          step, fmt::format("journal bearing '{}' stands on another shaft", m.bearings[i].name),
          "journal bearings carry the rotor to the ground");
  }
  a.shaft = m.bearings[a.journals.front()].at.shaft;
  for (const std::size_t i : a.journals)
    if (m.bearings[i].at.shaft != a.shaft)
      throw report_error(step,
                         fmt::format("journal bearings '{}' and '{}' are on different shafts",
                                     m.bearings[a.journals.front()].name, m.bearings[i].name),
                         "a report for each rotor: name its bearings in 'bearings'");
  a.ratio = std::abs(m.shafts[a.shaft].speed_ratio);
  if (!m.shafts[a.shaft].rotating || a.ratio == 0)
    throw report_error(step, fmt::format("shaft '{}' does not turn", m.shafts[a.shaft].name),
                       "name the bearings of the rotor in 'bearings'");
  std::sort(a.journals.begin(), a.journals.end(),
            [&](std::size_t x, std::size_t y) { return m.bearings[x].at.s < m.bearings[y].at.s; });
}

void check_places(const ApiMachine& a, const model::Step& step, const model::ApiLateralStep& law) {
  const auto refuse = [&](const std::string& what) {
    throw report_error(step, what + " is not on the shaft of the journal bearings",
                       "a report looks at one rotor");
  };
  for (const model::ApiClearance& c : law.clearances)
    if (c.at.shaft != a.shaft) refuse("clearance '" + c.name + "'");
  for (const model::ApiStage& s : law.stages)
    if (s.at && s.at->shaft != a.shaft) refuse("stage '" + s.name + "'");
  if (law.cross_coupling_at && law.cross_coupling_at->shaft != a.shaft) refuse("cross_coupling_at");
  for (const std::string& name : law.probes)
    if (std::none_of(a.model.probes.begin(), a.model.probes.end(),
                     [&](const model::Probe& p) { return p.name == name; }))
      throw report_error(
          step, fmt::format("'probes' names probe '{}', which the deck does not have", name),
          "names of probes as in the deck");
  if (a.model.probes.empty())
    throw report_error(step, "the deck has no probe: vibration limits are those of probes",
                       "[[probe]] with name and at, beside each journal");
}

/// Entries of a stiffness in x, y, z, ry, rz but for the lateral ones.
void take_of_five(const Matrix<5>& of_five, Matrix<6>& K) {
  constexpr std::array<Index, 5> place{0, 1, 2, 4, 5};
  for (Index i = 0; i < 5; ++i)
    for (Index j = 0; j < 5; ++j) {
      const bool lateral = (i == 1 || i == 2) && (j == 1 || j == 2);
      if (!lateral) K(place[at(i)], place[at(j)]) = of_five(i, j);
    }
}

/// The part of a stiffness that is the same in every plane and stores energy: the mean over all angles
/// about the shaft, symmetric. Both lateral directions have the mean of their direct stiffnesses then,
/// both tilts that of theirs.
Matrix<6> alike_in_every_plane(const Matrix<6>& given) {
  Matrix<6> turn = Matrix<6>::Zero();  // by a quarter
  for (const Index i : {0, 3}) {
    turn(i, i) = 1.0;
    turn(i + 1, i + 2) = -1.0;
    turn(i + 2, i + 1) = 1.0;
  }
  const Matrix<6> symmetric = 0.5 * (given + given.transpose());
  Matrix<6> mean = Matrix<6>::Zero(), turned = symmetric;
  for (int k = 0; k < 4; ++k) {
    mean += 0.25 * turned;
    turned = turn * turned * turn.transpose();
  }
  return mean;
}

}  // namespace

std::vector<ApiMachine> api_machines(const model::Model& model, const run::RunOptions& options,
                                     const model::Step& step, const model::ApiLateralStep& law) {
  if (!step.from.empty())
    throw report_error(step, "a report starts from no other step: its models are its own",
                       "leave out 'from'");
  std::vector<ApiMachine> out;
  for (const model::ApiSet& set : law.sets) {
    if (!options.build && !set.change.empty())
      throw report_error(step, "the deck of this run cannot be read again for its sets", "");
    try {
      out.push_back({set.name,
                     safe_stem(set.name),
                     set.change.empty() ? model : options.build(set.change),
                     {},
                     {},
                     0});
    } catch (const Error& e) {
      std::vector<Diagnostic> all = e.diagnostics();
      std::erase_if(all,
                    [](const Diagnostic& d) { return d.severity != Diagnostic::Severity::error; });
      for (Diagnostic& d : all) {
        d.message = fmt::format("step '{}', set '{}': {}", step.name, set.name, d.message);
        d.where = step.where;
      }
      throw Error(e.exit(), std::move(all));
    }
  }
  if (out.empty()) out.push_back({"", "", model, {}, {}, 0, 1.0});
  for (ApiMachine& a : out) {
    find_journals(a, step, law);
    check_places(a, step, law);
    // what a run says of itself holds for its parts
    a.model.output = model.output;
    a.model.keep_everything = model.keep_everything;
    a.model.output.peak_to_peak = true;
  }
  return out;
}

model::Model without_seals(const ApiMachine& a) {
  model::Model m = a.model;
  for (const std::size_t i : a.seals)
    m.bearings[i].law = model::LinearBearing{};
  return m;
}

model::Model balanced(const model::Model& given) {
  model::Model m = given;
  m.unbalances.clear();
  for (model::Disk& d : m.disks) {
    d.offset.tail<2>().setZero();
    d.skew = 0;
  }
  for (model::Shaft& s : m.shafts)
    s.bow = {};
  for (model::Bearing& b : m.bearings)
    if (auto* c = std::get_if<model::Coupling>(&b.law))
      c->offset_y = c->offset_z = c->angle_y = c->angle_z = 0;
  std::erase_if(m.loads,
                [](const model::PointLoad& l) { return l.frame == model::LoadFrame::rotating; });
  return m;
}

model::Model weight_alone(const model::Model& given) {
  model::Model m = balanced(given);
  m.loads.clear();
  const double across = m.gravity.tail<2>().norm();
  const Vec3 down =
      across > 0 ? Vec3(0, m.gravity.y() / across, m.gravity.z() / across) : Vec3(0, 0, -1);
  m.gravity = 9.80665 * down;
  return m;
}

model::Model with_tables(const run::Job& parent, const ApiMachine& machine, const model::Model& m,
                         const model::Step& step, const std::vector<double>& speeds) {
  const auto follows = [&](std::size_t i) {
    const model::BearingLaw& law = m.bearings[i].law;
    const model::SupportTraits t = model::traits_of(law);
    return (*t.nonlinear || *t.follows_spin) && !std::holds_alternative<model::TableBearing>(law);
  };
  model::Model out = m;
  if (std::none_of(machine.journals.begin(), machine.journals.end(), follows)) return out;
  run::Job job(m, parent);
  job.build_for(step);
  std::map<std::size_t, model::TableBearing> tables;
  for (const double Omega : speeds) {
    run::StepState state = job.start_of(step, Omega);
    job.settle(state);
    const auto list = results::calc_support_coefficients(job, state);
    for (const std::size_t i : machine.journals) {
      const auto found = std::find_if(list.begin(), list.end(),
                                      [&](const auto& c) { return c.name == m.bearings[i].name; });
      if (!follows(i) || found == list.end()) continue;
      Matrix<6> K = Matrix<6>::Zero(), C = Matrix<6>::Zero();
      K.block<2, 2>(1, 1) = found->K;
      C.block<2, 2>(1, 1) = found->C;
      if (found->K5) take_of_five(*found->K5, K);
      tables[i].speed.push_back(Omega * m.shafts[machine.shaft].speed_ratio);
      tables[i].K.push_back(K);
      tables[i].C.push_back(C);
    }
  }
  for (auto& [i, table] : tables) {
    if (m.shafts[machine.shaft].speed_ratio < 0) {  // rows go by rising speed
      std::reverse(table.speed.begin(), table.speed.end());
      std::reverse(table.K.begin(), table.K.end());
      std::reverse(table.C.begin(), table.C.end());
    }
    table.extrapolate_hold = true;
    out.bearings[i].law = std::move(table);
  }
  return out;
}

model::Model with_mean_stiffness(const ApiMachine& machine, const model::Model& given) {
  model::Model m = given;
  for (const std::size_t i : machine.journals) {
    model::BearingLaw& law = m.bearings[i].law;
    if (auto* table = std::get_if<model::TableBearing>(&law)) {
      for (Matrix<6>& K : table->K)
        K = alike_in_every_plane(K);
      for (Matrix<6>& C : table->C)
        C.setZero();
      table->M.clear();
    } else if (const auto K = *model::traits_of(law).stiffness) {
      model::LinearBearing mean;
      mean.K = alike_in_every_plane(*K);
      law = mean;
    }
  }
  return m;
}

model::Model with_rigid_journals(const ApiMachine& machine, const model::Model& given) {
  model::Model m = given;
  for (const std::size_t i : machine.journals) {
    const model::SupportTraits law = model::traits_of(m.bearings[i].law);
    const model::Directions& held = *law.held;
    model::RigidSupport rigid;
    rigid.held[0] = held[0];
    rigid.held[1] = rigid.held[2] = true;
    m.bearings[i].law = rigid;
    m.bearings[i].pedestal.reset();
  }
  return m;
}

}  // namespace whirl::steps
