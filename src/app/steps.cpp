// Runs the steps of a deck in order and writes summary and report, complete or not: a failed step keeps what came before it.
#include <app/job.hpp>
#include <app/steps.hpp>
#include <io/plots.hpp>

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <type_traits>

namespace whirl::app {

namespace {

double wall() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void describe_model(Job& job) {
  io::Value& v = job.summary["model"];
  v["nodes"] = job.mesh.nodes.size();
  v["elements"] = job.mesh.elements.size();
  long unknowns = 0;
  for (unsigned char a : job.system().active()) unknowns += a;
  v["unknowns"] = unknowns;
  io::Value parts = io::Value::object();
  for (const auto& term : job.system().terms()) parts[term->kind()] = term->count();
  v["batches"] = parts;
  io::Value left = io::Value::array();
  for (const std::string& s : job.built.left_out) left.push(s);
  v["left out"] = left;
}

}  // namespace

io::RotorDrawing drawing_of(const model::Model& model, const meshes::Mesh& mesh) {
  io::RotorDrawing d;
  d.title = model.title.empty() ? model.deck_name : model.title;
  double longest = 0.0;
  for (const meshes::Line& l : mesh.lines) longest = std::max(longest, l.length);
  for (std::size_t l = 0; l < model.shafts.size(); ++l) {
    double s = model.shafts[l].origin.x();
    for (const model::Section& x : model.shafts[l].sections) {
      const double thin = x.od_l > 0.0 ? 0.0 : 0.02 * longest;
      d.sections.push_back({s, s + x.length, x.od_l + thin, x.od_r + thin, x.id_l, x.id_r, x.name});
      s += x.length;
    }
  }
  auto at = [&](const model::Location& p) { return model.shafts[p.shaft].origin.x() + p.s; };
  for (const model::Disk& k : model.disks) {
    double od = k.draw_od;
    if (od <= 0.0 && k.mass > 0.0 && k.Ip > 0.0) od = 2.0 * std::sqrt(2.0 * k.Ip / k.mass);
    d.disks.push_back({at(k.at), od, 2.0 * mesh.radius(model, k.at.shaft, k.at.s), k.draw_width > 0 ? k.draw_width : 0.08 * od, k.name});
  }
  for (const model::Bearing& b : model.bearings) d.bearings.push_back({at(b.at), mesh.radius(model, b.at.shaft, b.at.s), b.name});
  for (const model::Probe& p : model.probes) d.probes.push_back({at(p.at), mesh.radius(model, p.at.shaft, p.at.s), p.name});
  for (const meshes::Station& s : mesh.stations) d.nodes.push_back(s.position.x());
  return d;
}

void run_steps(Job& job) {
  const double t0 = wall();
  job.report.title = job.model.title.empty() ? job.model.deck_name : job.model.title;
  job.report.deck = job.model.resolved;
  for (const Diagnostic& w : job.model.warnings) job.report.warnings.push_back(w.message);
  auto finish = [&] {
    job.summary["run time, wall [s]"] = wall() - t0;
    job.folder.write_json("summary.json", job.summary);
    if (job.model.output.report) {
      job.report.summary = job.summary;
      io::ReportSection rotor;
      rotor.title = "Rotor";
      rotor.figures.push_back(io::plot_rotor("rotor", drawing_of(job.model, job.mesh)));
      job.report.sections.insert(job.report.sections.begin(), std::move(rotor));
      io::write_report(job.folder.path("report.html"), job.report);
      for (const io::ReportSection& s : job.report.sections)
        for (const io::Figure& f : s.figures) job.folder.write_text("plots/" + f.name + ".svg", io::render_svg(f));
    }
  };
  try {
    for (const model::Step& step : job.model.steps) {
      job.build_for(step);
      if (!job.summary.is_object() || job.summary.at("model").is_null()) describe_model(job);
      std::visit(
          [&](const auto& law) {
            using T = std::decay_t<decltype(law)>;
            if constexpr (std::is_same_v<T, model::TransientStep>) run_transient_step(job, step, law);
            else if constexpr (std::is_same_v<T, model::StaticStep>) run_static_step(job, step, law);
            else run_frequency_step(job, step);
          },
          step.law);
    }
  } catch (const Error& e) {
    io::Value& v = job.summary["error"];
    for (const Diagnostic& d : e.diagnostics()) v.push(d.code + ": " + d.message);
    finish();
    throw;
  }
  finish();
}

}  // namespace whirl::app
