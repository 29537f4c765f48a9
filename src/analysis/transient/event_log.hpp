// Events of a run: sign changes of a function of the state, located on the dense output, written
// down as they happen.
#pragma once
#include <analysis/transient/level_passages.hpp>
#include <analysis/transient/observer.hpp>
#include <functional>
#include <string>
#include <vector>

namespace whirl::analysis {

class EventLog final : public Observer {
 public:
  struct Watch {
    std::string name;
    std::function<double(const Snapshot&)> g;  ///< happens where g passes zero
    int direction = 0;                         ///< +1 rising, -1 falling, 0 both
    double reach = 0, hold = 0;                ///< see LevelPassages
  };
  struct Happened {
    std::size_t watch;
    double t, speed;
    bool rising;
  };

  EventLog(std::vector<Watch> watches, Index reference)
      : watches_(std::move(watches)),
        reference_(reference) {
    for (const Watch& w : watches_)
      passages_.emplace_back(w.reach, w.hold);
  }
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void stopped(const Snapshot& s, std::size_t event) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  const std::vector<Happened>& events() const { return events_; }
  /// Events beyond the first `most`, which are counted only.
  std::size_t more() const { return more_; }
  const std::vector<Watch>& watches() const { return watches_; }

 private:
  void add(std::size_t watch, double t, const Snapshot& s, bool rising);
  static constexpr std::size_t most = 10000;
  std::vector<Watch> watches_;
  Index reference_;
  std::vector<LevelPassages> passages_;  ///< one a watch
  double step_begin_ = 0;                ///< s, of the last step
  std::vector<Happened> events_;
  std::size_t more_ = 0;
};

}  // namespace whirl::analysis
