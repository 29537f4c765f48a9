#include <io/queued_frames.hpp>
#include <array>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace whirl::io {
namespace {

/// A frame with numbers of its own. One that held a frame of the same scene takes another without
/// asking for memory.
class OwnedFrame {
 public:
  void take(const FrameState& s) {
    time_ = s.time;
    copy(s.nodes, nodes_);
    copy(s.charts, charts_);
    copy(s.velocity, velocity_);
    copy(s.angular_velocity, angular_velocity_);
    copy(s.force, force_);
    copy(s.moment, moment_);
    copy(s.stress, stress_);
    copy(s.support_force, support_force_);
    copy(s.joint_force, joint_force_);
    copy(s.support_moment, support_moment_);
    copy(s.joint_moment, joint_moment_);
  }

  FrameState state() const {
    FrameState s;
    s.time = time_;
    s.nodes = nodes_;
    s.charts = charts_;
    s.velocity = velocity_;
    s.angular_velocity = angular_velocity_;
    s.force = force_;
    s.moment = moment_;
    s.stress = stress_;
    s.support_force = support_force_;
    s.joint_force = joint_force_;
    s.support_moment = support_moment_;
    s.joint_moment = joint_moment_;
    return s;
  }

 private:
  template <class T>
  static void copy(std::span<const T> from, std::vector<T>& to) {
    to.assign(from.begin(), from.end());
  }

  double time_ = 0.0;
  std::vector<Pose> nodes_;
  std::vector<Mat3> charts_;
  std::vector<Vec3> velocity_, angular_velocity_, force_, moment_, support_force_, joint_force_,
      support_moment_, joint_moment_;
  std::vector<double> stress_;
};

class QueuedFrames final : public FrameWriter {
 public:
  explicit QueuedFrames(std::unique_ptr<FrameWriter> writer) : writer_(std::move(writer)) {}

  ~QueuedFrames() override {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    offered_.notify_one();
    // the thread ends when nothing is left
  }

  void begin(const Scene& scene) override {
    drain();
    writer_->begin(scene);
  }

  void frame(const FrameState& state) override {
    // the slot behind the last waiting frame is nobody's but ours
    slots_[free_slot()].take(state);
    {
      const std::lock_guard lock(mutex_);
      ++waiting_;
    }
    offered_.notify_one();
    if (!thread_) thread_.emplace([this] { write_all(); });
  }

  void end() override {
    drain();
    writer_->end();
  }

  std::uint64_t frames() const override {
    drain();
    return writer_->frames();
  }

  void save(OutArchive& out) const override {
    drain();
    writer_->save(out);
  }

  void resume(const Scene& scene, InArchive& in) override {
    drain();
    writer_->resume(scene, in);
  }

 private:
  static constexpr std::size_t capacity = 16;

  std::size_t free_slot() {
    std::unique_lock lock(mutex_);
    written_.wait(lock, [this] { return waiting_ < capacity; });
    if (failure_) std::rethrow_exception(failure_);
    return (first_ + waiting_) % capacity;
  }

  void drain() const {
    std::unique_lock lock(mutex_);
    written_.wait(lock, [this] { return waiting_ == 0; });
    if (failure_) std::rethrow_exception(failure_);
  }

  void write_all() {
    std::unique_lock lock(mutex_);
    while (true) {
      offered_.wait(lock, [this] { return waiting_ > 0 || closing_; });
      if (waiting_ == 0) return;
      if (!failure_) {
        const OwnedFrame& next = slots_[first_];
        lock.unlock();
        const std::exception_ptr failure = write(next);
        lock.lock();
        failure_ = failure;
      }
      first_ = (first_ + 1) % capacity;
      --waiting_;
      // who waits for room gets half of it at once: the two threads do not change at every frame
      if (waiting_ == capacity / 2 || waiting_ == 0) written_.notify_one();
    }
  }

  std::exception_ptr write(const OwnedFrame& frame) {
    try {
      writer_->frame(frame.state());
    } catch (...) {
      return std::current_exception();
    }
    return nullptr;
  }

  std::unique_ptr<FrameWriter> writer_;  ///< the thread's while frames wait, else the caller's
  std::array<OwnedFrame, capacity> slots_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable offered_;
  mutable std::condition_variable written_;
  std::size_t first_ = 0, waiting_ = 0;  ///< slots of the frames that wait, round about
  std::exception_ptr failure_;
  bool closing_ = false;
  std::optional<std::jthread> thread_;  ///< ends first
};

}  // namespace

std::unique_ptr<FrameWriter> make_queued_frames(std::unique_ptr<FrameWriter> writer) {
  return std::make_unique<QueuedFrames>(std::move(writer));
}

}  // namespace whirl::io
