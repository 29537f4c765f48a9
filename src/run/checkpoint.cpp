#include <run/checkpoint.hpp>

#include <core/archive.hpp>
#include <core/error.hpp>
#include <io/file.hpp>
#include <core/text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>

namespace whirl::run {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view any_magic = "whirl checkpoint ";
constexpr std::string_view magic = "whirl checkpoint 6\n";

/// FNV-1a of words of 64 bits, the rest byte by byte: finds a damaged file, not an ill-willed one.
/// What a word changes in the lower bits alone, the fold after it carries on.
std::uint64_t check_sum(std::string_view s) {
  constexpr std::uint64_t prime = 1099511628211ull;
  std::uint64_t h = 14695981039346656037ull;
  for (; s.size() >= sizeof h; s.remove_prefix(sizeof h)) {
    std::uint64_t word = 0;
    std::memcpy(&word, s.data(), sizeof word);
    h = (h ^ word) * prime;
    h ^= h >> 32;
  }
  for (const char c : s)
    h = (h ^ static_cast<unsigned char>(c)) * prime;
  return h;
}

struct PartName {
  Part part;
  std::string_view name;
};
constexpr PartName part_names[] = {
    {Part::series, "series"},
    {Part::plot_buffer, "plot buffer"},
    {Part::recorder, "recorder"},
    {Part::peaks, "peaks"},
    {Part::energy, "energy"},
    {Part::tilt, "tilt"},
    {Part::step_lengths, "step lengths"},
    {Part::frames, "frames"},
    {Part::events, "events"},
    {Part::keyphasor, "keyphasor"},
    {Part::spectra, "spectra"},
    {Part::steady_motion, "steady motion"},
    {Part::drives, "governors"},
    {Part::wall_clock, "wall clock"},
    {Part::limits, "limits"},
    {Part::replay, "replay"},
    {Part::torques, "torques"},
};

Part part_of(std::string_view name) {
  for (const PartName& p : part_names)
    if (p.name == name) return p.part;
  throw std::invalid_argument("checkpoint: no part has this name");
}

std::string encode(const Checkpoint& c) {
  OutArchive a(magic);
  a.put(c.deck);
  a.put(c.t_begin);
  a.put(c.speed);
  a.put(c.seconds);
  a.put(c.reason);
  a.put(c.state.t);
  a.put(c.state.q);
  a.put(c.state.v);
  a.put(c.state.a);
  a.put_count(c.state.frames.chart.size());
  for (const Mat3& m : c.state.frames.chart)
    a.put(std::span<const double>(m.data(), 9));
  a.put(c.state.frames.turns);
  a.put(std::vector<double>(c.state.frames.of_node.begin(), c.state.frames.of_node.end()));
  a.put(c.state.frames.shift);
  a.put(c.state.frames.lead);
  a.put(c.state.frames.link);
  a.put(c.state.frames.joint);
  a.put(c.state.frames.kept);
  a.put(c.integrator.serialize());
  a.put_count(c.parts.size());
  for (const auto& [key, data] : c.parts) {
    a.put(to_string(key.part));
    a.put(key.content);
    a.put(data);
  }
  return a.take();
}

Checkpoint decode(std::string_view data) {
  InArchive a(data);
  Checkpoint c;
  c.deck = a.text();
  c.t_begin = a.number();
  c.speed = a.number();
  c.seconds = a.number();
  c.reason = a.text();
  c.state.t = a.number();
  c.state.q = a.vector();
  c.state.v = a.vector();
  c.state.a = a.vector();
  for (std::uint64_t n = a.count(); n > 0; --n) {
    const std::vector<double> x = a.numbers();
    if (x.size() != 9) throw std::invalid_argument("checkpoint: a chart is not 3 x 3");
    c.state.frames.chart.push_back(Eigen::Map<const Mat3>(x.data()));
  }
  c.state.frames.turns = a.numbers();
  const double charts = static_cast<double>(c.state.frames.chart.size());
  for (const double chart : a.numbers()) {
    if (!(chart >= 0.0 && chart < charts))
      throw std::invalid_argument("checkpoint: a node without a chart");
    c.state.frames.of_node.push_back(static_cast<int>(chart));
  }
  c.state.frames.shift = a.numbers();
  c.state.frames.lead = a.numbers();
  c.state.frames.link = a.numbers();
  c.state.frames.joint = a.numbers();
  c.state.frames.kept = a.numbers();
  c.integrator = time::IntegratorState::deserialize(a.numbers());
  for (std::uint64_t n = a.count(); n > 0; --n) {
    const Part part = part_of(a.text());
    PartKey key{part, a.text()};
    c.parts[std::move(key)] = a.text();
  }
  return c;
}

}  // namespace

std::string_view to_string(Part p) {
  return std::find_if(std::begin(part_names), std::end(part_names),
                      [p](const PartName& n) { return n.part == p; })
      ->name;
}

std::string what_moves(const model::Model& model, const std::string& step) {
  std::string out = model.moving.machine;
  for (std::size_t k = 0; k < model.moving.steps.size(); ++k) {
    out += model.moving.steps[k];
    if (model.steps[k].name == step) break;
  }
  return out;
}

std::string checkpoint_name(const std::string& step) {
  return "checkpoint/" + safe_name(step) + ".whirl";
}

fs::path checkpoint_file(const fs::path& results, const std::string& step) {
  return results / checkpoint_name(step);
}

void write_checkpoint(const fs::path& file, const Checkpoint& c) {
  std::string data = encode(c);
  const std::uint64_t sum = check_sum(data);
  data.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  io::write_atomic(file, data);
}

std::optional<Checkpoint> read_checkpoint(const fs::path& file) {
  std::error_code ec;
  if (!fs::exists(file, ec)) return std::nullopt;
  const std::string data = io::read_text(file);
  std::uint64_t sum = 0;
  if (data.starts_with(any_magic) && !data.starts_with(magic))
    io::io_failure(file,
                   "checkpoint of another version of the program, run anew without --resume:");
  if (data.size() < magic.size() + sizeof sum || !data.starts_with(magic))
    io::io_failure(file, "not a checkpoint:");
  std::memcpy(&sum, data.data() + data.size() - sizeof sum, sizeof sum);
  const std::string_view body = std::string_view(data).substr(0, data.size() - sizeof sum);
  if (sum != check_sum(body)) io::io_failure(file, "damaged checkpoint:");
  try {
    return decode(body.substr(magic.size()));
  } catch (const std::invalid_argument&) {
    io::io_failure(file, "damaged checkpoint:");
  }
}

void check_checkpoints(const fs::path& results, const model::Model& model) {
  for (const model::Step& s : model.steps) {
    const fs::path file = checkpoint_file(results, s.name);
    const auto c = read_checkpoint(file);
    if (!c) continue;
    const std::string now = what_moves(model, s.name);
    if (c->deck == now) continue;
    std::istringstream a(c->deck), b(now);
    std::string old_line, new_line;
    int table = 0;
    std::string head;
    for (;; ++table) {
      const bool more_a = static_cast<bool>(std::getline(a, old_line)),
                 more_b = static_cast<bool>(std::getline(b, new_line));
      if (!more_a) old_line = "(nothing)";
      if (!more_b) new_line = "(nothing)";
      if (!more_a || !more_b || old_line != new_line) break;
      if (new_line.starts_with('[')) head = new_line + " ";
    }
    throw Error(
        Exit::deck,
        Diagnostic{
            Diagnostic::Severity::error, "E94",
            fmt::format(
                "the model is not the one of the checkpoint of step '{}': {}now '{}', then '{}'",
                s.name, head, new_line, old_line),
            "a resumed run may change outputs, probes, duration and stop conditions; for another "
            "model start anew, without --resume",
            Where{model.deck_path, 0, 0, 0, {}}});
  }
}

bool has_checkpoint(const fs::path& results, const model::Model& model) {
  std::error_code ec;
  return std::any_of(model.steps.begin(), model.steps.end(), [&](const model::Step& s) {
    return fs::exists(checkpoint_file(results, s.name), ec);
  });
}

void Parts::add(PartKey key, std::function<void(OutArchive&)> save,
                std::function<void(InArchive&)> restore) {
  entries_.push_back({std::move(key), std::move(save), std::move(restore), nullptr, {}});
}

void Parts::add(PartKey key, analysis::Observer& o) {
  entries_.push_back({std::move(key),
                      [&o](OutArchive& a) { o.save(a); },
                      [&o](InArchive& a) { o.restore(a); },
                      &o,
                      {}});
}

void Parts::save(Checkpoint& c) const {
  for (const Entry& p : entries_) {
    OutArchive a;
    p.save(a);
    c.parts[p.key] = a.take();
  }
}

void Parts::restore(const Checkpoint* c) {
  for (const Entry& p : entries_) {
    const auto it = c ? c->parts.find(p.key) : decltype(c->parts.end()){};
    if (!c || it == c->parts.end()) {
      if (p.begin) p.begin();
      if (p.observer) fresh_.push_back(p.observer);
      continue;
    }
    InArchive a(it->second);
    p.restore(a);
  }
}

}  // namespace whirl::run
