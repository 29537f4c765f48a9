#include <sweep/design.hpp>
#include <sweep/sampling.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/table.hpp>
#include <io/file.hpp>

#include <Eigen/Cholesky>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

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

/// Numbers, which stand in the tables of results without their units, or words.
void read_list(const std::string& text, const std::vector<std::string>& parts, Factor& f) {
  f.values = parts;
  if (!std::all_of(parts.begin(), parts.end(), [](const auto& p) { return number_of(p).ok; }))
    return;
  numbers_of(text, parts, f.unit);
  for (std::string& value : f.values)  // "60, 75, 90 um"
    if (number_of(value).unit.empty() && !f.unit.empty()) value += " " + f.unit;
}

struct LawName {
  const char* name;
  Factor::Law law;
  std::size_t parameters;
  const char* form;
};
constexpr LawName laws[] = {
    {"uniform", Distribution::Law::uniform, 2, "uniform(low, high)"},
    {"loguniform", Distribution::Law::loguniform, 2, "loguniform(low, high)"},
    {"triangular", Distribution::Law::triangular, 3, "triangular(low, mode, high)"},
    {"normal", Distribution::Law::normal, 2, "normal(mean, deviation)"},
    {"lognormal", Distribution::Law::lognormal, 2,
     "lognormal(median, deviation of the logarithm)"}};

/// What stands against the parameters of a distribution; empty: nothing.
std::string problem_of(const Distribution& f) {
  const auto& p = f.parameters;
  switch (f.law) {
    case Distribution::Law::uniform: return p[0] < p[1] ? "" : "the first value must be the lower";
    case Distribution::Law::loguniform:
      return 0 < p[0] && p[0] < p[1] ? "" : "the values must be above zero, the first the lower";
    case Distribution::Law::triangular:
      return p[0] <= p[1] && p[1] <= p[2] && p[0] < p[2] ? "" : "the values must ascend";
    case Distribution::Law::normal: return p[1] > 0 ? "" : "the deviation must be above zero";
    case Distribution::Law::lognormal:
      return p[0] > 0 && p[1] > 0 ? "" : "median and deviation must be above zero";
    case Distribution::Law::values: break;
  }
  return "";
}

/// A distribution without its name and parentheses; unit: of its numbers.
Distribution read_law(const std::string& text, const LawName& law, const std::string& inside,
                      std::string& unit) {
  Distribution f;
  f.law = law.law;
  std::vector<std::string> parts = split(inside, ',');
  if (parts.size() != law.parameters)
    throw bad_factor(text, fmt::format("{} values where {} belong", parts.size(), law.parameters),
                     law.form);
  if (law.law == Distribution::Law::lognormal) {  // the second is a plain number
    f.parameters = numbers_of(text, {parts[0]}, unit);
    std::string none;
    f.parameters.push_back(numbers_of(text, {parts[1]}, none)[0]);
    if (none == "%") f.parameters[1] *= 0.01;
    if (!none.empty() && none != "%")
      throw bad_factor(text, "the deviation of a logarithm has no unit", law.form);
  } else if (law.law == Distribution::Law::normal && number_of(parts[1]).unit == "%") {
    f.parameters = numbers_of(text, {parts[0]}, unit);
    f.parameters.push_back(0.01 * number_of(parts[1]).value * std::abs(f.parameters[0]));
  } else {
    f.parameters = numbers_of(text, parts, unit);
  }
  if (const std::string problem = problem_of(f); !problem.empty())
    throw bad_factor(text, problem, law.form);
  return f;
}

/// What begins like a distribution, as one; none: it does not.
std::optional<Distribution> read_distribution(const std::string& text, const std::string& values,
                                              std::string& unit) {
  for (const LawName& law : laws) {
    const std::string head = std::string(law.name) + "(";
    if (!values.starts_with(head)) continue;
    if (values.back() != ')') throw bad_factor(text, "no closing parenthesis", law.form);
    return read_law(text, law, values.substr(head.size(), values.size() - head.size() - 1), unit);
  }
  return {};
}

/// "normal(1, 0.1) drawn uniform(0.5, 2)"
void read_drawn(const std::string& text, const std::string& from, Factor& f) {
  std::string unit;
  f.drawn = read_distribution(text, from, unit);
  if (!f.drawn)
    throw bad_factor(text, fmt::format("'{}' is no distribution", from),
                     "for instance normal(1, 0.1) drawn uniform(0.5, 2)");
  if (unit != f.unit)
    throw bad_factor(text, fmt::format("units '{}' and '{}' in one key", f.unit, unit),
                     "write both distributions in one unit");
  // what is never drawn cannot count
  constexpr double negligible = 1e-6;
  const auto& bounds = f.drawn->parameters;
  const bool endless =
      f.drawn->law == Distribution::Law::normal || f.drawn->law == Distribution::Law::lognormal;
  if (endless) return;
  const double missed =
      normal_probability(f.score(bounds.front())) + normal_probability(-f.score(bounds.back()));
  if (missed > negligible)
    throw bad_factor(
        text,
        fmt::format("'{}' never draws {:.2g} of what the first distribution holds", from, missed),
        "draw from a distribution that reaches as far");
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
  const auto drawn = values.find(" drawn ");
  if (auto law = read_distribution(text, trimmed(values.substr(0, drawn)), f.unit)) {
    f.law = law->law;
    f.parameters = std::move(law->parameters);
    if (drawn != std::string::npos) read_drawn(text, trimmed(values.substr(drawn + 7)), f);
    return f;
  }
  const std::vector<std::string> ends = split(values, ':');
  if (ends.size() > 1 && number_of(ends[0]).ok)
    read_range(text, ends, f);
  else
    read_list(text, split(values, ','), f);
  if (std::any_of(f.values.begin(), f.values.end(), [](const auto& v) { return v.empty(); }))
    throw bad_factor(text, "an empty value", "values are parted by commas");
  return f;
}

namespace {

/// The cells of a column of runs as values of a factor, whose unit is that of the heading where it has one.
void read_column(const std::string& text, std::vector<std::string> cells, Factor& f) {
  if (f.unit.empty()) {
    read_list(text, cells, f);
    return;
  }
  for (std::string& cell : cells) {
    const Number n = number_of(cell);
    if (n.ok && !n.unit.empty())
      throw bad_factor(text, fmt::format("'{}' has a unit, and its heading has '{}'", cell, f.unit),
                       "write the unit in the heading alone, or in the cells alone");
    cell += " " + f.unit;
  }
  f.values = std::move(cells);
}

}  // namespace

std::vector<Factor> read_runs(const std::filesystem::path& file, int number) {
  const auto refuse = [&](const std::string& problem) {
    return bad_factor("@" + file.string(), problem,
                      "a table of runs: a heading of keys, then a row of values a run");
  };
  const CellTable table = read_cells(io::read_text(file));
  if (!table.problem.empty())
    throw refuse(fmt::format("line {}: {}", table.problem_line, table.problem));
  if (table.header.empty() || table.rows.empty()) throw refuse("no runs");
  std::vector<Factor> factors;
  for (std::size_t k = 0; k < table.header.size(); ++k) {
    const ColumnTitle title = split_title(table.header[k].text);
    Factor f;
    f.path = title.name;
    f.unit = title.unit == "-" ? "" : title.unit;
    f.file = number;
    if (f.path.empty()) throw refuse(fmt::format("column {} has no heading", k + 1));
    std::vector<std::string> cells;
    for (const auto& row : table.rows) {
      if (row.size() != table.header.size())
        throw refuse(fmt::format("line {}: {} values where {} belong", row[0].line, row.size(),
                                 table.header.size()));
      if (row[k].text.empty())
        throw refuse(fmt::format("line {}: the cell of '{}' is empty", row[0].line, f.path));
      cells.push_back(row[k].text);
    }
    read_column(fmt::format("@{}: {}", file.string(), f.path), std::move(cells), f);
    factors.push_back(std::move(f));
  }
  return factors;
}

Correlation read_correlation(const std::string& text) {
  const auto refuse = [&] {
    return Error(Exit::usage,
                 Diagnostic{Diagnostic::Severity::error, "E99",
                            fmt::format("--correlation '{}' is not PATH,PATH=NUMBER", text),
                            "a number between -1 and 1, for instance "
                            "bearing.DE.clearance,bearing.NDE.clearance=0.8",
                            Where{}});
  };
  const auto equals = text.rfind('=');
  if (equals == std::string::npos) throw refuse();
  const std::vector<std::string> paths = split(text.substr(0, equals), ',');
  const Number n = number_of(trimmed(text.substr(equals + 1)));
  if (paths.size() != 2 || paths[0].empty() || paths[1].empty() || paths[0] == paths[1] || !n.ok ||
      !n.unit.empty() || !(std::abs(n.value) < 1.0))
    throw refuse();
  return {paths[0], paths[1], n.value};
}

double Distribution::density(double x) const {
  const auto& a = parameters;
  const auto normal = [](double z) { return std::exp(-0.5 * z * z) / std::sqrt(two_pi); };
  const bool inside = law == Law::normal || (x >= a[0] && x <= a.back());
  switch (law) {
    case Law::uniform: return inside ? 1.0 / (a[1] - a[0]) : 0.0;
    case Law::loguniform: return inside ? 1.0 / (x * std::log(a[1] / a[0])) : 0.0;
    case Law::triangular: {
      if (!inside) return 0.0;
      const double top = 2.0 / (a[2] - a[0]);
      if (x < a[1]) return top * (x - a[0]) / (a[1] - a[0]);
      return a[2] > a[1] ? top * (a[2] - x) / (a[2] - a[1]) : top;
    }
    case Law::normal: return normal((x - a[0]) / a[1]) / a[1];
    case Law::lognormal: return x > 0 ? normal(std::log(x / a[0]) / a[1]) / (a[1] * x) : 0.0;
    case Law::values: break;
  }
  return nan;
}

double Distribution::at_quantile(double p) const {
  WHIRL_EXPECTS(law != Law::values && p > 0 && p < 1);
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

double Distribution::score(double x) const {
  const auto& a = parameters;
  const auto of_probability = [](double p) {
    return p <= 0 ? -infinity : p >= 1 ? infinity : normal_quantile(p);
  };
  switch (law) {
    case Law::uniform: return of_probability((x - a[0]) / (a[1] - a[0]));
    case Law::loguniform: return of_probability(std::log(x / a[0]) / std::log(a[1] / a[0]));
    case Law::triangular: {
      const double width = a[2] - a[0];
      if (x < a[1]) return of_probability((x - a[0]) * (x - a[0]) / (width * (a[1] - a[0])));
      return -of_probability((a[2] - x) * (a[2] - x) / (width * (a[2] - a[1])));
    }
    case Law::normal: return (x - a[0]) / a[1];
    case Law::lognormal: return std::log(x / a[0]) / a[1];
    case Law::values: break;
  }
  return nan;
}

namespace {

[[noreturn]] void refuse(const std::string& message, const std::string& hint) {
  throw Error(Exit::usage, Diagnostic{Diagnostic::Severity::error, "E99", message, hint, Where{}});
}

bool is_scheme(Sampling s) {
  return s == Sampling::saltelli || s == Sampling::morris || s == Sampling::one_at_a_time;
}

/// The first factor of a file stands for all of it.
bool counts(const std::vector<Factor>& factors, std::size_t k) {
  if (factors[k].random()) return false;
  return factors[k].file < 0 || k == 0 || factors[k - 1].file != factors[k].file;
}

}  // namespace

Design::Design(std::vector<Factor> factors, std::int64_t samples, Sampling sampling,
               std::uint64_t seed, const std::vector<Correlation>& correlations)
    : factors_(std::move(factors)),
      sampling_(sampling),
      seed_(seed) {
  double count = 1;
  std::int64_t distributions = 0;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    for (std::size_t j = 0; j < k; ++j)
      if (factors_[j].path == factors_[k].path)
        refuse(fmt::format("'{}' is varied twice", factors_[k].path), "one --vary a key");
    distributions += factors_[k].random();
    if (counts(factors_, k)) count *= static_cast<double>(factors_[k].values.size());
  }
  if (is_scheme(sampling_)) require_no_lists();
  if (distributions == 0 && samples > 1)
    refuse("there is nothing to sample: no key has a distribution",
           "for instance --vary 'bearing.NDE.clearance=uniform(60 um, 90 um)'");
  if (distributions > 0 && samples < 2 && sampling_ != Sampling::one_at_a_time)
    refuse("distributions need a number of samples", "for instance --samples 200");
  if (sampling_ == Sampling::sobol && distributions > std::int64_t{sobol_dimensions})
    refuse(fmt::format("{} distributions, and Sobol's points are laid for {} at most",
                       distributions, sobol_dimensions),
           "--sampling lhs takes any number");
  base_ = std::max<std::int64_t>(samples, 1);
  const std::int64_t each = sampling_ == Sampling::saltelli ? distributions + 2
                            : sampling_ == Sampling::morris ? distributions + 1
                                                            : 1;
  samples_ = sampling_ == Sampling::one_at_a_time ? 2 * distributions + 1 : base_ * each;
  count *= static_cast<double>(base_) * static_cast<double>(each);
  if (count > most_runs)
    refuse(fmt::format("{:.3g} runs are more than {:.0e}", count, most_runs),
           "take fewer values, or sample them from distributions");
  for (std::size_t k = 0; k < factors_.size(); ++k)
    if (counts(factors_, k)) combinations_ *= static_cast<std::int64_t>(factors_[k].values.size());
  if (!correlations.empty()) correlate(correlations);
}

void Design::require_no_lists() const {
  for (const Factor& f : factors_) {
    if (!f.random())
      refuse(fmt::format("'{}' has a list of values beside a scheme of sensitivity", f.path),
             "give it a distribution, for instance uniform(low, high)");
    if (f.drawn)
      refuse(fmt::format("'{}' has weighted samples in a scheme of sensitivity", f.path),
             "leave 'drawn' out, or take --sampling random");
  }
  if (factors_.empty()) refuse("nothing is varied", "for instance --vary 'a.b=uniform(1, 2)'");
}

void Design::correlate(const std::vector<Correlation>& correlations) {
  if (is_scheme(sampling_))
    refuse("a scheme of sensitivity takes its numbers as independent",
           "leave --correlation out, or take --sampling lhs");
  std::vector<std::string> paths;
  for (const Factor& f : factors_)
    if (f.random()) paths.push_back(f.path);
  const auto n = static_cast<Index>(paths.size());
  MatX r = MatX::Identity(n, n);
  const auto place = [&](const std::string& path) {
    const auto it = std::find(paths.begin(), paths.end(), path);
    if (it == paths.end())
      refuse(fmt::format("--correlation: '{}' has no distribution", path),
             "keys as --vary has them, with a distribution each");
    return static_cast<Index>(it - paths.begin());
  };
  std::set<std::pair<Index, Index>> given;
  for (const Correlation& c : correlations) {
    const Index a = place(c.first), b = place(c.second);
    if (!given.insert(std::minmax(a, b)).second)
      refuse(fmt::format("'{}' and '{}' are correlated twice", c.first, c.second),
             "one --correlation a pair");
    r(a, b) = r(b, a) = c.value;
  }
  const Eigen::LLT<MatX> factor(r);
  if (factor.info() != Eigen::Success)
    refuse("the correlations contradict each other: their matrix is not positive definite",
           "make them smaller");
  cholesky_ = factor.matrixL();
}

double Design::independent(std::size_t dimension, std::int64_t sample) const {
  std::size_t dimensions = 0;
  switch (sampling_) {
    case Sampling::random: return random_point(seed_, dimension, sample);
    case Sampling::latin_hypercube: return latin_point(seed_, dimension, sample, samples_);
    case Sampling::sobol: return sobol_point(seed_, dimension, sample);
    case Sampling::saltelli:
    case Sampling::morris:
      dimensions = factors_.size();
      return sampling_ == Sampling::saltelli
                 ? saltelli_point(seed_, dimension, dimensions, sample)
                 : morris_quantile(morris_level(seed_, dimension, dimensions, sample));
    case Sampling::one_at_a_time: {
      const auto own = static_cast<std::int64_t>(2 * dimension + 1);
      return sample == own ? 0.05 : sample == own + 1 ? 0.95 : 0.5;
    }
  }
  return nan;
}

std::vector<double> Design::quantiles(std::int64_t sample) const {
  WHIRL_EXPECTS(sample >= 0 && sample < samples_);
  std::vector<double> out;
  for (const Factor& f : factors_)
    if (f.random()) out.push_back(independent(out.size(), sample));
  if (cholesky_.size() == 0) return out;
  const auto n = static_cast<Index>(out.size());
  VecX score(n);
  for (Index k = 0; k < n; ++k)
    score[k] = normal_quantile(out[static_cast<std::size_t>(k)]);
  const VecX together = cholesky_ * score;
  constexpr double least = 0x1p-53;
  for (Index k = 0; k < n; ++k)
    if (cholesky_(k, k) != 1.0)  // what depends on none before it stays as it is
      out[static_cast<std::size_t>(k)] =
          std::clamp(normal_probability(together[k]), least, 1.0 - least);
  return out;
}

std::vector<std::string> Design::values(std::int64_t run) const {
  WHIRL_EXPECTS(run >= 0 && run < runs());
  std::int64_t combination = run / samples_;
  std::vector<std::string> out(factors_.size());
  for (std::size_t k = factors_.size(); k-- > 0;) {  // the last factor changes first
    const Factor& f = factors_[k];
    if (f.random()) continue;
    const auto n = static_cast<std::int64_t>(f.values.size());
    out[k] = f.values[static_cast<std::size_t>(combination % n)];
    if (counts(factors_, k)) combination /= n;
  }
  const std::vector<double> q = quantiles(run % samples_);
  std::size_t dimension = 0;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const Factor& f = factors_[k];
    if (!f.random()) continue;
    const Distribution& from = f.drawn ? *f.drawn : f;
    out[k] = with_unit(from.at_quantile(q[dimension++]), f.unit);
  }
  return out;
}

bool Design::weighted() const {
  return std::any_of(factors_.begin(), factors_.end(),
                     [](const Factor& f) { return f.drawn.has_value(); });
}

double Design::weight(std::int64_t run) const {
  WHIRL_EXPECTS(run >= 0 && run < runs());
  if (!weighted()) return 1.0;
  const std::vector<double> q = quantiles(run % samples_);
  double w = 1.0;
  VecX drawn(static_cast<Index>(q.size())), wanted(static_cast<Index>(q.size()));
  Index dimension = 0;
  for (const Factor& f : factors_) {
    if (!f.random()) continue;
    const double p = q[at(dimension)];
    drawn[dimension] = wanted[dimension] = normal_quantile(p);
    if (f.drawn) {
      const double x = f.drawn->at_quantile(p);
      w *= f.density(x) / f.drawn->density(x);
      wanted[dimension] = f.score(x);
    }
    ++dimension;
  }
  if (!(w > 0.0) || cholesky_.size() == 0) return w;
  // densities of correlated keys are those of the keys alone times that of the Gaussian copula
  return w * std::exp(log_copula(wanted) - log_copula(drawn));
}

double Design::log_copula(const VecX& score) const {
  const VecX independent = cholesky_.triangularView<Eigen::Lower>().solve(score);
  return 0.5 * (score.squaredNorm() - independent.squaredNorm());
}

}  // namespace whirl::sweep
