#include <results/mesh_accuracy.hpp>
#include <results/linear_limits.hpp>
#include <core/error.hpp>
#include <la/multiply.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

/// The deck says how many elements some section has, or how long they are.
bool has_given_elements(const model::Model& m) {
  if (m.min_elements > 0 || std::isfinite(m.max_element_length)) return true;
  return std::any_of(m.shafts.begin(), m.shafts.end(), [](const model::Shaft& shaft) {
    return std::any_of(shaft.sections.begin(), shaft.sections.end(), [](const model::Section& s) {
      return s.min_elements > 0 || std::isfinite(s.max_element_length);
    });
  });
}

/// x^H (2 lambda M + C) x
Complex slope_of(const la::MCK& m, Complex lambda, const VecXc& x) {
  VecXc y;
  la::multiply(m.M, x, y);
  const Complex by_mass = 2.0 * lambda * x.dot(y);
  la::multiply(m.C, x, y);
  return by_mass + x.dot(y);
}

}  // namespace

std::string error_text(double relative) {
  constexpr double least = 1e-6;
  const double x = std::max(relative, least);
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  double digit = std::ceil(x / power * (1.0 - 1e-9));
  double unit = power;
  if (digit >= 10.0) {
    digit = 1.0;
    unit *= 10.0;
  }
  return fmt::format("{:.0e}", digit * unit);
}

MeshAccuracy::MeshAccuracy(FrequencyStep& s)
    : step_(s),
      error_(s.job.model, s.job.mesh, s.job.built) {}

double MeshAccuracy::error_of(const analysis::WhirlMode& mode, double Omega) {
  std::vector<double> spin;
  for (const model::Shaft& shaft : step_.job.model.shafts)
    spin.push_back(shaft.rotating ? shaft.speed_ratio * Omega : 0.0);
  const double judged = relative_mesh_error(error_, step_.linear.at(Omega), mode, spin);
  if (error_.left_out().empty()) return judged;
  if (!refined_) refined_ = std::make_unique<RefinedModes>(step_, error_.left_out());
  const std::optional<double> change = refined_->error(mode, Omega);
  return change ? judged + *change / std::abs(mode.lambda) : nan;
}

double MeshAccuracy::of(const analysis::WhirlMode& mode, double Omega, const std::string& name) {
  if ((error_.empty() && error_.left_out().empty()) || std::abs(mode.lambda) == 0.0) return 0.0;
  const double error = error_of(mode, Omega);
  looked_ = true;
  if (std::isnan(error)) {
    not_judged_.push_back(name);
  } else if (!(error <= largest_)) {
    largest_ = error;
    worst_ = name;
  }
  return error;
}

void MeshAccuracy::look_at(std::span<const analysis::WhirlMode> modes, double Omega) {
  std::vector<analysis::WhirlMode> oscillating;
  std::copy_if(modes.begin(), modes.end(), std::back_inserter(oscillating),
               [](const analysis::WhirlMode& m) { return m.oscillates(); });
  const std::vector<std::string> labels = labels_of(oscillating);
  for (std::size_t k = 0; k < oscillating.size(); ++k)
    of(oscillating[k], Omega, labels[k]);
}

void MeshAccuracy::report() {
  if (!looked_) return;
  run::Job& job = step_.job;
  io::Value& v = step_.summary()["mesh"];
  v["elements"] = job.mesh.elements.size();
  v["relative error of frequencies"] = largest_;
  v["largest at"] = worst_;
  std::string text = fmt::format("frequencies right to {} (elements)", error_text(largest_));
  if (refined_) {
    v["by a mesh twice as fine"] = io::Value::array();
    for (const std::string& shaft : error_.left_out())
      v["by a mesh twice as fine"].push(shaft);
  }
  for (const std::string& mode : not_judged_)
    v["not judged"].push(mode);
  if (!not_judged_.empty()) text += fmt::format(", {} of the modes not judged", not_judged_.size());
  step_.claim(text);
  if (largest_ <= job.model.mesh_accuracy || warned_) return;
  warned_ = true;
  warn_of_coarse_mesh(job, step_.step.name,
                      fmt::format("the frequency of {} is off by about {}, {} wanted", worst_,
                                  error_text(largest_), error_text(job.model.mesh_accuracy)));
}

double relative_mesh_error(const assembly::MeshError& error, const la::MCK& m,
                           const analysis::WhirlMode& mode, std::span<const double> spin) {
  if (error.empty() || std::abs(mode.lambda) == 0.0) return 0.0;
  const Complex defect = error.defect(mode.lambda, mode.x, spin);
  return std::abs(defect) / std::abs(slope_of(m, mode.lambda, mode.x) * mode.lambda);
}

void warn_of_coarse_mesh(run::Job& job, const std::string& step, const std::string& what) {
  Diagnostic w;
  w.code = "W10";
  w.message = fmt::format("step '{}': the mesh is too coarse: {}", step, what);
  w.hint = has_given_elements(job.model)
               ? "leave min_elements and max_element_length out and the program chooses the "
                 "elements, or give more of them"
               : "the program chose the elements, for the frequencies it expected; give "
                 "[model.mesh] a smaller accuracy, or min_elements_per_section";
  warn(job, std::move(w));
}

void report_mesh_accuracy(FrequencyStep& s, double Omega, double max_frequency) {
  MeshAccuracy accuracy(s);
  analysis::ModesOptions o;
  o.count = 0;
  o.max_frequency = max_frequency;
  o.certify = false;
  try {
    accuracy.look_at(analysis::whirl_modes(s.linear, Omega, o), Omega);
  } catch (const Error& e) {
    // modes below a table that reaches the excitation
    if (e.diagnostics().front().code != "E81") throw;
    s.summary()["mesh"]["not judged"].push(e.diagnostics().front().message);
    s.claim("what the elements leave is not judged, for " + e.diagnostics().front().message);
    return;
  }
  accuracy.report();
}

}  // namespace whirl::results
