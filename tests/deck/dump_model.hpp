// Every number and name of a model as text, for comparing two of them exactly. Places in the deck
// are left out.
#pragma once
#include <fmt/format.h>
#include <model/model.hpp>
#include <string>

namespace whirl {

class ModelDump {
 public:
  explicit ModelDump(const model::Model& m) { all(m); }
  const std::string& text() const { return out_; }

 private:
  void put(const char* key, double x) { out_ += fmt::format("{}={:a} ", key, x); }
  void put(const char* key, const std::string& s) { out_ += fmt::format("{}='{}' ", key, s); }
  template <class V>
  void each(const char* key, const V& values) {
    out_ += fmt::format("{}=(", key);
    for (const auto& v : values)
      out_ += fmt::format("{:a} ", static_cast<double>(v));
    out_ += ") ";
  }
  template <class M>
  void matrix(const char* key, const M& m) {
    out_ += fmt::format("{}=(", key);
    for (Index i = 0; i < m.rows(); ++i)
      for (Index j = 0; j < m.cols(); ++j)
        out_ += fmt::format("{:a} ", m(i, j));
    out_ += ") ";
  }
  void law(const char* key, const LawPtr& l) {
    out_ += fmt::format("{}=", key);
    if (!l) {
      out_ += "none ";
      return;
    }
    for (double t : {-1.0, 0.0, 0.3, 0.7, 1.0, 1.1, 1.9, 2.0, 3.7, 8.0, 30.0}) {
      const LawValue v = l->at(t);
      out_ += fmt::format("({:a} {:a} {:a} {:a}) ", v.f, v.df, v.ddf, l->integral(t));
    }
    each("breaks", l->breakpoints());
  }
  void at(const char* key, const model::Location& l) {
    out_ += fmt::format("{}=({} {:a} '{}' {}) ", key, l.shaft, l.s, l.text, l.housing);
  }
  void head(const char* kind, const model::Entity& e) {
    out_ += fmt::format("\n{} '{}' ", kind, e.name);
  }

  void shaft(const model::Shaft& s) {
    head("shaft", s);
    matrix("origin", s.origin);
    each("damping",
         std::array{s.damping.alpha, s.damping.beta_external, s.damping.beta_internal,
                    s.damping.loss_factor, s.damping.loss_frequency, s.damping.beta_torsion});
    each("state", std::array{double(s.rotating), s.speed_ratio, s.spin0, s.axial_preload});
    for (const auto& x : s.sections) {
      head(" section", x);
      each("d", std::array{x.length, x.od_l, x.id_l, x.od_r, x.id_r});
      if (x.stiffness_diameters) each("stiffness", *x.stiffness_diameters);
      each("flags", std::array{double(x.material), double(x.rigid), double(x.shear), x.kappa,
                               double(x.rotary_inertia), x.added_mass_per_length,
                               double(x.min_elements), x.max_element_length});
      if (const auto& g = x.general)
        each("general", std::array{g->A, g->Iy, g->Iz, g->J, g->kappa_y, g->kappa_z, g->angle});
      if (const auto& c = x.constants)
        each("constants", std::array{c->EA, c->kGA, c->GJ, c->EI, c->rhoA, c->rhoI, c->rhoIp});
    }
  }

  void bearing(const model::Bearing& b) {
    head("bearing", b);
    at("at", b.at);
    if (b.to) at("to", *b.to);
    put("law", double(b.law.index()));
    std::visit([this](const auto& x) { law(x); }, b.law);
    if (b.pedestal) {
      put("mass", b.pedestal->mass);
      matrix("K", b.pedestal->K);
      matrix("C", b.pedestal->C);
    }
  }

  void law(const model::LinearBearing& x) {
    matrix("K", x.K);
    matrix("C", x.C);
    matrix("M", x.M);
    matrix("setpoint", x.setpoint);
    matrix("preload", x.preload);
  }
  void law(const model::SpringBlock& x) { each("C", std::array{x.C1, x.C2}); }
  void law(const model::TableBearing& x) {
    each("speed", x.speed);
    each("frequency", x.frequency);
    for (const auto& r : x.K)
      matrix("K", r);
    for (const auto& r : x.C)
      matrix("C", r);
    for (const auto& r : x.M)
      matrix("M", r);
    matrix("setpoint", x.setpoint);
    matrix("preload", x.preload);
    each("how", std::array{x.monotone_cubic, x.extrapolate_hold});
  }
  void law(const model::RigidSupport& x) { each("held", x.held); }
  void law(const model::RollingEstimate& x) {
    each("estimate", std::array{double(x.roller), double(x.elements), x.size, x.load, x.load_angle,
                                x.contact_angle, x.kxx, x.c_radial});
  }
  void law(const model::NonlinearSpring& x) {
    const auto& f = x.force;
    each("spring",
         std::array{double(x.along), double(f.shape), f.gap_minus, f.gap_plus, f.stiffness,
                    f.smooth, double(f.monotone_cubic), x.damping, x.damping2});
    each("coefficients", f.coefficients);
    each("q", f.q);
    each("F", f.F);
  }
  void oil(const model::Oil& o) {
    each("oil", std::array{o.viscosity, o.grade, o.temperature, o.density, o.thinning});
  }
  void flow(const model::FilmFlow& f) {
    each("flow", std::array{double(f.regime), f.supply_pressure, double(f.cavitation)});
    if (!f.heat) return;
    const model::FilmHeat& h = *f.heat;
    each("heat",
         std::array{h.supply_temperature, h.specific_heat, h.conductivity, double(h.feed),
                    h.carry_over, h.supply_flow, h.wall, h.wall_conductivity, h.back_coefficient,
                    h.housing_temperature, h.shaft_expansion, h.pad_expansion, h.housing_expansion,
                    h.assembly_temperature, h.time_constant});
  }
  void law(const model::ShortJournal& x) {
    each("short", std::array{x.diameter, x.length, x.clearance});
    oil(x.oil);
  }
  void law(const model::FiniteJournal& x) {
    each("journal",
         std::array{x.diameter, x.length, x.clearance, x.preload, double(x.shape), double(x.lobes),
                    x.groove, x.groove_at, x.lobe_at, x.lobe_offset, double(x.nodes)});
    oil(x.oil);
    flow(x.flow);
  }
  void law(const model::TiltingPadJournal& x) {
    each("tilting", std::array{x.diameter, x.length, x.clearance, double(x.nodes), double(x.rows)});
    oil(x.oil);
    flow(x.flow);
    for (const auto& p : x.pads()) {
      each("pad",
           std::array{p.pivot, p.arc, p.offset, p.preload, p.clearance, p.thickness, p.inertia,
                      p.mass, p.pivot_stiffness, p.pivot_damping, p.tilt_stiffness});
      if (p.contact)
        each("contact",
             std::array{double(p.contact->shape), p.contact->radius, p.contact->seat_radius,
                        p.contact->length, p.contact->E, p.contact->nu});
    }
    each("ratios", x.frequency_ratios);
  }
  void law(const model::FloatingRing& x) {
    for (const model::FloatingRing::Film* f : {&x.inner, &x.outer})
      each("film", std::array{f->diameter, f->length, f->clearance, f->viscosity, f->temperature});
    each("ring",
         std::array{double(x.theory), x.grade, x.density, x.ring_density, x.mass, x.inertia,
                    double(x.pinned), x.stiffness, x.damping, double(x.holes.number),
                    x.holes.diameter, x.supply_pressure, x.supply_temperature, double(x.nodes)});
    if (x.heat)
      each("heat", std::array{x.heat->specific_heat, x.heat->share, x.heat->ring_specific_heat,
                              x.heat->conductance, x.heat->reference, x.heat->shaft, x.heat->ring,
                              x.heat->housing});
    each("ratios", x.frequency_ratios);
  }
  void law(const model::SqueezeFilm& x) {
    each("squeeze", std::array{x.diameter, x.length, x.clearance, double(x.film), x.groove,
                               x.groove_at, x.stiffness, x.damping});
    oil(x.oil);
  }
  void stage(const model::Pid& s) { each("pid", std::array{s.kp, s.ki, s.kd, s.lag}); }
  void stage(const model::LeadLag& s) { each("lead_lag", std::array{s.zero, s.pole}); }
  void stage(const model::Notch& s) { each("notch", std::array{s.frequency, s.damping, s.depth}); }
  void stage(const model::LowPass& s) {
    each("low_pass", std::array{s.frequency, double(s.order)});
  }
  void stage(const model::TransferFunction& s) {
    each("numerator", s.numerator);
    each("denominator", s.denominator);
    each("gain", std::array{s.gain});
  }
  void stage(const model::StateSpaceStage& s) {
    matrix("state space", s.matrix);
    each("gain", std::array{s.gain});
  }
  void law(const model::MagneticBearing& x) {
    each("magnet",
         std::array{x.per_current, x.per_displacement, x.bias, x.gap, x.saturation, x.current_limit,
                    x.rate_limit, x.angle, x.sensor_bandwidth, x.amplifier_bandwidth, x.delay,
                    double(x.delay_order), x.setpoint.x(), x.setpoint.y()});
    if (x.sensor_at) at("sensor", *x.sensor_at);
    law("power", x.power);
    if (x.both) stage(*x.both);
    for (const model::Controller* c : {&x.control, &x.second, &x.cross})
      for (const model::ControlStage& s : *c)
        std::visit([this](const auto& y) { stage(y); }, s);
  }
  void law(const model::BallBearing& x) {
    each("ball", std::array{double(x.balls), x.ball_diameter, x.pitch_diameter, x.contact_angle,
                            x.clearance, x.f_inner, x.f_outer, x.stiffness, x.preload,
                            double(x.direction), x.c_radial, x.c_axial});
  }
  void law(const model::RollerBearing& x) {
    each("roller", std::array{double(x.rollers), x.roller_diameter, x.roller_length,
                              x.pitch_diameter, x.clearance, x.stiffness, x.c_radial, x.c_axial});
  }
  void law(const model::Rub& x) {
    each("rub", std::array{x.gap, x.stiffness, x.damping, x.friction, x.diameter, x.slip_speed});
  }
  void law(const model::AnnularSeal& x) {
    each("seal", std::array{x.diameter, x.length, x.clearance, x.pressure_drop, x.density,
                            x.viscosity, x.inlet_loss, x.inlet_swirl});
  }
  void law(const model::CrossCoupling& x) {
    each("cross",
         std::array{double(x.from), x.k, x.alford.beta, x.alford.torque, x.alford.diameter,
                    x.alford.blade_height, x.wachel.power, x.wachel.speed, x.wachel.diameter,
                    x.wachel.width, x.wachel.molar_mass, x.wachel.density_ratio});
  }
  void law(const model::Coupling& x) {
    matrix("K", x.K);
    matrix("C", x.C);
    each("hubs", std::array{x.offset_y, x.offset_z, x.angle_y, x.angle_z});
  }
  void law(const model::GearPair& x) {
    each("gear",
         std::array{double(x.teeth), double(x.other_teeth), x.pitch_diameter, x.pressure_angle,
                    x.helix, x.centre_angle, double(x.drive), x.stiffness, x.damping, x.backlash});
    each("a", x.stiffness_harmonics);
    each("b", x.stiffness_phases);
    each("e", x.error_harmonics);
    each("f", x.error_phases);
  }

  void drive(const model::Drive& d) {
    head("drive", d);
    at("at", d.at);
    put("step", d.step);
    put("kind", double(d.kind));
    if (const auto* p = std::get_if<model::PrescribedSpin>(&d.law)) law("angle", p->angle);
    if (const auto* t = std::get_if<model::TorqueCurve>(&d.law)) {
      law("torque", t->of_time);
      law("brake", t->brake);
      each("speed", t->speed);
      each("torque", t->torque);
      each("load", std::array{t->constant, t->viscous, t->quadratic});
      if (t->induction)
        each("induction", std::array{t->induction->breakdown, t->induction->slip_breakdown,
                                     t->induction->synchronous});
      if (const auto& p = t->pulsation) {
        each("pulsation", std::array{p->synchronous, p->poles, p->phase});
        each("of speed", p->speed);
        each("amplitude", p->amplitude);
      }
      if (t->dc) each("dc", std::array{t->dc->stall, t->dc->no_load_speed});
      if (t->power) each("power", std::array{t->power->power, t->power->max_torque});
      if (t->governor)
        each("governor", std::array{t->governor->target, t->governor->kp, t->governor->ki,
                                    t->governor->max_torque});
    }
  }

  void range(const model::SpeedRange& r) {
    each("range", std::array{r.start, r.stop, double(r.points)});
    each("values", r.values);
  }

  void step(const model::Step& s) {
    head("step", s);
    put("from", s.from);
    put("kind", double(s.law.index()));
    if (const auto* x = std::get_if<model::StaticStep>(&s.law))
      each("static", std::array{double(x->load_steps), x->speed});
    if (const auto* x = std::get_if<model::ModalStep>(&s.law))
      each("modal", std::array{x->speed, double(x->modes)});
    if (const auto* x = std::get_if<model::CampbellStep>(&s.law)) {
      range(x->speed);
      put("modes", x->modes);
      each("orders", x->orders);
    }
    if (const auto* x = std::get_if<model::CriticalStep>(&s.law)) {
      each("critical", std::array{x->max_speed, double(x->modes)});
      each("orders", x->orders);
    }
    if (const auto* x = std::get_if<model::UnbalanceStep>(&s.law)) range(x->speed);
    if (const auto* x = std::get_if<model::TransientStep>(&s.law)) {
      each("transient", std::array{x->duration, double(x->start), x->speed0,
                                   x->stop_speed.value_or(0.0), x->amplitude_limit});
      if (const auto& t = x->torques)
        each("torques", std::array{t->concentration, t->yield, t->ultimate, t->thousand,
                                   t->endurance, t->cycles});
      const auto& o = x->integrator;
      put("method", o.method);
      each("integrator", std::array{o.tolerance, o.rho_inf, o.dt, o.dt_max, o.dt_min, o.dt_first});
    }
  }

  void all(const model::Model& m) {
    put("format", m.format);
    put("title", m.title);
    matrix("gravity", m.gravity);
    each("settings", std::array{double(m.chart_change), double(m.keep_everything),
                                m.max_element_length, double(m.min_elements)});
    for (const auto& x : m.materials) {
      head("material", x);
      each("", std::array{x.E, x.G, x.nu, x.rho, x.yield});
    }
    for (const auto& x : m.shafts)
      shaft(x);
    for (const auto& d : m.disks) {
      head("disk", d);
      at("at", d.at);
      each("body", std::array{d.mass, d.Ip, d.Id, d.skew, d.skew_phase, d.draw_od, d.draw_id,
                              d.draw_width});
      if (d.inertia) matrix("inertia", *d.inertia);
      matrix("offset", d.offset);
    }
    for (const auto& u : m.unbalances) {
      head("unbalance", u);
      at("at", u.at);
      each("", std::array{u.amount, u.phase});
      law("factor", u.factor);
    }
    for (const auto& c : m.cracks) {
      head("crack", c);
      at("at", c.at);
      if (c.to) at("to", *c.to);
      each("", std::array{c.phase, double(c.breathing), c.depth, c.stiffness, c.stiffness_across,
                          c.loss, c.loss_across, c.open_direction});
    }
    for (const auto& i : m.initial) {
      head("initial", i);
      put("shaft", double(i.shaft));
      matrix("displacement", i.displacement);
      matrix("velocity", i.velocity);
      matrix("omega", i.omega);
      matrix("gamma", i.gamma);
      matrix("about", i.about);
    }
    for (const auto& b : m.bearings)
      bearing(b);
    for (const auto& l : m.base.acceleration)
      law("base", l);
    if (m.base.turn) {
      matrix("axis", m.base.turn->axis);
      matrix("about", m.base.turn->about);
      law("rate", m.base.turn->rate);
    }
    for (const auto& j : m.joints) {
      head("joint", j);
      at("at", j.at);
      if (j.to) at("to", *j.to);
      matrix("axis", j.axis);
      matrix("second axis", j.second_axis);
      each("", std::array{double(j.kind), double(j.arm), j.stiffness, j.damping});
    }
    for (const auto& f : m.foundations) {
      head("foundation", f);
      for (const auto& c : f.coordinates)
        out_ += fmt::format("('{}' {} {}) ", c.name, c.bearing, c.direction);
      matrix("K", f.K);
      matrix("C", f.C);
      matrix("M", f.M);
    }
    for (const auto& l : m.loads) {
      head("load", l);
      at("at", l.at);
      put("frame", double(l.frame));
      matrix("force", l.force);
      matrix("moment", l.moment);
      law("factor", l.factor);
    }
    for (const auto& d : m.drives)
      drive(d);
    for (const auto& p : m.probes) {
      head("probe", p);
      at("at", p.at);
      each("angles", p.angles);
    }
    for (const auto& s : m.steps)
      step(s);
    const auto& o = m.output;
    out_ += "\noutput ";
    each("", std::array{o.every, double(o.csv), double(o.binary), double(o.report),
                        double(o.peak_to_peak), double(o.replay), o.tracking.bandwidth});
    put("directory", o.directory);
    for (const auto& q : o.quantities)
      put("quantity", q);
    for (const auto& v : o.vtk) {
      out_ += "\nvtk ";
      put("step", v.step);
      each("", std::array{v.t0, v.t1, v.every, v.frames_per_revolution, double(v.frames),
                          double(v.max_frames), v.deformation_scale, double(v.points_around),
                          double(v.one_file), double(v.compression)});
      for (const auto& c : v.content)
        put("content", c);
    }
  }

  std::string out_;
};

}  // namespace whirl
