#include <app/starters.hpp>
#include <app/starter_texts.hpp>
#include <core/error.hpp>
#include <deck/text/document.hpp>
#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <map>
#include <stdexcept>
#include <string_view>

namespace whirl::app {

namespace {

bool starts(std::string_view line, std::string_view with) {
  return line.substr(0, with.size()) == with;
}

std::vector<std::string> split(const std::string& text, const std::string& by) {
  std::vector<std::string> out;
  std::size_t at = 0;
  for (std::size_t k = text.find(by); k != std::string::npos; k = text.find(by, at)) {
    out.push_back(text.substr(at, k - at));
    at = k + by.size();
  }
  out.push_back(text.substr(at));
  return out;
}

/// The whole text as a number.
bool read_number(std::string_view text, int& n) {
  const auto r = std::from_chars(text.data(), text.data() + text.size(), n);
  return r.ec == std::errc{} && r.ptr == text.data() + text.size();
}

/// "#? key = default : what is asked"
Question question_of(const std::string& line) {
  const std::size_t equals = line.find(" = "), colon = line.find(" : ");
  if (equals == std::string::npos || colon == std::string::npos || colon < equals)
    throw std::logic_error("starter: " + line);
  Question q;
  q.key = line.substr(3, equals - 3);
  q.text = line.substr(colon + 3);
  const std::string given = line.substr(equals + 3, colon - equals - 3);
  const std::vector<std::string> words = split(given, " | ");
  if (words.size() > 1) {
    q.kind = Question::Kind::choice;
    q.words = words;
    q.answer = words.front();
  } else if (given.front() == '"') {
    q.answer = given.substr(1, given.size() - 2);
  } else {
    q.kind = Question::Kind::number;
    const std::size_t open = given.find(" ("), dots = given.find("..");
    if (open == std::string::npos || dots == std::string::npos ||
        !read_number(std::string_view(given).substr(open + 2, dots - open - 2), q.least) ||
        !read_number(std::string_view(given).substr(dots + 2, given.size() - dots - 3), q.most))
      throw std::logic_error("starter: " + line);
    q.answer = given.substr(0, open);
  }
  return q;
}

Starter starter_of(const StarterText& t) {
  Starter s;
  s.machine = t.machine;
  for (const std::string& line : split(t.text, "\n"))
    if (starts(line, "#? "))
      s.questions.push_back(question_of(line));
    else
      s.text += line + "\n";
  s.text.pop_back();  // split() gives what follows the last newline as a line
  return s;
}

[[noreturn]] void bad_answer(std::string message, std::string hint) {
  Diagnostic d;
  d.message = std::move(message);
  d.hint = std::move(hint);
  throw Error(Exit::usage, std::move(d));
}

void check_answer(const Question& q, const std::string& answer) {
  if (q.kind == Question::Kind::choice &&
      std::find(q.words.begin(), q.words.end(), answer) == q.words.end())
    bad_answer(fmt::format("'{}' is no answer to '{}'", answer, q.key),
               fmt::format("one of: {}", fmt::join(q.words, ", ")));
  int n = 0;
  if (q.kind == Question::Kind::number && (!read_number(answer, n) || n < q.least || n > q.most))
    bad_answer(fmt::format("'{}' is no answer to '{}'", answer, q.key),
               fmt::format("a whole number from {} to {}", q.least, q.most));
  if (q.kind == Question::Kind::quantity && answer.find_first_of("\"\\\n") != std::string::npos)
    bad_answer(fmt::format("'{}' is no answer to '{}'", answer, q.key),
               fmt::format("a number with its unit, such as \"{}\"", q.answer));
}

using Answers = std::map<std::string, std::string>;

Answers answers_of(const Starter& s,
                   const std::vector<std::pair<std::string, std::string>>& given) {
  Answers out;
  std::vector<std::string> keys;
  for (const Question& q : s.questions) {
    out[q.key] = q.answer;
    keys.push_back(q.key);
  }
  for (const auto& [key, answer] : given) {
    const auto asked = std::find_if(s.questions.begin(), s.questions.end(),
                                    [&k = key](const Question& q) { return q.key == k; });
    if (asked == s.questions.end()) {
      const auto near = deck::nearest(key, keys);
      bad_answer(fmt::format("the starter '{}' does not ask for '{}'", s.machine, key),
                 near.empty() ? fmt::format("it asks for: {}", fmt::join(keys, ", "))
                              : fmt::format("did you mean '{}'?", near.front()));
    }
    check_answer(*asked, answer);
    out[key] = answer;
  }
  return out;
}

std::string with_number(std::string line, int k) {
  for (std::size_t at = line.find("{k}"); at != std::string::npos; at = line.find("{k}"))
    line.replace(at, 3, std::to_string(k));
  return line;
}

/// The text with its blocks chosen and repeated.
std::string filled_in(const Starter& s, const Answers& answers) {
  std::string out, block;
  bool leave_out = false;
  int times = 0;
  for (const std::string& line : split(s.text, "\n")) {
    if (starts(line, "#if ")) {
      const std::vector<std::string> asked = split(line.substr(4), " = ");
      leave_out = answers.at(asked.at(0)) != asked.at(1);
    } else if (starts(line, "#each ")) {
      read_number(answers.at(line.substr(6)), times);
    } else if (line == "#end") {
      for (int k = 1; k <= times; ++k)
        out += with_number(block, k);
      block.clear();
      leave_out = false;
      times = 0;
    } else if (!leave_out) {
      (times > 0 ? block : out) += line + "\n";
    }
  }
  out.pop_back();
  return out;
}

/// The parameters that the deck uses, each with what was asked.
std::string parameters_of(const Starter& s, const Answers& answers, const std::string& deck) {
  std::size_t widest = 0;
  std::vector<std::pair<std::string, std::string>> lines;
  for (const Question& q : s.questions) {
    if (deck.find("${" + q.key + "}") == std::string::npos) continue;
    const std::string& answer = answers.at(q.key);
    const char* quote = q.kind == Question::Kind::number ? "" : "\"";
    lines.emplace_back(fmt::format("{} = {}{}{}", q.key, quote, answer, quote), q.text);
    widest = std::max(widest, lines.back().first.size());
  }
  std::string out = "\n[parameters]\n";
  for (const auto& [line, text] : lines)
    out += fmt::format("{:<{}}  # {}\n", line, widest, text);
  return out;
}

}  // namespace

const std::vector<Starter>& starters() {
  static const std::vector<Starter> all = [] {
    std::vector<Starter> out;
    for (const StarterText& t : starter_texts())
      out.push_back(starter_of(t));
    return out;
  }();
  return all;
}

std::string starter_deck(const Starter& starter,
                         const std::vector<std::pair<std::string, std::string>>& given) {
  const Answers answers = answers_of(starter, given);
  std::string deck = filled_in(starter, answers);
  const std::size_t title = deck.find("\ntitle");
  const std::size_t end = title == std::string::npos ? title : deck.find('\n', title + 1);
  if (end == std::string::npos)
    throw std::logic_error("starter without a title: " + starter.machine);
  deck.insert(end + 1, parameters_of(starter, answers, deck));
  return deck;
}

}  // namespace whirl::app
