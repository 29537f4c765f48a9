#include <core/messages.hpp>

#include <cstdio>

namespace whirl {

namespace {

/// Of a thread, not of what it computes: no result depends on it.
thread_local Messages* speaking = nullptr;

void put(Messages::To to, std::string_view text) {
  std::FILE* stream = to == Messages::To::output ? stdout : stderr;
  std::fwrite(text.data(), 1, text.size(), stream);
}

void tell(Messages::To to, std::string_view text) {
  if (speaking != nullptr)
    speaking->write(to, text);
  else
    put(to, text);
}

}  // namespace

void say(std::string_view text) { tell(Messages::To::error, text); }

void print(std::string_view text) { tell(Messages::To::output, text); }

bool is_heard() { return speaking == nullptr || speaking->is_heard(); }

void Messages::write(To to, std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (heard_)
    put(to, text);
  else
    held_.emplace_back(to, text);
}

void Messages::let_be_heard() {
  const std::lock_guard lock(mutex_);
  for (const auto& [to, text] : held_)
    put(to, text);
  held_.clear();
  heard_ = true;
}

bool Messages::is_heard() const {
  const std::lock_guard lock(mutex_);
  return heard_;
}

SpeakThrough::SpeakThrough(Messages& messages) : outer_(std::exchange(speaking, &messages)) {}

SpeakThrough::~SpeakThrough() { speaking = outer_; }

}  // namespace whirl
