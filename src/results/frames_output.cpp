// Frames of the moving rotor, written when they are due.
#include <results/frame_arrays.hpp>
#include <results/transient_output.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

using analysis::Snapshot;

namespace {

class Frames final : public analysis::Observer {
 public:
  Frames(const run::Job& job, const model::VtkOutput& o, const std::string& name, double t0,
         double t1);
  void begin(const Snapshot& s) override;
  void step(analysis::StepAccess& s) override;
  void end() override { writer_->end(); }
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  std::uint64_t frames() const { return writer_->frames(); }

 private:
  void step_by_revolution(analysis::StepAccess& s);
  void write(const Snapshot& s);
  const run::Job& job_;
  io::FrameSchedule schedule_;
  std::unique_ptr<io::FrameWriter> writer_;
  FrameArrays arrays_;
  std::vector<assembly::SectionPoint> sections_;
  bool line_ = false, bearings_ = false;  ///< the sets that show section forces, forces of bearings
  double phi_ = 0, now_ = 0;
};

Frames::Frames(const run::Job& job, const model::VtkOutput& o, const std::string& name, double t0,
               double t1)
    : job_(job),
      schedule_({o.t0, o.t1, o.every, o.frames_per_revolution, o.frames, o.max_frames}, t0, t1),
      arrays_(job) {
  const io::VtkFrameOptions options = frame_options(job, o, name);
  writer_ = frame_writer(job, options);
  line_ = options.line;
  bearings_ = options.bearings;
}

void Frames::begin(const Snapshot& s) {
  writer_->begin(job_.scene);
  now_ = s.t();
  phi_ = s.total_phi(job_.reference());
  if (!schedule_.by_revolution() && schedule_.next_time() <= s.t()) {
    write(s);
    schedule_.advance();
  }
}

void Frames::step(analysis::StepAccess& s) {
  now_ = s.t1();
  if (schedule_.by_revolution()) return step_by_revolution(s);
  for (; schedule_.next_time() <= s.t1() * (1 + 1e-12); schedule_.advance())
    write(s.at(std::min(schedule_.next_time(), s.t1())));
}

/// Frames at fixed angles of the reference: phi is nearly linear inside a step, so a secant needs
/// two or three looks.
void Frames::step_by_revolution(analysis::StepAccess& s) {
  const double phi1 = s.end().total_phi(job_.reference()), sign = phi1 >= phi_ ? 1.0 : -1.0;
  double target = schedule_.next_angle(phi_, sign), a = s.t0(), fa = phi_;
  while (sign * (phi1 - target) >= 0.0 && phi1 != phi_) {
    double lo = a, flo = fa, hi = s.t1(), fhi = phi1, t = hi;
    for (int k = 0; k < 8 && std::abs(fhi - flo) > 1e-9; ++k) {
      t = lo + (hi - lo) * (target - flo) / (fhi - flo);
      const double f = s.at(t).total_phi(job_.reference());
      if (std::abs(f - target) < 1e-6) break;
      (sign * (f - target) < 0.0 ? lo : hi) = t;
      (sign * (f - target) < 0.0 ? flo : fhi) = f;
    }
    if (schedule_.in_window(t)) write(s.at(t));
    a = t;
    fa = target;
    target = schedule_.next_angle(target + sign * 1e-9, sign);
  }
  phi_ = phi1;
}

void Frames::save(OutArchive& out) const {
  out.put(now_);
  out.put(phi_);
  out.put(schedule_.next_time());
  out.put_count(schedule_.planned());
  out.put_count(schedule_.taken());
  writer_->save(out);
}

void Frames::restore(InArchive& in) {
  now_ = in.number();
  phi_ = in.number();
  const double next = in.number();
  const std::uint64_t planned = in.count(), taken = in.count();
  if (planned == schedule_.planned()) schedule_.set_taken(taken);
  // another end time can mean another interval: go on with the new one
  if (!schedule_.by_revolution() && schedule_.next_time() != next)
    while (schedule_.next_time() <= now_)
      schedule_.advance();
  writer_->resume(job_.scene, in);
}

void Frames::write(const Snapshot& s) {
  const auto node = [&s](Index i) -> const system::NodeState& { return s.node(i); };
  arrays_.take_nodes(node);
  if (line_) {
    assembly::calc_section_results(job_.model, job_.mesh, job_.built, s.workspace(), 0, sections_);
    arrays_.take_sections(sections_);
  }
  if (bearings_)
    arrays_.take_supports(node, s.context(), [&s](Index k) { return s.reactions()[k]; });
  writer_->frame(arrays_.state(s.t(), true));
}

/// The files of one [[output.vtk]].
class FramesOutput final : public TransientOutput {
 public:
  /// number: of the output within the step, from 1.
  FramesOutput(const TransientSetup& s, const model::VtkOutput& law, std::size_t number)
      : law_(law),
        number_(number),
        frames_(s.job, law, number == 1 ? s.step.name : fmt::format("{}_{}", s.step.name, number),
                s.t_begin, s.integration.t_end) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&frames_);
    parts.add({run::Part::frames, content()}, frames_);
  }

  void summarize(TransientEnd& end) override { end.summary["frames"] = frames_.frames(); }

 private:
  std::string content() const {
    std::string shown;
    for (const std::string& c : law_.content)
      shown += " " + c;
    return fmt::format("{} window {} {} every {} per revolution {} scale {} around {}{}{}", number_,
                       law_.t0, law_.t1, law_.every, law_.frames_per_revolution,
                       law_.deformation_scale, law_.points_around, law_.one_file ? " one file" : "",
                       shown);
  }

  const model::VtkOutput& law_;
  std::size_t number_;
  Frames frames_;
};

}  // namespace

void add_frames(const TransientSetup& setup, TransientOutputs& outputs) {
  std::size_t number = 0;
  for (const model::VtkOutput& v : setup.job.model.output.vtk)
    if (v.step.empty() || v.step == setup.step.name)
      outputs.push_back(std::make_unique<FramesOutput>(setup, v, ++number));
}

}  // namespace whirl::results
