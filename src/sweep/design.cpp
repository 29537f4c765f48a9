#include <sweep/design.hpp>
#include <sweep/sampling.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace whirl::sweep {
namespace {

constexpr double most_runs = 1e9;

Error bad_factor(const std::string& text, const std::string& problem, const std::string& hint) {
  return Error(Exit::usage,
               Diagnostic{Diagnostic::Severity::error, "E99",
                          fmt::format("--vary '{}': {}", text, problem), hint, Where{}});
}

std::string trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(s.substr(first, s.find_last_not_of(" \t") - first + 1));
}

std::vector<std::string> split(std::string_view s, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= s.size(); ++k)
    if (k == s.size() || s[k] == separator) {
      parts.push_back(trimmed(s.substr(begin, k - begin)));
      begin = k + 1;
    }
  return parts;
}

/// "60 um" as number and unit.
struct Number {
  double value = 0;
  std::string unit;
  bool ok = false;
};
Number number_of(const std::string& s) {
  Number n;
  const char* begin = s.data() + (!s.empty() && s[0] == '+' ? 1 : 0);
  const auto read = std::from_chars(begin, s.data() + s.size(), n.value);
  if (read.ec != std::errc{} || !std::isfinite(n.value)) return n;
  n.unit =
      trimmed(std::string_view(read.ptr, static_cast<std::size_t>(s.data() + s.size() - read.ptr)));
  n.ok = true;
  return n;
}

/// Fifteen digits: 0.1 + 0.2 is written 0.3.
std::string with_unit(double x, const std::string& unit) {
  const std::string number = fmt::format("{:.15g}", x);
  return unit.empty() ? number : number + " " + unit;
}

/// Numbers of one unit, which is that of the last.
std::vector<double> numbers_of(const std::string& text, const std::vector<std::string>& parts,
                               std::string& unit) {
  std::vector<double> numbers;
  for (const std::string& part : parts)
    if (!number_of(part).ok)
      throw bad_factor(text, fmt::format("'{}' is not a number with a unit", part),
                       "for instance bearing.NDE.clearance=60um:90um:7");
  unit = number_of(parts.back()).unit;
  for (const std::string& part : parts) {
    const Number n = number_of(part);
    if (!n.unit.empty() && n.unit != unit)
      throw bad_factor(text, fmt::format("units '{}' and '{}' in one list", n.unit, unit),
                       "write all values of a key in one unit");
    numbers.push_back(n.value);
  }
  return numbers;
}

void read_range(const std::string& text, std::vector<std::string> parts, Factor& f) {
  const bool logarithmic = parts.size() == 4;
  if ((parts.size() != 3 && parts.size() != 4) || (logarithmic && parts[3] != "log"))
    throw bad_factor(text, "a range is first:last:count, or first:last:count:log",
                     "for instance 60um:90um:7");
  int count = 0;
  const auto read = std::from_chars(parts[2].data(), parts[2].data() + parts[2].size(), count);
  if (read.ec != std::errc{} || read.ptr != parts[2].data() + parts[2].size() || count < 2)
    throw bad_factor(text, fmt::format("'{}' is not a number of values of at least 2", parts[2]),
                     "for instance 60um:90um:7");
  const auto ends = numbers_of(text, {parts[0], parts[1]}, f.unit);
  if (logarithmic && !(ends[0] > 0 && ends[1] > 0))
    throw bad_factor(text, "a range of equal ratios needs values above zero", "leave out :log");
  for (int k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / (count - 1);
    const double x = k == 0           ? ends[0]
                     : k == count - 1 ? ends[1]
                     : logarithmic    ? ends[0] * std::pow(ends[1] / ends[0], part)
                                      : ends[0] + (ends[1] - ends[0]) * part;
    f.values.push_back(with_unit(x, f.unit));
  }
}

void read_list(const std::vector<std::string>& parts, Factor& f) {
  f.values = parts;
  if (std::all_of(parts.begin(), parts.end(), [](const auto& p) { return number_of(p).ok; })) {
    f.unit = number_of(parts.back()).unit;
    for (const std::string& p : parts)
      if (number_of(p).unit != f.unit) f.unit.clear();
  }
}

struct LawName {
  const char* name;
  Factor::Law law;
  std::size_t parameters;
  const char* form;
};
constexpr LawName laws[] = {
    {"uniform", Factor::Law::uniform, 2, "uniform(low, high)"},
    {"loguniform", Factor::Law::loguniform, 2, "loguniform(low, high)"},
    {"triangular", Factor::Law::triangular, 3, "triangular(low, mode, high)"},
    {"normal", Factor::Law::normal, 2, "normal(mean, deviation)"},
    {"lognormal", Factor::Law::lognormal, 2, "lognormal(median, deviation of the logarithm)"}};

/// What stands against the parameters of a distribution; empty: nothing.
std::string problem_of(const Factor& f) {
  const auto& p = f.parameters;
  switch (f.law) {
    case Factor::Law::uniform: return p[0] < p[1] ? "" : "the first value must be the lower";
    case Factor::Law::loguniform:
      return 0 < p[0] && p[0] < p[1] ? "" : "the values must be above zero, the first the lower";
    case Factor::Law::triangular:
      return p[0] <= p[1] && p[1] <= p[2] && p[0] < p[2] ? "" : "the values must ascend";
    case Factor::Law::normal: return p[1] > 0 ? "" : "the deviation must be above zero";
    case Factor::Law::lognormal:
      return p[0] > 0 && p[1] > 0 ? "" : "median and deviation must be above zero";
    case Factor::Law::values: break;
  }
  return "";
}

void read_law(const std::string& text, const LawName& law, const std::string& inside, Factor& f) {
  f.law = law.law;
  std::vector<std::string> parts = split(inside, ',');
  if (parts.size() != law.parameters)
    throw bad_factor(text, fmt::format("{} values where {} belong", parts.size(), law.parameters),
                     law.form);
  if (law.law == Factor::Law::lognormal) {  // the second is a plain number
    f.parameters = numbers_of(text, {parts[0]}, f.unit);
    std::string none;
    f.parameters.push_back(numbers_of(text, {parts[1]}, none)[0]);
    if (none == "%") f.parameters[1] *= 0.01;
    if (!none.empty() && none != "%")
      throw bad_factor(text, "the deviation of a logarithm has no unit", law.form);
  } else if (law.law == Factor::Law::normal && number_of(parts[1]).unit == "%") {
    f.parameters = numbers_of(text, {parts[0]}, f.unit);
    f.parameters.push_back(0.01 * number_of(parts[1]).value * std::abs(f.parameters[0]));
  } else {
    f.parameters = numbers_of(text, parts, f.unit);
  }
  if (const std::string problem = problem_of(f); !problem.empty())
    throw bad_factor(text, problem, law.form);
}

}  // namespace

Factor read_factor(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || trimmed(text.substr(0, equals)).empty())
    throw bad_factor(text, "PATH=VALUES expected",
                     "for instance bearing.NDE.clearance=60um:90um:7");
  Factor f;
  f.path = trimmed(std::string_view(text).substr(0, equals));
  const std::string values = trimmed(std::string_view(text).substr(equals + 1));
  if (values.empty()) throw bad_factor(text, "no values", "for instance 60um:90um:7");
  for (const LawName& law : laws) {
    const std::string head = std::string(law.name) + "(";
    if (!values.starts_with(head)) continue;
    if (values.back() != ')') throw bad_factor(text, "no closing parenthesis", law.form);
    read_law(text, law, values.substr(head.size(), values.size() - head.size() - 1), f);
    return f;
  }
  const std::vector<std::string> ends = split(values, ':');
  if (ends.size() > 1 && number_of(ends[0]).ok)
    read_range(text, ends, f);
  else
    read_list(split(values, ','), f);
  if (std::any_of(f.values.begin(), f.values.end(), [](const auto& v) { return v.empty(); }))
    throw bad_factor(text, "an empty value", "values are parted by commas");
  return f;
}

double Factor::at_quantile(double p) const {
  WHIRL_EXPECTS(random() && p > 0 && p < 1);
  const auto& a = parameters;
  switch (law) {
    case Law::uniform: return a[0] + (a[1] - a[0]) * p;
    case Law::loguniform: return a[0] * std::pow(a[1] / a[0], p);
    case Law::triangular: {
      const double width = a[2] - a[0], rising = (a[1] - a[0]) / width;
      return p < rising ? a[0] + std::sqrt(p * width * (a[1] - a[0]))
                        : a[2] - std::sqrt((1 - p) * width * (a[2] - a[1]));
    }
    case Law::normal: return a[0] + a[1] * normal_quantile(p);
    case Law::lognormal: return a[0] * std::exp(a[1] * normal_quantile(p));
    case Law::values: break;
  }
  return nan;
}

Design::Design(std::vector<Factor> factors, std::int64_t samples, Sampling sampling,
               std::uint64_t seed)
    : factors_(std::move(factors)),
      sampling_(sampling),
      seed_(seed) {
  const auto refuse = [](const std::string& message, const std::string& hint) {
    throw Error(Exit::usage,
                Diagnostic{Diagnostic::Severity::error, "E99", message, hint, Where{}});
  };
  double count = 1;
  std::size_t distributions = 0;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j)
      if (factors_[j].path == factors_[k].path)
        refuse(fmt::format("'{}' is varied twice", factors_[k].path), "one --vary a key");
    if (factors_[k].random())
      ++distributions;
    else
      count *= static_cast<double>(factors_[k].values.size());
  }
  if (distributions == 0 && samples > 1)
    refuse("there is nothing to sample: no key has a distribution",
           "for instance --vary 'bearing.NDE.clearance=uniform(60 um, 90 um)'");
  if (distributions > 0 && samples < 2)
    refuse("distributions need a number of samples", "for instance --samples 200");
  if (sampling_ == Sampling::sobol && distributions > sobol_dimensions)
    refuse(fmt::format("{} distributions, and Sobol's points are laid for {} at most",
                       distributions, sobol_dimensions),
           "--sampling lhs takes any number");
  count *= static_cast<double>(std::max<std::int64_t>(samples, 1));
  if (count > most_runs)
    refuse(fmt::format("{:.3g} runs are more than {:.0e}", count, most_runs),
           "take fewer values, or sample them from distributions");
  samples_ = std::max<std::int64_t>(samples, 1);
  for (const Factor& f : factors_)
    if (!f.random()) combinations_ *= static_cast<std::int64_t>(f.values.size());
}

double Design::quantile(std::size_t dimension, std::int64_t sample) const {
  switch (sampling_) {
    case Sampling::random: return random_point(seed_, dimension, sample);
    case Sampling::latin_hypercube: return latin_point(seed_, dimension, sample, samples_);
    case Sampling::sobol: return sobol_point(seed_, dimension, sample);
  }
  return nan;
}

std::vector<std::string> Design::values(std::int64_t run) const {
  WHIRL_EXPECTS(run >= 0 && run < runs());
  const std::int64_t sample = run % samples_;
  std::int64_t combination = run / samples_;
  std::vector<std::string> out(factors_.size());
  for (std::size_t k = factors_.size(); k-- > 0;) {  // the last factor changes first
    const Factor& f = factors_[k];
    if (f.random()) continue;
    const auto n = static_cast<std::int64_t>(f.values.size());
    out[k] = f.values[static_cast<std::size_t>(combination % n)];
    combination /= n;
  }
  std::size_t dimension = 0;
  for (std::size_t k = 0; k < factors_.size(); ++k)
    if (factors_[k].random())
      out[k] = with_unit(factors_[k].at_quantile(quantile(dimension++, sample)), factors_[k].unit);
  return out;
}

}  // namespace whirl::sweep
