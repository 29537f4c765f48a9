// Checkpoints of transient steps: the last and the one before, two files a step in
// <results>/checkpoint/, each written whole or not at all.
//
// A checkpoint holds the state, the integrator's memory, and what every observer knows, so that the
// continued run equals the uninterrupted one bit for bit. It also holds the deck as far as the
// motion depends on it: a changed model is refused, changed outputs and end conditions are not.
#pragma once
#include <analysis/transient/observer.hpp>
#include <model/model.hpp>
#include <system/system.hpp>
#include <time/integrator.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::run {

/// What a checkpoint keeps a part of.
enum class Part {
  series,
  plot_buffer,
  recorder,
  peaks,
  energy,
  tilt,
  step_lengths,
  frames,
  events,
  keyphasor,
  spectra,
  steady_motion,
  drives,
  wall_clock,
  limits,
  replay,
  torques,
  temperatures
};

/// A part and what decides whether the saved one fits: the columns of a series, the probes and
/// settings of a filter. Those that always fit have no content.
struct PartKey {
  Part part;
  std::string content{};
  auto operator<=>(const PartKey&) const = default;  // NOLINT(modernize-use-nullptr): not a pointer
};
/// As it stands in the file.
std::string_view to_string(Part p);

struct Checkpoint {
  std::string deck;               ///< what_moves() of the deck that wrote it
  double t_begin = 0, speed = 0;  ///< where the step began; reference speed, rad/s
  double seconds = 0;             ///< CPU time spent so far
  std::string reason;             ///< why the run ended, empty: it did not
  system::State state;
  time::IntegratorState integrator;
  std::map<PartKey, std::string> parts;  ///< archives of observers and outputs
};

/// What of the resolved deck the motion of a step depends on: the machine and the steps up to this
/// one, without the keys that declare that nothing moves by them (model::MovingDeck).
std::string what_moves(const model::Model& model, const std::string& step);

/// Name of a step's checkpoint in the results folder.
std::string checkpoint_name(const std::string& step);
std::filesystem::path checkpoint_file(const std::filesystem::path& results,
                                      const std::string& step);
/// What the name of the checkpoint before the last one has behind that of the last.
inline constexpr std::string_view earlier_extension = ".before";
std::string earlier_checkpoint_name(const std::string& step);
/// The one that was there is kept as the earlier one.
/// @throws Error (Exit::io, E91) when it cannot be written; what was there is then still there.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& c);
/// Nothing when there is no file.
/// @throws Error (E91) when it is damaged or of another version.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);
/// The last one, or the one before where that is damaged or lost.
struct UsableCheckpoint {
  Checkpoint checkpoint;
  std::filesystem::path earlier;  ///< where it was read from; empty: the last one
  std::string why;                ///< what is wrong with the last one
};
/// Nothing when there is neither file.
/// @throws Error (E91) when neither can be used.
std::optional<UsableCheckpoint> usable_checkpoint(const std::filesystem::path& file);
/// An earlier one takes the place of the damaged one, so that the next to be written does not replace
/// the only one that is whole.
void put_back(const UsableCheckpoint& c, const std::filesystem::path& file);
/// The state in which a transient step of another results folder ended (step: "" = its only one).
/// @throws Error (E91): there is none, or several.
Checkpoint last_state_of(const std::string& folder, const std::string& step);
/// Whether a folder that a step goes on from is the results folder of this run.
bool is_results_folder(const std::string& previous, const std::filesystem::path& results);
/// Names of the checkpoints in the results folder that steps of this run go on from, and that stand
/// there before it begins. Those of other folders are looked at too.
/// @throws Error (E91): one cannot be read; (E26): the run would write another one over it.
std::vector<std::string> states_to_keep(const model::Model& model,
                                        const std::filesystem::path& results);
/// How the rotor of a checkpoint differs from that of the model, in the first line of the resolved
/// deck that does; empty: they are one. Drives, loads and unbalance may change between runs.
std::string other_rotor(const Checkpoint& c, const model::Model& model);
/// deck: for the message.
/// @throws Error (E94): the state is one of another mesh.
void check_state_fits(const Checkpoint& c, const std::string& folder, const system::System& system,
                      const std::string& deck);
/// @throws Error (E94) with the first differing line when a checkpoint in the results folder is of
/// another model.
void check_checkpoints(const std::filesystem::path& results, const model::Model& model);
/// True when there is a checkpoint of any step.
bool has_checkpoint(const std::filesystem::path& results, const model::Model& model);

/// Things that are saved and restored together, each under its key: one whose key the checkpoint
/// does not have is new and begins where the run continues.
class Parts {
 public:
  void add(PartKey key, std::function<void(OutArchive&)> save,
           std::function<void(InArchive&)> restore);
  /// An observer; those restored from nothing are listed in fresh().
  void add(PartKey key, analysis::Observer& o);
  /// An output with files of its own: begin() opens them anew.
  template <class T>
  void add_output(PartKey key, T& x) {
    entries_.push_back({std::move(key), [&x](OutArchive& a) { x.save(a); },
                        [&x](InArchive& a) { x.restore(a); }, &x.observer(), [&x] { x.begin(); }});
  }
  void save(Checkpoint& c) const;
  /// null: everything begins.
  void restore(const Checkpoint* c);
  const std::vector<analysis::Observer*>& fresh() const { return fresh_; }

 private:
  struct Entry {
    PartKey key;
    std::function<void(OutArchive&)> save;
    std::function<void(InArchive&)> restore;
    analysis::Observer* observer = nullptr;
    std::function<void()> begin;
  };
  std::vector<Entry> entries_;
  std::vector<analysis::Observer*> fresh_;
};

}  // namespace whirl::run
