// Frames written by a thread of their own: the same frames in the same order, from bounded memory, and
// failures come back.
#include "temp_folder.hpp"
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <fmt/format.h>
#include <io/file.hpp>
#include <io/queued_frames.hpp>
#include <signal.h>
#include <sys/resource.h>
#include <future>
#include <set>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

struct Seen {
  std::vector<double> times, numbers;
  std::set<const Pose*> places;  ///< where the poses stood
  std::uint64_t begun = 0, ended = 0, saved = 0, resumed = 0;
};

/// Notes what it gets; fails at one frame, waits for a gate where there is one.
class Notes final : public FrameWriter {
 public:
  explicit Notes(Seen& seen, std::size_t fails_at = 1000000, std::shared_future<void> gate = {})
      : seen_(seen),
        fails_at_(fails_at),
        gate_(std::move(gate)) {}
  void begin(const Scene&) override { ++seen_.begun; }
  void frame(const FrameState& s) override {
    if (gate_.valid()) gate_.wait();
    if (seen_.times.size() == fails_at_) io_failure("frame.vtp", "cannot write", ENOSPC);
    seen_.times.push_back(s.time);
    seen_.places.insert(s.nodes.data());
    for (const Pose& p : s.nodes)
      seen_.numbers.insert(seen_.numbers.end(), {p.r[0], p.d[1], p.phi});
    for (const Mat3& m : s.charts)
      seen_.numbers.push_back(m(1, 2));
    for (const auto& vectors :
         {s.velocity, s.angular_velocity, s.force, s.moment, s.support_force, s.joint_force})
      for (const Vec3& v : vectors)
        seen_.numbers.push_back(v[2]);
    seen_.numbers.insert(seen_.numbers.end(), s.stress.begin(), s.stress.end());
  }
  void end() override { ++seen_.ended; }
  std::uint64_t frames() const override { return seen_.times.size(); }
  void save(OutArchive& out) const override {
    ++seen_.saved;
    out.put_count(seen_.times.size());
  }
  void resume(const Scene&, InArchive& in) override { seen_.resumed = in.count(); }

 private:
  Seen& seen_;
  std::size_t fails_at_;
  std::shared_future<void> gate_;
};

/// Offers frame k from arrays that go at once.
void offer(FrameWriter& w, int k) {
  const double x = k;
  const std::vector<Pose> nodes(2, Pose{Vec3(x, 0, 0), Vec3(0, x + 0.1, 0), x + 0.2});
  const std::vector<Mat3> charts(1, Mat3::Constant(x + 0.3));
  const std::vector<Vec3> v(2, Vec3::Constant(x + 0.4)), o(2, Vec3::Constant(x + 0.5)),
      f(3, Vec3::Constant(x + 0.6)), m(3, Vec3::Constant(x + 0.7)), s(1, Vec3::Constant(x + 0.8)),
      j(1, Vec3::Constant(x + 0.9));
  const std::vector<double> stress(3, x + 0.95);
  FrameState state;
  state.time = x;
  state.nodes = nodes;
  state.charts = charts;
  state.velocity = v;
  state.angular_velocity = o;
  state.force = f;
  state.moment = m;
  state.stress = stress;
  state.support_force = s;
  state.joint_force = j;
  w.frame(state);
}

std::size_t threads() {
  const fs::directory_iterator tasks("/proc/self/task");
  return static_cast<std::size_t>(std::distance(begin(tasks), end(tasks)));
}

TEST(QueuedFrames, AreThoseThatWereOfferedInTheirOrder) {
  Seen expected, seen;
  Notes alone(expected);
  const auto queued = make_queued_frames(std::make_unique<Notes>(seen));
  queued->begin({});
  for (int k = 0; k < 200; ++k) {
    offer(alone, k);
    offer(*queued, k);
  }
  EXPECT_EQ(queued->frames(), 200u);
  queued->end();
  EXPECT_EQ(seen.times, expected.times);
  EXPECT_EQ(seen.numbers, expected.numbers);
  EXPECT_EQ(seen.begun, 1u);
  EXPECT_EQ(seen.ended, 1u);
  EXPECT_LE(seen.places.size(), 16u);  // they go round
}

TEST(QueuedFrames, NoThreadWithoutFrames) {
  Seen seen;
  const std::size_t before = threads();
  {
    const auto queued = make_queued_frames(std::make_unique<Notes>(seen));
    queued->begin({});
    OutArchive out;
    queued->save(out);
    queued->end();
    EXPECT_EQ(threads(), before);
    offer(*queued, 0);
    EXPECT_EQ(threads(), before + 1);
  }
  EXPECT_EQ(seen.times.size(), 1u);  // the destructor does not drop it
}

TEST(QueuedFrames, TheSolverWaitsWhereManyAreNotWritten) {
  Seen seen;
  std::promise<void> gate;
  const auto queued =
      make_queued_frames(std::make_unique<Notes>(seen, 1000, gate.get_future().share()));
  for (int k = 0; k < 16; ++k)
    offer(*queued, k);
  auto one_more = std::async(std::launch::async, [&queued] { offer(*queued, 16); });
  EXPECT_EQ(one_more.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  gate.set_value();
  one_more.get();
  queued->end();
  EXPECT_EQ(seen.times.size(), 17u);
}

TEST(QueuedFrames, SavingWaitsForWhatWasOffered) {
  Seen seen;
  const auto queued = make_queued_frames(std::make_unique<Notes>(seen));
  for (int k = 0; k < 10; ++k)
    offer(*queued, k);
  OutArchive out;
  queued->save(out);
  InArchive in(out.data());
  EXPECT_EQ(in.count(), 10u);
  InArchive again(out.data());
  queued->resume({}, again);
  EXPECT_EQ(seen.resumed, 10u);
}

TEST(QueuedFrames, AFailureComesBackAndDropsWhatIsBehindIt) {
  Seen seen;
  const auto queued = make_queued_frames(std::make_unique<Notes>(seen, 5));
  std::string said;
  try {
    for (int k = 0; k < 10; ++k)  // fewer than wait at most: one of the calls may be told, or none
      offer(*queued, k);
    queued->end();
  } catch (const Error& e) {
    said = e.what();
    EXPECT_EQ(e.exit(), Exit::io);
  }
  EXPECT_NE(said.find("cannot write 'frame.vtp'"), std::string::npos) << said;
  EXPECT_EQ(seen.times.size(), 5u);
  EXPECT_EQ(seen.ended, 0u);
  OutArchive out;
  EXPECT_THROW(queued->save(out), Error);  // no checkpoint counts on frames that are not there
  EXPECT_EQ(seen.saved, 0u);
}

class QueuedVtkFrames : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Plugin::available("vtk")) GTEST_SKIP() << "built without VTK";
    scene_.nodes = {Vec3(0, 0, 0), Vec3(0.5, 0, 0)};
    scene_.node_line = {0, 0};
    Scene::Line line;
    line.points = {{0, 0}, {1, 0}};
    line.radius = {0.03, 0.03};
    line.pieces = {{{0, 0}, {1, 0}, 0.03, 0.03, 0.01, 0.01}};
    scene_.lines = {line};
    scene_.trails = {{"end", {1, 0}}};
  }
  std::unique_ptr<FrameWriter> writer(const char* name, std::uint64_t most = 5000) const {
    VtkFrameOptions o;
    o.directory = dir_ / name;
    o.orbits = true;
    o.max_frames = most;
    return make_vtk_frames(o);
  }
  void offer(FrameWriter& w, int k) const {
    const double a = 0.1 * k;
    const std::vector<Pose> nodes{{Vec3(0, 0, 0), Vec3::UnitX(), a},
                                  {Vec3(0.5, 1e-3 * std::cos(a), 0), Vec3::UnitX(), a}};
    FrameState s;
    s.time = k;
    s.nodes = nodes;
    w.frame(s);
  }
  TempFolder dir_;
  Scene scene_;
};

TEST_F(QueuedVtkFrames, AreTheSameFilesByteForByte) {
  for (const bool queued : {false, true}) {
    auto w = writer(queued ? "queued" : "plain", 32);  // thinned on the way
    if (queued) w = make_queued_frames(std::move(w));
    w->begin(scene_);
    for (int k = 0; k < 100; ++k)
      offer(*w, k);
    w->end();
  }
  std::size_t files = 0;
  for (const auto& f : fs::recursive_directory_iterator(dir_ / "plain")) {
    if (!f.is_regular_file()) continue;
    const fs::path name = fs::relative(f.path(), dir_ / "plain");
    EXPECT_TRUE(read_text(f.path()) == read_text(dir_ / "queued" / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 3 * 16u);
  EXPECT_EQ(file_count(dir_ / "queued/frames_line"), file_count(dir_ / "plain/frames_line"));
}

// What VTK has once in a process is set up once.
TEST_F(QueuedVtkFrames, GoOnWhileOtherWritersAreMade) {
  const auto plain = writer("plain"), queued = make_queued_frames(writer("queued"));
  plain->begin(scene_);
  queued->begin(scene_);
  for (int k = 0; k < 100; ++k) {
    offer(*queued, k);
    writer("others")->begin(scene_);
    offer(*plain, k);
  }
  queued->end();
  for (int k = 0; k < 100; ++k) {
    const std::string name = fmt::format("frames_surface/frame_{:06}.vtp", k);
    EXPECT_TRUE(read_text(dir_ / "plain" / name) == read_text(dir_ / "queued" / name)) << name;
  }
}

// A limit on file size stands for the full disk: orbits outgrow it.
TEST_F(QueuedVtkFrames, AFullDiskIsTheSameError) {
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  auto* const handler = ::signal(SIGXFSZ, SIG_IGN);
  std::string said[2];
  for (const bool queued : {false, true}) {
    auto w = writer("same");
    if (queued) w = make_queued_frames(std::move(w));
    w->begin(scene_);
    const rlimit small{20000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    try {
      for (int k = 0; k < 20000; ++k)
        offer(*w, k);
    } catch (const Error& e) {
      said[queued] = e.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
  }
  ::signal(SIGXFSZ, handler);
  EXPECT_NE(said[0].find("cannot write"), std::string::npos) << said[0];
  EXPECT_EQ(said[1], said[0]);
}

}  // namespace
}  // namespace whirl::io
