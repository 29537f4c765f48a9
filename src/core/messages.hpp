// What a run tells its user on standard output and error. Steps that run side by side are heard one
// after the other, in the order of the deck: what one says before its turn is held back.
#pragma once
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace whirl {

/// Writes on standard error, or into the Messages that the calling thread speaks through.
void say(std::string_view text);
/// The same on standard output.
void print(std::string_view text);
/// Whether what this thread says now is seen now: a line that is rewritten has no use later.
bool is_heard();

/// Says and prints of one speaker, held back until it is heard. Any thread may let it be heard while
/// another one speaks.
class Messages {
 public:
  enum class To { output, error };
  void write(To to, std::string_view text);
  /// Writes what was held back, and from now on everything at once.
  void let_be_heard();
  bool is_heard() const;

 private:
  mutable std::mutex mutex_;
  bool heard_ = false;
  std::vector<std::pair<To, std::string>> held_;
};

/// While one lives, the calling thread speaks through `messages`.
class SpeakThrough {
 public:
  explicit SpeakThrough(Messages& messages);
  ~SpeakThrough();
  SpeakThrough(const SpeakThrough&) = delete;
  SpeakThrough& operator=(const SpeakThrough&) = delete;

 private:
  Messages* outer_;
};

}  // namespace whirl
