#include <run/checkpoint.hpp>

#include <core/archive.hpp>
#include <core/error.hpp>
#include <io/file.hpp>
#include <core/text.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>
#include <sstream>

namespace whirl::run {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view any_magic = "whirl checkpoint ";
constexpr std::string_view magic = "whirl checkpoint 8\n";

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
    {Part::temperatures, "temperatures"},
};

Part part_of(std::string_view name) {
  for (const PartName& p : part_names)
    if (p.name == name) return p.part;
  throw std::invalid_argument("checkpoint: no part has this name");
}

std::string encode(const Checkpoint& c) {
  OutArchive a(magic);
  std::size_t bytes = 0;
  for (const auto& [key, data] : c.parts)
    bytes += key.content.size() + data.size();
  a.reserve(2 * bytes);  // the parts are nearly all of it; what is not touched costs nothing
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
  a.put(c.state.frames.kept_rate);
  a.put(c.state.frames.kept_from);
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
  c.state.frames.kept_rate = a.numbers();
  c.state.frames.kept_from = a.number();
  if (!c.state.frames.kept_rate.empty() &&
      c.state.frames.kept_rate.size() != c.state.frames.kept.size())
    throw std::invalid_argument("checkpoint: rates of another run");
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

std::string earlier_checkpoint_name(const std::string& step) {
  return checkpoint_name(step) + std::string(earlier_extension);
}

namespace {

fs::path earlier_of(const fs::path& file) {
  fs::path earlier = file;
  earlier += earlier_extension;
  return earlier;
}

/// The file under its second name, and under its own until the new one takes its place: at no moment
/// is there none that is whole.
void keep_earlier(const fs::path& file) {
  const fs::path earlier = earlier_of(file);
  const fs::path second_name = io::temporary_beside(earlier);
  if (::link(file.c_str(), second_name.c_str()) == 0) {
    io::rename_into_place(second_name, earlier);
    ::unlink(second_name.c_str());  // nothing is renamed where both names are those of one file
    return;
  }
  if (errno == ENOENT) return;           // the first one
  io::rename_into_place(file, earlier);  // a file system without links
}

}  // namespace

void write_checkpoint(const fs::path& file, const Checkpoint& c) {
  std::string data = encode(c);
  const std::uint64_t sum = check_sum(data);
  data.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  keep_earlier(file);
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

namespace {

/// Why neither can be used.
[[noreturn]] void fail_both(const fs::path& earlier, const Error& of_last, bool there_is_earlier) {
  Diagnostic d = of_last.diagnostics().front();
  if (d.hint.empty())
    d.hint = there_is_earlier
                 ? fmt::format(
                       "the one before it, '{}', cannot be used either; run anew without "
                       "--resume",
                       earlier.string())
                 : "there is none before it; run anew without --resume";
  throw Error(Exit::io, std::move(d));
}

}  // namespace

std::optional<UsableCheckpoint> usable_checkpoint(const fs::path& file) {
  const fs::path earlier = earlier_of(file);
  std::error_code ec;
  const bool there_is_earlier = fs::exists(earlier, ec);
  std::string why = fmt::format("the checkpoint '{}' is not there", file.string());
  std::optional<Error> of_last;
  try {
    std::optional<Checkpoint> last = read_checkpoint(file);
    if (last) return UsableCheckpoint{std::move(*last), {}, {}};
    if (!there_is_earlier) return std::nullopt;
  } catch (const Error& e) {
    of_last = e;
    why = e.what();
  }
  try {
    std::optional<Checkpoint> before = read_checkpoint(earlier);
    if (before) return UsableCheckpoint{std::move(*before), earlier, std::move(why)};
  } catch (const Error& e) {
    if (!of_last) of_last = e;
  }
  fail_both(earlier, *of_last, there_is_earlier);
}

void put_back(const UsableCheckpoint& c, const fs::path& file) {
  if (!c.earlier.empty()) io::rename_into_place(c.earlier, file);
}

namespace {

struct Difference {
  std::string head, now, then;

  std::string text() const { return fmt::format("{}now '{}', then '{}'", head, now, then); }
};

/// The first line that differs, and the table it stands in.
std::optional<Difference> first_difference(const std::string& then, const std::string& now) {
  if (then == now) return std::nullopt;
  std::istringstream a(then), b(now);
  Difference d;
  for (;;) {
    const bool more_then = static_cast<bool>(std::getline(a, d.then));
    const bool more_now = static_cast<bool>(std::getline(b, d.now));
    if (!more_then) d.then = "(nothing)";
    if (!more_now) d.now = "(nothing)";
    if (!more_then || !more_now || d.then != d.now) return d;
    if (d.now.starts_with('[')) d.head = d.now + " ";
  }
}

/// Of a resolved deck the tables of what has mass and stiffness.
std::string rotor_tables(const std::string& deck) {
  constexpr std::string_view tables[]{"material", "shaft", "disk",      "bearing",
                                      "joint",    "crack", "foundation"};
  std::istringstream in(deck);
  std::string line, out;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with('[')) {
      const std::size_t begin = line.find_first_not_of('[');
      const std::size_t end = line.find_first_of(".]", begin);
      const std::string_view table = std::string_view(line).substr(begin, end - begin);
      inside = std::find(std::begin(tables), std::end(tables), table) != std::end(tables);
    }
    if (inside && !line.empty()) out += line + "\n";
  }
  return out;
}

}  // namespace

std::string other_rotor(const Checkpoint& c, const model::Model& model) {
  const auto d = first_difference(rotor_tables(c.deck), rotor_tables(model.moving.machine));
  return d ? d->text() : std::string();
}

void check_checkpoints(const fs::path& results, const model::Model& model) {
  for (const model::Step& s : model.steps) {
    const auto found = usable_checkpoint(checkpoint_file(results, s.name));
    if (!found) continue;
    const auto difference = first_difference(found->checkpoint.deck, what_moves(model, s.name));
    if (!difference) continue;
    throw Error(
        Exit::deck,
        Diagnostic{
            Diagnostic::Severity::error, "E94",
            fmt::format("the model is not the one of the checkpoint of step '{}': {}", s.name,
                        difference->text()),
            "a resumed run may change outputs, probes, duration and stop conditions; for another "
            "model start anew, without --resume",
            Where{model.deck_path, 0, 0, 0, {}}});
  }
}

bool has_checkpoint(const fs::path& results, const model::Model& model) {
  std::error_code ec;
  return std::any_of(model.steps.begin(), model.steps.end(), [&](const model::Step& s) {
    const fs::path file = checkpoint_file(results, s.name);
    return fs::exists(file, ec) || fs::exists(earlier_of(file), ec);
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
