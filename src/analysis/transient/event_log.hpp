// Events of a run: sign changes of a function of the state, located on the dense output, written
// down as they happen.
#pragma once
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
  };
  struct Happened {
    std::size_t watch;
    double t, speed;
    bool rising;
  };

  EventLog(std::vector<Watch> watches, Index reference)
      : watches_(std::move(watches)),
        reference_(reference),
        last_(watches_.size()) {}
  void begin(const Snapshot& s) override;
  void step(StepAccess& s) override;
  void save(OutArchive& out) const override;
  void restore(InArchive& in) override;
  const std::vector<Happened>& events() const { return events_; }
  /// Events beyond the first `most`, which are counted only.
  std::size_t more() const { return more_; }
  const std::vector<Watch>& watches() const { return watches_; }

 private:
  static constexpr std::size_t most = 10000;
  std::vector<Watch> watches_;
  Index reference_;
  std::vector<double> last_;  ///< of the sign each g had last
  std::vector<Happened> events_;
  std::size_t more_ = 0;
};

}  // namespace whirl::analysis
