#include <sweep/workers.hpp>
#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/interrupt.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace whirl::sweep {
namespace {

using Clock = std::chrono::steady_clock;
using Run = std::function<std::string(std::int64_t, int)>;

bool write_all(int fd, const char* data, std::size_t n) {
  while (n > 0) {
    const ssize_t k = ::write(fd, data, n);
    if (k < 0 && errno == EINTR) continue;
    if (k <= 0) return false;
    data += k;
    n -= static_cast<std::size_t>(k);
  }
  return true;
}

bool read_all(int fd, char* data, std::size_t n) {
  while (n > 0) {
    const ssize_t k = ::read(fd, data, n);
    if (k < 0 && errno == EINTR) continue;
    if (k <= 0) return false;
    data += k;
    n -= static_cast<std::size_t>(k);
  }
  return true;
}

[[noreturn]] void work(int tasks, int answers, const Run& run, int worker) {
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    ::dup2(nothing, fd);
  std::int64_t task = 0;
  while (read_all(tasks, reinterpret_cast<char*>(&task), sizeof task)) {
    std::string text = run(task, worker);
    if (text.empty() || text.back() != '\n') text += '\n';
    if (!write_all(answers, text.data(), text.size())) break;
  }
  ::_exit(0);
}

class Worker {
 public:
  Worker(int number, const Run& run, const std::vector<Worker>& others) : number_(number) {
    int to[2], from[2];
    if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) fail();
    pid_ = ::fork();
    if (pid_ < 0) fail();
    if (pid_ == 0) {
      ::close(to[1]);
      ::close(from[0]);
      for (const Worker& w : others)  // else they would not see the end of their tasks
        w.close_here();
      work(to[0], from[1], run, number);
    }
    ::close(to[0]);
    ::close(from[1]);
    tasks_ = to[1];
    answers_ = from[0];
  }
  Worker(Worker&& o) noexcept
      : number_(o.number_),
        pid_(std::exchange(o.pid_, -1)),
        tasks_(std::exchange(o.tasks_, -1)),
        answers_(std::exchange(o.answers_, -1)),
        text_(std::move(o.text_)),
        tasks_given_(std::move(o.tasks_given_)),
        began_(o.began_),
        quick_(o.quick_) {}
  Worker& operator=(Worker&& o) noexcept {
    std::swap(number_, o.number_);
    std::swap(pid_, o.pid_);
    std::swap(tasks_, o.tasks_);
    std::swap(answers_, o.answers_);
    std::swap(text_, o.text_);
    std::swap(tasks_given_, o.tasks_given_);
    std::swap(began_, o.began_);
    std::swap(quick_, o.quick_);
    return *this;
  }
  ~Worker() { finish(); }

  bool busy() const { return !tasks_given_.empty(); }
  /// May be given one more while it is busy: it would wait for this process as long as it works.
  bool takes_ahead() const { return quick_ && tasks_given_.size() == 1; }
  /// The first is worked on, the others wait.
  const std::deque<std::int64_t>& tasks() const { return tasks_given_; }
  int number() const { return number_; }
  int answers() const { return answers_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

  /// One whose process is gone shows in take().
  void give(std::int64_t task) {
    if (!busy()) began_ = Clock::now();
    tasks_given_.push_back(task);
    write_all(tasks_, reinterpret_cast<const char*>(&task), sizeof task);
  }
  /// Reads what is there. The answers that are whole, in the order of the tasks; or a process that is
  /// gone (`gone`).
  std::vector<std::pair<std::int64_t, std::string>> take(bool& gone) {
    char buffer[4096];
    const ssize_t n = ::read(answers_, buffer, sizeof buffer);
    gone = n == 0 || (n < 0 && errno != EINTR && errno != EAGAIN);
    if (n > 0) text_.append(buffer, static_cast<std::size_t>(n));
    std::vector<std::pair<std::int64_t, std::string>> whole;
    for (auto end = text_.find('\n'); end != std::string::npos && busy(); end = text_.find('\n')) {
      constexpr double short_beside_waiting = 0.1;  // s
      quick_ = seconds() < short_beside_waiting;
      began_ = Clock::now();
      whole.emplace_back(tasks_given_.front(), text_.substr(0, end));
      tasks_given_.pop_front();
      text_.erase(0, end + 1);
    }
    return whole;
  }
  void kill() const { ::kill(pid_, SIGKILL); }
  /// Waits for its end; the signal that ended it, or 0.
  int finish() {
    if (tasks_ >= 0) ::close(std::exchange(tasks_, -1));
    if (answers_ >= 0) ::close(std::exchange(answers_, -1));
    if (pid_ <= 0) return 0;
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {}
    pid_ = -1;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  [[noreturn]] static void fail() {
    throw Error(Exit::io,
                Diagnostic{Diagnostic::Severity::error, "E99",
                           fmt::format("no process can be started: {}", std::strerror(errno)),
                           "fewer of them: --jobs 1", Where{}});
  }
  void close_here() const {
    ::close(tasks_);
    ::close(answers_);
  }

  int number_ = 0;
  pid_t pid_ = -1;
  int tasks_ = -1, answers_ = -1;
  std::string text_;
  std::deque<std::int64_t> tasks_given_;
  Clock::time_point began_;
  bool quick_ = false;  ///< the last answer came soon
};

/// A worker whose process ended is replaced by a fresh one of the same number.
class Crew {
 public:
  Crew(const WorkerOptions& options, const Run& run) : options_(options), run_(run) {
    for (int k = 0; k < options.processes; ++k)
      workers_.emplace_back(k, run_, workers_);
  }
  std::vector<Worker>& workers() { return workers_; }
  int replace(std::size_t k) {
    const int signal = workers_[k].finish();
    const int number = workers_[k].number();
    workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(k));
    workers_.emplace_back(number, run_, workers_);
    return signal;
  }
  bool late(const Worker& w) const {
    return options_.limit > 0 && w.busy() && w.seconds() > options_.limit;
  }

 private:
  WorkerOptions options_;
  const Run& run_;
  std::vector<Worker> workers_;
};

}  // namespace

namespace {

/// What is still to be given out.
class Tasks {
 public:
  explicit Tasks(std::span<const std::int64_t> all) : all_(all) {}
  std::size_t left() const { return all_.size() - next_ + returned_.size(); }
  std::int64_t next() {
    if (returned_.empty()) return all_[next_++];
    const std::int64_t task = returned_.front();
    returned_.pop_front();
    return task;
  }
  void put_back(std::int64_t task) { returned_.push_back(task); }

 private:
  std::span<const std::int64_t> all_;
  std::size_t next_ = 0;
  std::deque<std::int64_t> returned_;  ///< that waited behind one that ended its process
};

/// Everyone has a task, and those whose tasks are short a second one.
void give_out(Tasks& tasks, std::vector<Worker>& workers) {
  for (Worker& w : workers)
    if (!w.busy() && tasks.left() > 0) w.give(tasks.next());
  for (Worker& w : workers)
    if (w.takes_ahead() && tasks.left() > workers.size()) w.give(tasks.next());
}

}  // namespace

void run_in_workers(std::span<const std::int64_t> tasks, const WorkerOptions& options,
                    const Run& run,
                    const std::function<void(std::int64_t, Ended, const std::string&, int)>& take) {
  WHIRL_EXPECTS(options.processes > 0);
  struct IgnorePipe {  // a worker that is gone shows as an error of write()
    void (*before)(int) = std::signal(SIGPIPE, SIG_IGN);
    ~IgnorePipe() { std::signal(SIGPIPE, before); }
  } ignore;
  Crew crew(options, run);
  Tasks left(tasks);
  const auto end = [&](std::size_t k, Ended how) {
    const std::deque<std::int64_t> given = crew.workers()[k].tasks();
    const int signal = crew.replace(k);
    for (std::size_t i = 1; i < given.size(); ++i)
      left.put_back(given[i]);
    take(given.front(), how, {}, signal);
  };
  for (;;) {
    std::vector<Worker>& workers = crew.workers();
    if (!interrupt::flag.load(std::memory_order_relaxed)) give_out(left, workers);
    if (std::none_of(workers.begin(), workers.end(), [](const Worker& w) { return w.busy(); }))
      return;
    std::vector<pollfd> wait;
    wait.reserve(workers.size());
    for (const Worker& w : workers)
      wait.push_back({w.answers(), POLLIN, 0});
    if (::poll(wait.data(), wait.size(), 100) < 0 && errno != EINTR) return;
    for (std::size_t k = wait.size(); k-- > 0;) {  // from the back: a replaced one goes there
      Worker& w = workers[k];
      if (!w.busy()) continue;
      if ((wait[k].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
        bool gone = false;
        for (const auto& [task, text] : w.take(gone))
          take(task, Ended::answered, text, 0);
        if (gone && w.busy()) end(k, Ended::crashed);
      } else if (crew.late(w)) {
        w.kill();
        end(k, Ended::out_of_time);
      }
    }
  }
}

}  // namespace whirl::sweep
